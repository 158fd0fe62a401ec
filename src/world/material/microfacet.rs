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

use base::math::{Lane, Mask, Rgb, V3};
use base::sampling::disk_point;
use glam::Vec3;
use scene::Distribution;
use std::f32::consts::PI;

/// 1 / √π.
const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

/// Minimum roughness α. A perfect mirror is a lobe of its own.
pub(super) const MIN_ALPHA: f32 = 1e-4;

/// Minimum squared cosine of a facet, which keeps cos⁴ representable. Beckmann's D is 0 to single precision there.
const MIN_COS_SQ: f32 = 1e-16;

/// Maximum slope of a facet of unit roughness that is sampled; exp(-20) is below rounding.
const MAX_SLOPE: f32 = 4.5;

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

    /// Returns D, the area of facets per area and solid angle, from the squared sine and cosine of their inclination.
    #[inline(always)]
    pub fn density<L: Lane>(&self, sin_sq: L, cos_sq: L) -> L {
        let (a2, inverse) = (self.alpha_sq, 1.0 / self.alpha_sq);
        match self.distribution {
            Distribution::Ggx => {
                let t = sin_sq * inverse + cos_sq;
                (t.sq() * (PI * a2)).recip()
            }
            Distribution::Beckmann => {
                let inv_cos_sq = cos_sq.max(L::from(MIN_COS_SQ)).recip();
                let exponent = sin_sq * inverse * inv_cos_sq;
                let gauss = (-exponent.min(L::from(MAX_EXPONENT))).exp();
                (gauss * (inverse / PI) * inv_cos_sq.sq()).keep(L::from(MAX_EXPONENT).gt(exponent))
            }
        }
    }

    /// Returns the maximum D at any inclination whose squared sine is at least `sin_sq`.
    #[inline(always)]
    pub fn max_density<L: Lane>(&self, sin_sq: L) -> L {
        let a2 = self.alpha_sq;
        // D decreases with inclination, but has its maximum farther out on very rough surfaces.
        let peak = match self.distribution {
            Distribution::Ggx if a2 > 1.0 => 1.0,
            Distribution::Beckmann if a2 > 0.5 => 1.0 - 0.5 / a2,
            _ => 0.0,
        };
        let sin_sq = sin_sq.max(L::from(peak)).min(L::from(1.0));
        self.density(sin_sq, sin_sq.rest())
    }

    /// Returns V1 = G1 / (2 cos θ) of the BSDF for a direction at `cos` > 0; at most 1 counts.
    #[inline(always)]
    pub fn v1<L: Lane>(&self, cos: L) -> L {
        let cos = cos.min(L::from(1.0));
        let sin_sq = cos.sq().rest();
        match self.distribution {
            Distribution::Ggx => (cos + (cos.sq() + sin_sq * self.alpha_sq).sqrt()).recip(),
            Distribution::Beckmann => {
                // Walter's fit in a = 1 / (α tan θ) is 1 from 1.6.
                let alpha_sin = sin_sq.max(L::from(1e-12)).sqrt() * self.alpha;
                let a = cos / alpha_sin;
                let one = L::from(1.0);
                let fit =
                    (a * 1.0905 + L::from(1.7675)) / (((a * 2.577 + L::from(2.276)) * a + one) * alpha_sin);
                L::pick(a.gt(L::from(1.6)), cos.recip() * 0.5, fit)
            }
        }
    }

    /// Returns the V1 that normalises the density of visible normals.
    #[inline(always)]
    pub fn v1_exact<L: Lane>(&self, cos: L) -> L {
        match self.distribution {
            Distribution::Ggx => self.v1(cos),
            Distribution::Beckmann => {
                let cos = cos.min(L::from(1.0));
                let alpha_sin = cos.sq().rest().max(L::from(1e-12)).sqrt() * self.alpha;
                let a = (cos / alpha_sin).min(L::from(5.0)); // exp(-25) is below rounding.
                let tail = (-a.sq()).exp() * (alpha_sin * FRAC_1_SQRT_PI - cos * scaled_erfc(a));
                (cos * 2.0 + tail.keep(L::from(5.0).gt(a))).recip()
            }
        }
    }

    /// Returns an upper bound of G1 at any cosine in `0..=cos_max`.
    #[inline(always)]
    pub fn max_g1<L: Lane>(&self, cos_max: L) -> L {
        let g1 = cos_max * self.v1(cos_max) * 2.0;
        match self.distribution {
            Distribution::Ggx => g1,
            // Walter's fit exceeds 1 by 7e-5 shortly before its cut-off.
            Distribution::Beckmann => g1.max(L::from(1.0001).keep(g1.gt(L::from(0.99)))),
        }
    }

    /// Samples a facet normal seen from `wo` (`wo.z` > 0), with density D(h) G1(wo) (wo·h) / cos θ_o.
    #[inline(always)]
    pub fn sample_visible<L: Lane>(&self, wo: V3<L>, u: [L; 2]) -> V3<L> {
        let view = self.stretch(wo);
        match self.distribution {
            Distribution::Ggx => self.ggx_normal(&view, u),
            Distribution::Beckmann => {
                let along = visible_slope(view.cos, view.sin, u[0]);
                self.normal_from_slopes(&view, along, slope_across(u[1]))
            }
        }
    }

    /// Integrates the mean of `f(h)` over the facet normals seen from `wo`, by a product rule. `rule` has an even
    /// number of nodes, `wo` lies in the xz plane, and `f` is symmetric about it, so that one half is enough.
    pub fn mean_over_visible(&self, wo: Vec3, rule: &[(f32, f32)], f: impl Fn(Vec3) -> Rgb) -> Rgb {
        let view = self.stretch(V3::splat(wo));
        let half = &rule[..rule.len() / 2];
        let mut sum = Rgb::ZERO;
        for &(u, weight_u) in rule {
            let along = match self.distribution {
                Distribution::Ggx => 0.0,
                Distribution::Beckmann => visible_slope(view.cos, view.sin, u),
            };
            for &(v, weight_v) in half {
                let h = match self.distribution {
                    Distribution::Ggx => self.ggx_normal(&view, [v, u]),
                    Distribution::Beckmann => self.normal_from_slopes(&view, along, slope_across(v)),
                };
                sum += 2.0 * weight_u * weight_v * f(h.into());
            }
        }
        sum
    }

    /// Stretches the view, after which the facets have unit roughness.
    #[inline(always)]
    fn stretch<L: Lane>(&self, wo: V3<L>) -> Stretched<L> {
        let v = V3::new(wo.x * self.alpha, wo.y * self.alpha, wo.z);
        let v = v.times(v.length_sq().rsqrt());
        let sin_sq = v.x.sq() + v.y.sq();
        // At normal incidence every azimuth is right.
        let is_level = !sin_sq.gt(L::from(1e-24));
        let inv_sin = sin_sq.max(L::from(1e-24)).rsqrt();
        Stretched {
            cos: v.z,
            sin: sin_sq * inv_sin,
            cos_phi: L::pick(is_level, L::from(1.0), v.x * inv_sin),
            sin_phi: L::pick(is_level, L::from(0.0), v.y * inv_sin),
        }
    }

    /// Samples a visible normal of the unit hemisphere, unstretched.
    #[inline(always)]
    fn ggx_normal<L: Lane>(&self, view: &Stretched<L>, u: [L; 2]) -> V3<L> {
        let &Stretched { cos, sin, cos_phi, sin_phi } = view;
        let across = V3::new(-sin_phi, cos_phi, L::from(0.0));
        let up = V3::new(-cos * cos_phi, -cos * sin_phi, sin);
        // The projected hemisphere is a half disk above and a half ellipse below.
        let [x, y] = disk_point(u);
        let s = (cos + L::from(1.0)) * 0.5;
        let y = s.rest() * x.sq().rest().positive().sqrt() + s * y;
        let towards = (x.sq() + y.sq()).rest().positive().sqrt();
        let n = across.times(x) + up.times(y) + V3::new(sin * cos_phi, sin * sin_phi, cos).times(towards);
        // The floor turns a normal of length 0 upwards.
        let h = V3::new(n.x * self.alpha, n.y * self.alpha, n.z.max(L::from(1e-18)));
        h.times(h.length_sq().rsqrt())
    }

    /// Returns the normal of a facet from its slopes along and across the view, for unit roughness.
    #[inline(always)]
    fn normal_from_slopes<L: Lane>(&self, view: &Stretched<L>, along: L, across: L) -> V3<L> {
        let x = view.cos_phi * along - view.sin_phi * across;
        let y = view.sin_phi * along + view.cos_phi * across;
        let h = V3::new(x * -self.alpha, y * -self.alpha, L::from(1.0));
        h.times(h.length_sq().rsqrt())
    }
}

/// Direction of the view after the stretch: inclination and azimuth.
struct Stretched<L> {
    cos: L,
    sin: L,
    cos_phi: L,
    sin_phi: L,
}

/// Returns a number as an argument at which the distribution functions of slopes are finite.
#[inline(always)]
fn inside<L: Lane>(u: L) -> L {
    u.max(L::from(1e-7)).min(L::from(1.0 - 1e-7))
}

/// Samples the slope of a visible facet across the view, for unit roughness. Visibility does not depend on it.
#[inline(always)]
fn slope_across<L: Lane>(u: L) -> L {
    erf_inv(inside(u) * 2.0 - L::from(1.0))
}

/// Samples the slope of a visible facet along the view, for unit roughness. The distribution (cos θ - x sin θ)⁺
/// exp(-x²) is inverted by Halley's method within a bracket.
#[inline(always)]
fn visible_slope<L: Lane>(cos: L, sin: L, u: L) -> L {
    let (zero, one) = (L::from(0.0), L::from(1.0));
    let u = inside(u);
    // exp(-x²), and twice the unnormalised distribution function.
    let gauss_cdf = |x: L| {
        let gauss = (-x.sq()).exp();
        let tail = gauss * scaled_erfc(x.abs());
        (gauss, cos * L::pick(zero.gt(x), tail, L::from(2.0) - tail) + sin * gauss * FRAC_1_SQRT_PI)
    };
    let mut high = (cos / sin.max(L::from(1e-12))).min(L::from(MAX_SLOPE));
    let mut low = L::from(-MAX_SLOPE);
    let target = u * gauss_cdf(high).1;
    // Exact for grazing incidence, and for normal incidence to first order in the inclination.
    let mut x = cos * (erf_inv(u * 2.0 - one) - sin * 0.5) - cos.rest() * (-u.ln()).sqrt();
    for _ in 0..16 {
        x = L::pick(x.gt(low) & high.gt(x), x, (low + high) * 0.5);
        let (gauss, cdf) = gauss_cdf(x);
        let error = cdf - target;
        let is_above = error.is_positive();
        high = L::pick(is_above, x, high);
        low = L::pick(is_above, low, x);
        let visible = cos - x * sin;
        let newton = error / (gauss * visible * (2.0 * FRAC_1_SQRT_PI));
        // The second derivative over the first is -2 x - sin / visible.
        let step = newton / (newton * (x + sin * 0.5 / visible) + one).max(L::from(0.3));
        x = x - step;
        if !step.abs().gt(L::from(0.01)).any() {
            break; // Convergence is cubic: the next step would be below 1e-5.
        }
    }
    x.max(L::from(-MAX_SLOPE)).min(L::from(MAX_SLOPE))
}

/// Returns exp(x²) erfc(x) for x >= 0, with an error of at most 1.5e-7 in erfc.
#[inline(always)]
fn scaled_erfc<L: Lane>(x: L) -> L {
    let t = (x * 0.327_591_1 + L::from(1.0)).recip();
    let mut sum = L::from(1.061_405_4);
    for c in [-1.453_152, 1.421_413_7, -0.284_496_73, 0.254_829_6] {
        sum = sum.mul_add(t, L::from(c));
    }
    sum * t
}

/// Factors of the series of [`erf_inv`] about the middle, from the highest power down.
const MIDDLE: [f32; 9] = [
    2.810_226_4e-8,
    3.432_739_4e-7,
    -3.523_387_7e-6,
    -4.391_506_5e-6,
    2.185_808_7e-4,
    -1.253_725e-3,
    -4.177_681_6e-3,
    2.466_407_3e-1,
    1.501_409_4,
];

/// Factors of the series of [`erf_inv`] in the tails, from the highest power down.
const TAILS: [f32; 9] = [
    -2.002_142_6e-4,
    1.009_505_6e-4,
    1.349_343_2e-3,
    -3.673_428_4e-3,
    5.739_507_7e-3,
    -7.622_461_3e-3,
    9.438_870_5e-3,
    1.001_674,
    2.832_976_8,
];

/// Returns the inverse of the error function on (-1, 1), single precision.
#[inline(always)]
fn erf_inv<L: Lane>(x: L) -> L {
    let w = -(x.rest() * (x + L::from(1.0))).ln();
    let series = |w: L, factors: &[f32; 9]| {
        let mut sum = L::from(factors[0]);
        for factor in &factors[1..] {
            sum = sum.mul_add(w, L::from(*factor));
        }
        sum
    };
    let middle = series(w - L::from(2.5), &MIDDLE);
    let tails = series(w.positive().sqrt() - L::from(3.0), &TAILS);
    x * L::pick(L::from(5.0).gt(w), middle, tails)
}
