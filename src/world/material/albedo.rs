//! Albedo of isotropic microfacets, integrated over the hemisphere.

use super::fresnel::Curve;
use super::microfacet::Microfacets;
use super::table::{AngleTable, rule};
use base::math::Rgb;
use glam::Vec3;
use scene::Fresnel;

/// Tabulates the albedo by angle.
pub(super) fn albedo_table(facets: &Microfacets, fresnel: &Fresnel) -> AngleTable<Rgb> {
    let rule = rule(32);
    AngleTable::new(|wo| albedo(facets, fresnel, wo, &rule))
}

/// Integrates the share of the light from `wo`, in the xz plane, that single scattering on the facets reflects.
pub(super) fn albedo(facets: &Microfacets, fresnel: &Fresnel, wo: Vec3, rule: &[(f32, f32)]) -> Rgb {
    facets.mean_over_visible(wo, rule, |h| {
        let cos = wo.dot(h);
        let wi = 2.0 * cos * h - wo;
        if cos <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        fresnel.reflectance(cos.min(1.0)) * (2.0 * wi.z * facets.v1(wi.z.min(1.0)))
    })
}
