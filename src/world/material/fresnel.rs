//! Unpolarised reflectance of smooth interfaces.
//!
//! Papers: the diffuse average follows Egan and Hilgeman, *Spectral reflectance of particulate materials*, 1973, and
//! d'Eon and Irving, *A Quantized-Diffusion Model for Rendering Translucent Materials*, 2011.

use base::math::{Lane, Rgb, V3};
use scene::Fresnel;

/// Reflection and refraction of a ray at a smooth dielectric interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Refraction<L = f32> {
    /// Share of the power that is reflected.
    pub reflectance: L,
    /// Cosine of the refracted ray to the normal on its side, >= 0; 0 at total reflection.
    pub cos_t: L,
    /// Index of refraction on the far side over that on the ray's side.
    pub eta: L,
}

/// Solves a dielectric interface for a ray on the side that the sign of `cos_i` tells. `eta` is the index of refraction
/// behind the normal over the index in front.
#[inline(always)]
pub(super) fn interface<L: Lane>(cos_i: L, eta: f32) -> Refraction<L> {
    let one = L::from(1.0);
    let is_behind = L::from(0.0).gt(cos_i);
    let cos_i = cos_i.abs().min(one);
    if eta == 1.0 {
        return Refraction { reflectance: L::from(0.0), cos_t: cos_i, eta: one };
    }
    let eta_it = L::pick(is_behind, L::from(1.0 / eta), L::from(eta));
    let cos_t_sq = (cos_i.sq().rest() / eta_it.sq()).rest();
    let cos_t = cos_t_sq.positive().sqrt();
    let r_s = (cos_i - eta_it * cos_t) / (cos_i + eta_it * cos_t);
    let r_p = (cos_t - eta_it * cos_i) / (cos_t + eta_it * cos_i);
    let is_partial = cos_t_sq.is_positive() & cos_i.is_positive();
    let reflectance = L::pick(is_partial, (r_s.sq() + r_p.sq()) * 0.5, one);
    Refraction { reflectance, cos_t, eta: eta_it }
}

/// Returns the reflectance of a dielectric seen from the side of the normal.
#[inline(always)]
pub(super) fn dielectric<L: Lane>(cos_i: L, eta: f32) -> L {
    let cos_i = cos_i.max(L::from(1e-7)).min(L::from(1.0));
    let cos_t = (cos_i.sq().rest() * (1.0 / (eta * eta))).rest().positive().sqrt();
    let r_s = (cos_i - cos_t * eta) * (cos_i + cos_t * eta).recip();
    let r_p = (cos_t - cos_i * eta) * (cos_t + cos_i * eta).recip();
    (r_s.sq() + r_p.sq()) * 0.5
}

/// Returns the reflectance of a conductor of index `eta + i k` in one channel, at a cosine in 0..=1.
#[inline(always)]
fn conductor<L: Lane>(cos_i: L, eta: f32, k: f32) -> L {
    let tiny = L::from(1e-30);
    let cos_sq = cos_i.sq();
    let sin_sq = cos_sq.rest();
    // The complex cosine of refraction times the index is a + i b. Its squared modulus is a² + b², and a² is half of
    // modulus + difference, rewritten to avoid the cancellation that occurs for metals.
    let difference = L::from(eta * eta - k * k) - sin_sq;
    let cross = L::from(2.0 * eta * k);
    let modulus = (difference.sq() + cross.sq()).sqrt();
    // The floors here and below only turn 0/0 into 0 or 1.
    let sum = (modulus + difference.abs()).max(tiny);
    let twice_a_sq = L::pick(L::from(0.0).gt(difference), cross * (cross * sum.recip()), sum);
    let twice = cos_i * (twice_a_sq * 0.5).sqrt() * 2.0;
    let sum = modulus + cos_sq + tiny;
    let r_s = (sum - twice) * (sum + twice).recip();
    let (sum, twice) = (modulus * cos_sq + sin_sq.sq() + tiny, twice * sin_sq);
    let r_p = r_s * ((sum - twice) * (sum + twice).recip());
    ((r_s + r_p) * 0.5).positive().min(L::from(1.0))
}

/// Returns the cosine-weighted mean of the reflectance over the hemisphere, by the fits that Mitsuba's `plastic` uses.
/// `eta` is the index of refraction on the far side over that on the light's side. The error is 0.2 % for common
/// indices.
pub(super) fn diffuse_reflectance(eta: f32) -> f32 {
    let inv = 1.0 / eta;
    if eta < 1.0 {
        // Egan and Hilgeman.
        -1.4399 * eta * eta + 0.7099 * eta + 0.6681 + 0.0636 * inv
    } else {
        // d'Eon and Irving, a polynomial in 1/η.
        let coefficients = [-1.36881, 4.98554, -7.80989, 6.75335, -3.4793, 0.919317];
        coefficients.iter().fold(0.0, |sum, c| sum * inv + c)
    }
}

/// Returns the weight of the reflectance at grazing incidence in Schlick's approximation.
#[inline(always)]
pub(super) fn schlick_weight<L: Lane>(cos: L) -> L {
    let m = cos.rest().positive().min(L::from(1.0));
    m.sq().sq() * m
}

/// Reflectance of a (micro)surface by angle of incidence.
pub(super) trait Curve {
    /// Returns the reflectance for light at `cos_i` to the (micro)surface's normal, on its front side.
    fn reflectance(&self, cos_i: f32) -> Rgb;

    /// Returns [`Curve::reflectance`] for any lanes.
    fn reflected<L: Lane>(&self, cos_i: L) -> V3<L>;

    /// Returns the maximum reflectance at any cosine >= `cos_min`, given the reflectance `normal` at normal incidence.
    ///
    /// The larger of the values at both ends is the maximum: a dielectric's reflectance grows towards grazing
    /// incidence, a conductor's may first fall and then rises to 1, and Schlick's approximation is monotonic.
    fn max_reflectance<L: Lane>(&self, cos_min: L, normal: Rgb) -> V3<L>;
}

impl Curve for Fresnel {
    #[inline]
    fn reflectance(&self, cos_i: f32) -> Rgb {
        self.reflected(cos_i).into()
    }

    #[inline(always)]
    fn reflected<L: Lane>(&self, cos_i: L) -> V3<L> {
        match *self {
            Fresnel::One => V3::grey(L::from(1.0)),
            Fresnel::Dielectric(eta) => V3::grey(dielectric(cos_i, eta)),
            Fresnel::Conductor { eta, k } => {
                let cos_i = cos_i.positive().min(L::from(1.0));
                let channel = |eta, k| conductor(cos_i, eta, k);
                V3::new(channel(eta.x, k.x), channel(eta.y, k.y), channel(eta.z, k.z))
            }
            Fresnel::Schlick { normal, edge } => {
                V3::splat(normal) + V3::splat(Rgb::splat(edge) - normal).times(schlick_weight(cos_i))
            }
        }
    }

    #[inline(always)]
    fn max_reflectance<L: Lane>(&self, cos_min: L, normal: Rgb) -> V3<L> {
        let most = self.reflected(cos_min);
        match *self {
            Fresnel::Conductor { .. } | Fresnel::Schlick { .. } => most.max(V3::splat(normal)),
            Fresnel::One | Fresnel::Dielectric(_) => most,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interfaces_meet_their_limits() {
        let normal = interface(1.0, 1.5);
        assert!((normal.reflectance - 0.04).abs() < 1e-6);
        assert_eq!(interface(0.0, 1.5).reflectance, 1.0);
        assert_eq!(interface(0.3, 1.0).reflectance, 0.0);
        // The ray comes from inside, beyond the critical angle.
        assert_eq!(interface(-0.5, 1.5).reflectance, 1.0);
        // Stokes: the same share either way along one path.
        let i = interface(0.6, 1.5);
        assert!((interface(-i.cos_t, 1.5).reflectance - i.reflectance).abs() < 1e-6);
        assert!((interface(-i.cos_t, 1.5).cos_t - 0.6).abs() < 1e-6);
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for cos in [1.0, 0.9, 0.5, 0.1, 0.01] {
            let r = conductor(cos, 1.5, 0.0);
            assert!((r - dielectric(cos, 1.5)).abs() < 1e-5, "{cos}: {r} {}", dielectric(cos, 1.5));
        }
        assert!(conductor(0.0, 1.0, 0.0).is_finite());
        assert!(conductor(0.0, 0.0, 1.0).is_finite());
    }

    #[test]
    fn the_diffuse_average_agrees_with_quadrature() {
        for eta in [1.1, 1.33, 1.5, 1.9, 1.0 / 1.33, 1.0 / 1.5] {
            let n = 20_000;
            let mean: f64 = (0..n)
                .map(|i| {
                    let cos = ((i as f32 + 0.5) / n as f32).sqrt();
                    f64::from(dielectric(cos, eta)) / f64::from(n)
                })
                .sum();
            let fit = f64::from(diffuse_reflectance(eta));
            assert!((fit / mean - 1.0).abs() < 0.02 && (fit - mean).abs() < 0.002, "{eta}: {fit} {mean}");
        }
    }

    #[test]
    fn the_largest_reflectance_is_not_exceeded() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        for _ in 0..20_000 {
            let fresnel = Fresnel::Conductor {
                eta: Rgb::new(next() * 0.3, next() * 2.0, next() * 6.0),
                k: Rgb::new(next() * 8.0, next() * 4.0, next() * 0.5),
            };
            let cos_min = next();
            let cos = cos_min + (1.0 - cos_min) * next();
            let excess = fresnel.reflectance(cos)
                - Rgb::from(fresnel.max_reflectance(cos_min, fresnel.reflectance(1.0)));
            assert!(excess.max_element() < 5e-6, "{fresnel:?} {cos_min} {cos} {excess}");
        }
    }
}
