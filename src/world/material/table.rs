//! Functions of the angle to the normal, tabulated, as the albedo of isotropic microfacets.

use super::fresnel::Curve;
use super::microfacet::Microfacets;
use base::math::{Lane, Rgb, V3, gauss_legendre};
use glam::Vec3;
use rayon::prelude::*;
use scene::Fresnel;
use std::array;
use std::ops::{Add, Mul, Sub};

/// Number of entries of a table, evenly spaced in cos θ from 0 to 1.
pub(super) const ANGLES: usize = 64;

/// Function of cos θ, linear between its entries.
#[derive(Clone, Copy, Debug)]
pub(super) struct AngleTable<T>(pub [T; ANGLES]);

impl<T: Copy + Send + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>> AngleTable<T> {
    /// Tabulates `f` of the direction at each angle, in the xz plane.
    pub fn new(f: impl Fn(Vec3) -> T + Sync) -> AngleTable<T> {
        let values: Vec<T> = (0..ANGLES).into_par_iter().map(|i| f(direction(i))).collect();
        AngleTable(array::from_fn(|i| values[i]))
    }

    /// Returns the value at `cos` in 0..=1.
    #[inline]
    pub fn lookup(&self, cos: f32) -> T {
        let x = cos.clamp(0.0, 1.0) * (ANGLES - 1) as f32;
        let i = (x as usize).min(ANGLES - 2);
        let (a, b) = (self.0[i], self.0[i + 1]);
        a + (b - a) * (x - i as f32)
    }

    /// Returns the entry at `cos` or the nearest entry below.
    #[inline]
    pub fn floor(&self, cos: f32) -> T {
        self.0[((cos * (ANGLES - 1) as f32) as usize).min(ANGLES - 1)]
    }

    /// Returns the cosine-weighted mean over the hemisphere, exact for the interpolant.
    pub fn mean(&self) -> T {
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

impl AngleTable<Rgb> {
    /// Returns [`AngleTable::lookup`] in every lane.
    #[inline(always)]
    pub fn colours<L: Lane>(&self, cos: L) -> V3<L> {
        V3::from_fn(|lane| self.lookup(cos.lane(lane)))
    }
}

/// Returns the unit vector at entry `i`'s angle, in the xz plane and just off the horizon.
pub(super) fn direction(i: usize) -> Vec3 {
    let cos = (i as f32 / (ANGLES - 1) as f32).max(1e-6);
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// Returns nodes and weights of Gauss-Legendre quadrature on [0, 1].
pub(super) fn rule(nodes: usize) -> Vec<(f32, f32)> {
    gauss_legendre(nodes).iter().map(|&(x, weight)| (x as f32, weight as f32)).collect()
}

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
