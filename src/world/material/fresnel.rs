//! Unpolarised reflectance of smooth interfaces.
//!
//! Papers: the diffuse average follows Egan and Hilgeman, *Spectral reflectance of particulate materials*, 1973, and
//! d'Eon and Irving, *A Quantized-Diffusion Model for Rendering Translucent Materials*, 2011.

use base::math::{F32x16, LANES, Rgb, Vec3x16};
use scene::Fresnel;

/// Reflection and refraction of a ray at a smooth dielectric interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Refraction {
    /// Share of the power that is reflected.
    pub reflectance: f32,
    /// Cosine of the refracted ray to the normal on its side, >= 0; 0 at total reflection.
    pub cos_t: f32,
    /// Index of refraction on the far side over that on the ray's side.
    pub eta: f32,
}

/// Solves a dielectric interface for a ray on the side that the sign of `cos_i` tells. `eta` is the index of refraction
/// behind the normal over the index in front.
#[inline]
pub(super) fn interface(cos_i: f32, eta: f32) -> Refraction {
    let eta_it = if cos_i >= 0.0 { eta } else { 1.0 / eta };
    let inv_eta = 1.0 / eta_it;
    let cos_i = cos_i.abs().min(1.0);
    let cos_t_sq = 1.0 - inv_eta * inv_eta * (1.0 - cos_i * cos_i);
    if eta == 1.0 {
        return Refraction { reflectance: 0.0, cos_t: cos_i, eta: 1.0 };
    }
    if cos_t_sq <= 0.0 || cos_i == 0.0 {
        return Refraction { reflectance: 1.0, cos_t: cos_t_sq.max(0.0).sqrt(), eta: eta_it };
    }
    let cos_t = cos_t_sq.sqrt();
    let r_s = (cos_i - eta_it * cos_t) / (cos_i + eta_it * cos_t);
    let r_p = (cos_t - eta_it * cos_i) / (cos_t + eta_it * cos_i);
    Refraction { reflectance: 0.5 * (r_s * r_s + r_p * r_p), cos_t, eta: eta_it }
}

/// Returns the reflectance of a dielectric seen from the side of the normal.
#[inline]
pub(super) fn dielectric(cos_i: f32, eta: f32) -> f32 {
    interface(cos_i, eta).reflectance
}

/// Returns the reflectance of a conductor of index `eta + i k`.
#[inline]
pub(super) fn conductor(cos_i: f32, eta: Rgb, k: Rgb) -> Rgb {
    let cos_i = cos_i.clamp(0.0, 1.0);
    // Four channels without branches compile to one vector; the last is unused.
    let (eta, k) = ([eta.x, eta.y, eta.z, 1.0], [k.x, k.y, k.z, 1.0]);
    let [r, g, b, _] = std::array::from_fn(|i| conductor_channel(cos_i, eta[i], k[i]));
    Rgb::new(r, g, b)
}

/// Returns the reflectance of a conductor in one channel.
#[inline]
fn conductor_channel(cos_i: f32, eta: f32, k: f32) -> f32 {
    let cos_sq = cos_i * cos_i;
    let sin_sq = 1.0 - cos_sq;
    // The complex cosine of refraction times the index is a + i b. Its squared modulus is a² + b², and a² is half of
    // modulus + difference, rewritten to avoid the cancellation that occurs for metals.
    let difference = eta * eta - k * k - sin_sq;
    let cross = 2.0 * eta * k;
    let modulus = (difference * difference + cross * cross).sqrt();
    // The floors here and below only turn 0/0 into 0 or 1.
    let sum = (modulus + difference.abs()).max(1e-30);
    let twice_a_sq = if difference >= 0.0 { sum } else { cross * (cross / sum) };
    let a = (0.5 * twice_a_sq).sqrt();
    let (sum, twice) = (modulus + cos_sq + 1e-30, 2.0 * cos_i * a);
    let r_s = (sum - twice) / (sum + twice);
    let (sum, twice) = (modulus * cos_sq + sin_sq * sin_sq + 1e-30, twice * sin_sq);
    let r_p = r_s * ((sum - twice) / (sum + twice));
    (0.5 * (r_s + r_p)).clamp(0.0, 1.0)
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
#[inline]
pub(super) fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    m * m * (m * m) * m
}

/// Returns Schlick's approximation between the reflectances at normal and grazing incidence.
#[inline]
fn schlick(cos: f32, normal: Rgb, edge: f32) -> Rgb {
    normal + (Rgb::splat(edge) - normal) * schlick_weight(cos)
}

/// Reflectance of a (micro)surface by angle of incidence.
pub(super) trait Curve {
    /// Returns the reflectance for light at `cos_i` to the (micro)surface's normal, on its front side.
    fn reflectance(&self, cos_i: f32) -> Rgb;

    /// Returns [`Curve::reflectance`] in all lanes.
    fn reflectance16(&self, cos_i: &F32x16) -> Vec3x16;

    /// Returns the maximum reflectance at any cosine >= `cos_min`, given the reflectance `normal` at normal incidence.
    ///
    /// The larger of the values at both ends is the maximum: a dielectric's reflectance grows towards grazing
    /// incidence, a conductor's may first fall and then rises to 1, and Schlick's approximation is monotonic.
    fn max_reflectance(&self, cos_min: f32, normal: Rgb) -> Rgb;
}

impl Curve for Fresnel {
    #[inline]
    fn reflectance(&self, cos_i: f32) -> Rgb {
        match *self {
            Fresnel::One => Rgb::ONE,
            Fresnel::Dielectric(eta) => Rgb::splat(dielectric(cos_i.max(0.0), eta)),
            Fresnel::Conductor { eta, k } => conductor(cos_i, eta, k),
            Fresnel::Schlick { normal, edge } => schlick(cos_i, normal, edge),
        }
    }

    #[inline]
    fn reflectance16(&self, cos_i: &F32x16) -> Vec3x16 {
        match *self {
            Fresnel::One => Vec3x16 { x: [1.0; LANES], y: [1.0; LANES], z: [1.0; LANES] },
            Fresnel::Dielectric(eta) => {
                let mut r = [0.0; LANES];
                for l in 0..LANES {
                    r[l] = dielectric(if cos_i[l] > 0.0 { cos_i[l] } else { 0.0 }, eta);
                }
                Vec3x16 { x: r, y: r, z: r }
            }
            Fresnel::Schlick { normal, edge } => {
                let mut r = Vec3x16::default();
                (0..LANES).for_each(|l| r.set(l, schlick(cos_i[l], normal, edge)));
                r
            }
            Fresnel::Conductor { eta, k } => {
                let channel = |eta: f32, k: f32| {
                    let mut r = [0.0; LANES];
                    for l in 0..LANES {
                        r[l] = conductor_channel(cos_i[l].clamp(0.0, 1.0), eta, k);
                    }
                    r
                };
                Vec3x16 { x: channel(eta.x, k.x), y: channel(eta.y, k.y), z: channel(eta.z, k.z) }
            }
        }
    }

    fn max_reflectance(&self, cos_min: f32, normal: Rgb) -> Rgb {
        match *self {
            Fresnel::Conductor { .. } | Fresnel::Schlick { .. } => self.reflectance(cos_min).max(normal),
            _ => self.reflectance(cos_min),
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
            let r = conductor(cos, Rgb::splat(1.5), Rgb::ZERO).x;
            assert!((r - dielectric(cos, 1.5)).abs() < 1e-5, "{cos}: {r} {}", dielectric(cos, 1.5));
        }
        assert!(conductor(0.0, Rgb::ONE, Rgb::ZERO).is_finite());
        assert!(conductor(0.0, Rgb::ZERO, Rgb::ONE).is_finite());
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
            let excess =
                fresnel.reflectance(cos) - fresnel.max_reflectance(cos_min, fresnel.reflectance(1.0));
            assert!(excess.max_element() < 5e-6, "{fresnel:?} {cos_min} {cos} {excess}");
        }
    }
}
