//! Isotropic microfacet distributions: density, Smith masking and sampling of visible normals.
//!
//! Masking is expressed as `V1 = G1 / (2 cos θ)`, which stays finite at the horizon, where G1 / cos θ is 0/0. The
//! reflection lobe is then `F D V1(wo) V1(wi)` and its sampling density `D V1(wo) / 2`.
//!
//! Paper: Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, 2007 (D, G1); Heitz and d'Eon,
//! *Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals*, 2014; Heitz, *Sampling the
//! GGX Distribution of Visible Normals*, 2018; Giles, *Approximating the erfinv function*, 2010; Abramowitz and Stegun
//! 7.1.26 (erfc).
//! Deviations: Beckmann's masking in the BSDF is Walter's rational fit, as in Mitsuba. The sampling density uses the
//! exact function, which is the one that visible normals follow. The weight of a sample accounts for the difference (up
//! to 0.35 %).

use base::math::{F32x16, LANES, Rgb, Vec2x16, Vec3x16, lane_exp, select};
use base::sampling::uniform_disk;
use glam::{Vec2, Vec3};
use scene::Distribution;
use std::f32::consts::FRAC_1_PI;

/// 1 / √π.
const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

/// Minimum roughness α. A perfect mirror is a lobe of its own.
pub(super) const MIN_ALPHA: f32 = 1e-4;

/// Minimum squared cosine of a facet, which keeps cos⁴ representable. Beckmann's D is 0 to single precision there.
const MIN_COS_SQ: f32 = 1e-16;

/// Exponent beyond which Beckmann's D counts as 0, because subnormal numbers would only be slow.
const MAX_EXPONENT: f32 = 50.0;

/// Microfacet distribution of a given roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Microfacets {
    pub distribution: Distribution,
    pub alpha: f32,
    alpha_sq: f32,
}

impl Microfacets {
    /// Makes the distribution of roughness `alpha`.
    pub fn new(distribution: Distribution, alpha: f32) -> Microfacets {
        let alpha = alpha.max(MIN_ALPHA);
        Microfacets { distribution, alpha, alpha_sq: alpha * alpha }
    }

    /// Returns D, the area of facets with unit normal `h` per area and solid angle.
    #[inline]
    pub fn density(&self, h: Vec3) -> f32 {
        self.density_from(h.x * h.x + h.y * h.y, h.z * h.z)
    }

    /// Returns D from the squared sine and cosine of the facet's inclination.
    #[inline]
    pub fn density_from(&self, sin_sq: f32, cos_sq: f32) -> f32 {
        let a2 = self.alpha_sq;
        match self.distribution {
            Distribution::Ggx => {
                let t = sin_sq / a2 + cos_sq;
                FRAC_1_PI / (a2 * t * t)
            }
            Distribution::Beckmann => {
                let cos_sq = cos_sq.max(MIN_COS_SQ);
                let exponent = sin_sq / (a2 * cos_sq);
                if exponent > MAX_EXPONENT {
                    return 0.0;
                }
                (-exponent).exp() * FRAC_1_PI / (a2 * cos_sq * cos_sq)
            }
        }
    }

    /// Returns the maximum D at any inclination whose squared sine is at least `sin_sq`.
    #[inline]
    pub fn max_density(&self, sin_sq: f32) -> f32 {
        let a2 = self.alpha_sq;
        // D decreases with inclination, but has its maximum farther out on very rough surfaces.
        let peak = match self.distribution {
            Distribution::Ggx if a2 > 1.0 => 1.0,
            Distribution::Beckmann if a2 > 0.5 => 1.0 - 0.5 / a2,
            _ => 0.0,
        };
        let sin_sq = sin_sq.max(peak).min(1.0);
        self.density_from(sin_sq, 1.0 - sin_sq)
    }

    /// Returns [`Microfacets::density_from`] in all lanes.
    #[inline]
    pub fn density16(&self, sin_sq: &F32x16, cos_sq: &F32x16) -> F32x16 {
        let (a2, inverse) = (self.alpha_sq, 1.0 / self.alpha_sq);
        let mut density = [0.0; LANES];
        match self.distribution {
            Distribution::Ggx => {
                for l in 0..LANES {
                    let t = sin_sq[l] * inverse + cos_sq[l];
                    density[l] = FRAC_1_PI / (a2 * t * t);
                }
            }
            Distribution::Beckmann => {
                for l in 0..LANES {
                    let cos_sq = select(cos_sq[l] > MIN_COS_SQ, cos_sq[l], MIN_COS_SQ);
                    let exponent = sin_sq[l] * inverse / cos_sq;
                    let inside = exponent <= MAX_EXPONENT;
                    let gauss = lane_exp(select(inside, -exponent, -MAX_EXPONENT));
                    density[l] = select(inside, gauss * FRAC_1_PI / (a2 * cos_sq * cos_sq), 0.0);
                }
            }
        }
        density
    }

    /// Returns [`Microfacets::max_density`] in all lanes.
    #[inline]
    pub fn max_density16(&self, sin_sq: &F32x16) -> F32x16 {
        let mut density = [0.0; LANES];
        for l in 0..LANES {
            density[l] = self.max_density(sin_sq[l]);
        }
        density
    }

    /// Returns V1 = G1 / (2 cos θ) of the BSDF for a direction at `cos` > 0.
    #[inline]
    pub fn v1(&self, cos: f32) -> f32 {
        let sin_sq = (1.0 - cos * cos).max(0.0);
        match self.distribution {
            Distribution::Ggx => 1.0 / (cos + (cos * cos + self.alpha_sq * sin_sq).sqrt()),
            Distribution::Beckmann => {
                let alpha_sin = self.alpha * sin_sq.sqrt();
                if cos >= 1.6 * alpha_sin {
                    return 0.5 / cos;
                }
                walter_v1(cos, alpha_sin)
            }
        }
    }

    /// Returns [`Microfacets::v1`] in all lanes. Cosines beyond 0..1 count as 1.
    #[inline]
    pub fn v1_16(&self, cos: &F32x16) -> F32x16 {
        let mut v1 = [0.0; LANES];
        let within = |cos: f32| select((cos > 0.0) & (cos < 1.0), cos, 1.0);
        match self.distribution {
            Distribution::Ggx => {
                for l in 0..LANES {
                    let cos = within(cos[l]);
                    v1[l] = 1.0 / (cos + (cos * cos + self.alpha_sq * (1.0 - cos * cos)).sqrt());
                }
            }
            Distribution::Beckmann => {
                for l in 0..LANES {
                    let cos = within(cos[l]);
                    let alpha_sin = self.alpha * (1.0 - cos * cos).sqrt();
                    // Both values are computed: a branch would not compile to vector code.
                    let (steep, shallow) = (0.5 / cos, walter_v1(cos, alpha_sin));
                    v1[l] = select(cos >= 1.6 * alpha_sin, steep, shallow);
                }
            }
        }
        v1
    }

    /// Returns the V1 that normalises the density of visible normals.
    #[inline]
    pub fn v1_exact(&self, cos: f32) -> f32 {
        match self.distribution {
            Distribution::Ggx => self.v1(cos),
            Distribution::Beckmann => {
                let alpha_sin = self.alpha * (1.0 - cos * cos).max(0.0).sqrt();
                if cos >= 5.0 * alpha_sin {
                    return 0.5 / cos; // exp(-25) is below rounding.
                }
                let a = cos / alpha_sin;
                let scaled_erfc = scaled_erfc(a);
                1.0 / (2.0 * cos + (-a * a).exp() * (alpha_sin * FRAC_1_SQRT_PI - cos * scaled_erfc))
            }
        }
    }

    /// Returns an upper bound of G1 at any cosine in `0..=cos_max`.
    #[inline]
    pub fn max_g1(&self, cos_max: f32) -> f32 {
        let g1 = 2.0 * cos_max * self.v1(cos_max);
        match self.distribution {
            Distribution::Ggx => g1,
            // Walter's fit exceeds 1 by 7e-5 shortly before its cut-off.
            Distribution::Beckmann => g1.max(if g1 > 0.99 { 1.0001 } else { 0.0 }),
        }
    }

    /// Samples a facet normal seen from `wo` (`wo.z` > 0), with density D(h) G1(wo) (wo·h) / cos θ_o.
    #[inline]
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let stretched = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        match self.distribution {
            Distribution::Ggx => self.visible_ggx_normal(stretched, u),
            Distribution::Beckmann => {
                let along = visible_gaussian_slope(stretched, u.x);
                self.normal_from_slopes(stretched, along, gaussian_slope(u.y))
            }
        }
    }

    /// Samples facet normals seen from `wo` in all lanes as [`Microfacets::sample_visible`] does; `None` unless the
    /// distribution is GGX.
    #[inline]
    pub fn ggx_normals16(&self, wo: Vec3, u: &Vec2x16) -> Option<Vec3x16> {
        if self.distribution != Distribution::Ggx {
            return None;
        }
        let stretched = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let mut normals = Vec3x16::ZERO;
        for l in 0..LANES {
            normals.set(l, self.visible_ggx_normal(stretched, u.get(l)));
        }
        Some(normals)
    }

    /// Integrates the mean of `f(h)` over the facet normals seen from `wo`, by a product rule. `rule` has an even
    /// number of nodes, `wo` lies in the xz plane, and `f` is symmetric about it, so that one half is enough.
    pub fn mean_over_visible(&self, wo: Vec3, rule: &[(f32, f32)], f: impl Fn(Vec3) -> Rgb) -> Rgb {
        let stretched = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let half = &rule[..rule.len() / 2];
        let mut sum = Rgb::ZERO;
        for &(u, weight_u) in rule {
            let along = match self.distribution {
                Distribution::Ggx => 0.0,
                Distribution::Beckmann => visible_gaussian_slope(stretched, u),
            };
            for &(v, weight_v) in half {
                let h = match self.distribution {
                    Distribution::Ggx => self.visible_ggx_normal(stretched, Vec2::new(v, u)),
                    Distribution::Beckmann => self.normal_from_slopes(stretched, along, gaussian_slope(v)),
                };
                sum += 2.0 * weight_u * weight_v * f(h);
            }
        }
        sum
    }

    /// Samples a visible normal of the unit hemisphere seen from `stretched`, unstretched.
    #[inline(always)]
    fn visible_ggx_normal(&self, stretched: Vec3, u: Vec2) -> Vec3 {
        let across = Vec3::new(-stretched.y, stretched.x, 0.0).try_normalize().unwrap_or(Vec3::Y);
        let up = stretched.cross(across);
        // The projected hemisphere is a half disk above and a half ellipse below.
        let mut p = uniform_disk(u);
        let s = 0.5 * (1.0 + stretched.z);
        p.y = (1.0 - s) * (1.0 - p.x * p.x).max(0.0).sqrt() + s * p.y;
        let towards = (1.0 - p.length_squared()).max(0.0).sqrt();
        let n = p.x * across + p.y * up + towards * stretched;
        Vec3::new(self.alpha * n.x, self.alpha * n.y, n.z.max(0.0)).try_normalize().unwrap_or(Vec3::Z)
    }

    /// Returns the normal of a facet from its slopes along and across the view, for unit roughness.
    #[inline]
    fn normal_from_slopes(&self, stretched: Vec3, along: f32, across: f32) -> Vec3 {
        let sin = (stretched.x * stretched.x + stretched.y * stretched.y).sqrt();
        let (cos_phi, sin_phi) = if sin > 0.0 { (stretched.x / sin, stretched.y / sin) } else { (1.0, 0.0) };
        let x = cos_phi * along - sin_phi * across;
        let y = sin_phi * along + cos_phi * across;
        Vec3::new(-self.alpha * x, -self.alpha * y, 1.0).normalize()
    }
}

/// Returns Walter's fit of Beckmann's V1, for cosines below 1.6 `alpha_sin`.
#[inline(always)]
fn walter_v1(cos: f32, alpha_sin: f32) -> f32 {
    let a = cos / alpha_sin;
    0.5 * (3.535 + 2.181 * a) / ((1.0 + (2.276 + 2.577 * a) * a) * alpha_sin)
}

/// Samples the slope of a visible facet across the view, for unit roughness. Visibility does not depend on it.
#[inline]
fn gaussian_slope(u: f32) -> f32 {
    erf_inv(2.0 * u.clamp(1e-7, 1.0 - 1e-7) - 1.0)
}

/// Samples the slope of a visible facet along the view, for unit roughness. The distribution (cos θ - x sin θ)⁺
/// exp(-x²) is inverted by Halley's method within a bracket.
fn visible_gaussian_slope(stretched: Vec3, u: f32) -> f32 {
    let cos = stretched.z;
    let sin = (stretched.x * stretched.x + stretched.y * stretched.y).sqrt();
    let u = u.clamp(1e-7, 1.0 - 1e-7);
    // exp(-x²), and twice the unnormalised distribution function.
    let gauss_cdf = |x: f32| {
        let gauss = lane_exp(-x * x);
        let tail = gauss * scaled_erfc(x.abs());
        (gauss, cos * (if x < 0.0 { tail } else { 2.0 - tail }) + sin * FRAC_1_SQRT_PI * gauss)
    };
    let mut high = if cos < 4.5 * sin { cos / sin } else { 4.5 };
    let mut low = -4.5;
    let target = u * gauss_cdf(high).1;
    // Exact for grazing incidence, and for normal incidence to first order in the inclination.
    let mut x = cos * (erf_inv(2.0 * u - 1.0) - 0.5 * sin) - (1.0 - cos) * (-u.ln()).sqrt();
    for _ in 0..16 {
        if !(x > low && x < high) {
            x = 0.5 * (low + high);
        }
        let (gauss, cdf) = gauss_cdf(x);
        let error = cdf - target;
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let visible = cos - x * sin;
        let newton = error / (2.0 * FRAC_1_SQRT_PI * gauss * visible);
        // The second derivative over the first is -2 x - sin / visible.
        let step = newton / (1.0 + newton * (x + 0.5 * sin / visible)).max(0.3);
        x -= step;
        if step.abs() < 0.01 {
            break; // Convergence is cubic: the next step would be below 1e-5.
        }
    }
    x.clamp(-4.5, 4.5)
}

/// Returns exp(x²) erfc(x) for x >= 0, with an error of at most 1.5e-7 in erfc.
#[inline]
fn scaled_erfc(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    t * (0.254_829_6 + t * (-0.284_496_73 + t * (1.421_413_7 + t * (-1.453_152 + t * 1.061_405_4))))
}

/// Returns the inverse of the error function on (-1, 1), single precision.
#[inline]
fn erf_inv(x: f32) -> f32 {
    let w = -((1.0 - x) * (1.0 + x)).ln();
    let horner = |w: f32, c: &[f32; 9]| c.iter().fold(0.0, |sum, c| sum * w + c);
    x * if w < 5.0 {
        horner(
            w - 2.5,
            &[
                2.810_226_4e-8,
                3.432_739_4e-7,
                -3.523_387_7e-6,
                -4.391_506_5e-6,
                2.185_808_7e-4,
                -1.253_725e-3,
                -4.177_681_6e-3,
                2.466_407_3e-1,
                1.501_409_4,
            ],
        )
    } else {
        horner(
            w.sqrt() - 3.0,
            &[
                -2.002_142_6e-4,
                1.009_505_6e-4,
                1.349_343_2e-3,
                -3.673_428_4e-3,
                5.739_507_7e-3,
                -7.622_461_3e-3,
                9.438_870_5e-3,
                1.001_674,
                2.832_976_8,
            ],
        )
    }
}
