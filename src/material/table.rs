//! What is tabulated by angle, once per distinct roughness and index: the transmittance of a rough coat and
//! the albedo of a rough lobe.
//!
//! Deviations: none from Mitsuba's `roughplastic` by intent, which means taking its rules over: 64 cosines,
//! evenly spaced from grazing to normal incidence, linear between; single scattering only, so the energy that
//! masking takes is lost; the internal reflectance is the plain mean over those 64 cosines.

use super::fresnel;
use super::microfacet::Microfacets;
use crate::math::{Rgb, gauss_legendre};
use crate::scene::Fresnel;
use glam::Vec3;
use rayon::prelude::*;
use std::array;
use std::ops::{Add, Mul, Sub};

/// Entries of a table, evenly spaced in cos θ from 0 to 1.
pub(super) const ANGLES: usize = 64;

/// A function of cos θ, linear between its entries.
#[derive(Clone, Copy, Debug)]
pub(super) struct AngleTable<T>([T; ANGLES]);

impl<T: Copy + Send + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>> AngleTable<T> {
    /// Tabulates `f` of the direction at each angle, in the xz plane.
    fn new(f: impl Fn(Vec3) -> T + Sync) -> AngleTable<T> {
        let values: Vec<T> = (0..ANGLES).into_par_iter().map(|i| f(direction(i))).collect();
        AngleTable(array::from_fn(|i| values[i]))
    }

    /// The value at `cos` in 0..=1.
    #[inline]
    pub fn lookup(&self, cos: f32) -> T {
        let x = cos.clamp(0.0, 1.0) * (ANGLES - 1) as f32;
        let i = (x as usize).min(ANGLES - 2);
        let (a, b) = (self.0[i], self.0[i + 1]);
        a + (b - a) * (x - i as f32)
    }

    /// The entry at or next below `cos`.
    #[inline]
    pub fn floor(&self, cos: f32) -> T {
        self.0[((cos * (ANGLES - 1) as f32) as usize).min(ANGLES - 1)]
    }

    /// Cosine-weighted mean over the hemisphere, exact for the interpolant.
    fn mean(&self) -> T {
        let step = 1.0 / (ANGLES - 1) as f32;
        let cell = |i: usize| {
            // 2 ∫ (a + (b - a) s) μ dμ over the cell, μ = (i + s) step
            let i_f = i as f32;
            let (a, b) = (self.0[i], self.0[i + 1]);
            a * (step * step * (i_f + 1.0 / 3.0)) + b * (step * step * (i_f + 2.0 / 3.0))
        };
        (1..ANGLES - 1).fold(cell(0), |sum, i| sum + cell(i))
    }
}

fn direction(i: usize) -> Vec3 {
    let cos = (i as f32 / (ANGLES - 1) as f32).max(1e-6);
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// A rough dielectric interface over the base.
#[derive(Clone, Debug)]
pub(super) struct RoughCoat {
    /// Share of the light from a direction outside that enters.
    pub transmittance: AngleTable<f32>,
    /// The largest transmittance at this or any smaller cosine.
    pub max_transmittance: AngleTable<f32>,
    /// Cosine-weighted mean of the transmittance.
    pub mean_transmittance: f32,
    /// Share of the base's light that the coat sends back inside.
    pub internal_reflectance: f32,
}

impl RoughCoat {
    pub fn new(facets: &Microfacets, eta: f32) -> RoughCoat {
        // Beyond the critical angle the integrand has a kink, hence more nodes towards the rarer side.
        let (coarse, fine) = (rule(32), rule(128));
        let (outside_rule, inside_rule) = if eta > 1.0 { (&coarse, &fine) } else { (&fine, &coarse) };
        let transmittance = AngleTable::new(|wo| transmittance(facets, eta, wo, outside_rule));
        let mut max_transmittance = transmittance;
        for i in 1..ANGLES {
            max_transmittance.0[i] = max_transmittance.0[i].max(max_transmittance.0[i - 1]);
        }
        let inside = Fresnel::Dielectric(1.0 / eta);
        let reflected = AngleTable::new(|wo| albedo(facets, &inside, wo, inside_rule).x);
        let internal_reflectance =
            (0..ANGLES).map(|i| reflected.0[i] * direction(i).z).sum::<f32>() * 2.0 / ANGLES as f32;
        RoughCoat {
            mean_transmittance: transmittance.mean(),
            transmittance,
            max_transmittance,
            internal_reflectance: internal_reflectance.clamp(0.0, 0.999),
        }
    }
}

/// Nodes and weights on [0, 1].
fn rule(nodes: usize) -> Vec<(f32, f32)> {
    gauss_legendre(nodes).iter().map(|&(x, weight)| (x as f32, weight as f32)).collect()
}

/// Albedo of a rough lobe by angle, before its scale.
pub(super) fn lobe_albedo(facets: &Microfacets, fresnel: &Fresnel) -> AngleTable<Rgb> {
    let rule = rule(32);
    AngleTable::new(|wo| albedo(facets, fresnel, wo, &rule))
}

/// The largest reflectance at any cosine >= each entry's, so that [`AngleTable::floor`] bounds it.
pub(super) fn max_reflectance(fresnel: &Fresnel) -> AngleTable<Rgb> {
    let normal = fresnel.reflectance(1.0);
    AngleTable(array::from_fn(|i| {
        let cos = i as f32 / (ANGLES - 1) as f32;
        fresnel.max_reflectance((cos - 1e-6).max(0.0), normal)
    }))
}

/// Light from `wo` that single scattering on the facets reflects back to its side.
fn albedo(facets: &Microfacets, fresnel: &Fresnel, wo: Vec3, rule: &[(f32, f32)]) -> Rgb {
    facets.mean_over_visible(wo, rule, |h| {
        let cos = wo.dot(h);
        let wi = 2.0 * cos * h - wo;
        if cos <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        fresnel.reflectance(cos.min(1.0)) * (2.0 * wi.z * facets.v1(wi.z.min(1.0)))
    })
}

/// Light from `wo` that single scattering on the facets refracts to the other side.
fn transmittance(facets: &Microfacets, eta: f32, wo: Vec3, rule: &[(f32, f32)]) -> f32 {
    let mean = facets.mean_over_visible(wo, rule, |h| {
        let cos = wo.dot(h).min(1.0);
        let interface = fresnel::interface(cos, eta);
        let wi = (cos / interface.eta - interface.cos_t) * h - wo / interface.eta;
        if cos <= 0.0 || wi.z >= 0.0 {
            return Rgb::ZERO;
        }
        let cos_t = (-wi.z).min(1.0);
        Rgb::splat((1.0 - interface.reflectance) * 2.0 * cos_t * facets.v1(cos_t))
    });
    mean.x
}
