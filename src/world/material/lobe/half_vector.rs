//! Two directions and the facet normal half-way between them, and bounds of that normal for a set of directions;
//! factors of a lobe that is seen from a direction.
//!
//! With c = cos θ_i and m = wi · (mirror direction of wo), wo · wi = 2 cos θ_o c - m. So the half-way normal h has cos²
//! θ_h = (cos θ_o + c)² / (2 + 4 cos θ_o c - 2 m) and cos² (wo, h) = (1 + 2 cos θ_o c - m) / 2. The first grows with m
//! and has no maximum in c between the ends of its range. The second is least at the smallest c and the largest m.
//! Independently of c, the angle between n and h is at least half that between wi and the mirror direction, and the
//! angle between wo and h is at most half the sum of the two inclinations.

use base::math::{Lane, Rgb, V3};

/// Rounding error of a cosine or of a product of two. It matters for α below 0.01.
const SLACK: f32 = 5e-7;

/// Squared length of the sum of two unit directions below which they count as opposite, so that no facet is visible.
const MIN_SUM_SQ: f32 = 1e-20;

/// Two directions and the facets that reflect one into the other.
#[derive(Clone, Copy)]
pub(in crate::material) struct Facet<L: Lane> {
    pub wo: V3<L>,
    pub wi: V3<L>,
    /// Unit normal of the facets.
    pub half: V3<L>,
    /// Cosine between `wo` and `half`.
    pub cos_d: L,
    /// True if both directions are above the surface and a facet is visible.
    pub reflects: L::Mask,
}

impl<L: Lane> Facet<L> {
    /// Pairs two directions. No facet is visible between opposite directions.
    #[inline(always)]
    pub fn between(wo: V3<L>, wi: V3<L>) -> Facet<L> {
        let sum = wo + wi;
        let length_sq = sum.length_sq();
        let facet = Facet::with_half(wo, wi, sum.times(length_sq.max(L::from(MIN_SUM_SQ)).rsqrt()));
        Facet { reflects: facet.reflects & length_sq.gt(L::from(MIN_SUM_SQ)), ..facet }
    }

    /// Pairs two directions whose facet normal is known, and not blurred by the rounding of a short sum of directions.
    #[inline(always)]
    pub fn with_half(wo: V3<L>, wi: V3<L>, half: V3<L>) -> Facet<L> {
        let cos_d = wo.dot(half).min(L::from(1.0));
        Facet { wo, wi, half, cos_d, reflects: wo.z.is_positive() & wi.z.is_positive() }
    }

    /// Pairs a direction with its reflection on the facets of a normal.
    #[inline(always)]
    pub fn reflected(wo: V3<L>, half: V3<L>) -> Facet<L> {
        Facet::with_half(wo, half.times(wo.dot(half) * 2.0) - wo, half)
    }

    /// Returns `yes` where the mask is true, else `no`.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Facet<L>, no: Facet<L>) -> Facet<L> {
        Facet {
            wo: yes.wo,
            wi: V3::select(mask, yes.wi, no.wi),
            half: V3::select(mask, yes.half, no.half),
            cos_d: L::pick(mask, yes.cos_d, no.cos_d),
            reflects: mask & yes.reflects | !mask & no.reflects,
        }
    }

    /// Returns the squared sine and cosine of the facet normal's inclination.
    #[inline(always)]
    pub fn inclination(&self) -> (L, L) {
        (self.half.x.sq() + self.half.y.sq(), self.half.z.sq())
    }
}

/// Bounds for the facets that reflect a set of directions to `wo`.
pub(in crate::material) struct FacetBound<L = f32> {
    /// Maximum cosine of a direction.
    pub cos_max: L,
    /// Minimum cosine of a direction.
    pub cos_min: L,
    /// Minimum squared sine of the facet normal's inclination.
    pub sin_sq: L,
    /// Minimum cosine between `wo` and the facet normal.
    pub cos_d: L,
}

impl<L: Lane> FacetBound<L> {
    /// Bounds the facets. `cos_max` is that of the bound, at most 1 and above 0.
    #[inline(always)]
    pub fn new(cos_o: L, cos_max: L, bound: &DirectionBound<L>) -> FacetBound<L> {
        let cos_o = cos_o.min(L::from(1.0));
        let cos_min = bound.cos_i_min.positive().min(cos_max);
        FacetBound {
            cos_max,
            cos_min,
            sin_sq: min_sin_sq(cos_o, cos_min, cos_max, bound.cos_mirror_max),
            cos_d: min_cos(cos_o, cos_min, bound.cos_mirror_max),
        }
    }
}

/// Returns the minimum squared sine of the facet normal's inclination.
#[inline(always)]
fn min_sin_sq<L: Lane>(cos_o: L, cos_i_min: L, cos_i_max: L, cos_mirror: L) -> L {
    let open = cos_mirror.rest() - L::from(SLACK);
    let at = |cos_i: L| {
        // 1 - cos² θ_h; the order of the numerator avoids cancellation. The value is undefined if cos_i and cos_mirror
        // exclude each other; the bound below holds in that case.
        let length_sq = (cos_o * cos_i * 2.0 + cos_mirror.rest()) * 2.0;
        (open * 2.0 - (cos_o - cos_i).sq()) * length_sq.max(L::from(SLACK)).recip()
    };
    let by_cosines = at(cos_i_min).min(at(cos_i_max));
    by_cosines.max(open * 0.5).positive()
}

/// Returns the minimum cosine between `wo` and the facet normal.
#[inline(always)]
fn min_cos<L: Lane>(cos_o: L, cos_i_min: L, cos_mirror: L) -> L {
    let product = cos_o * cos_i_min;
    let sin_product = (cos_o.sq().rest() * cos_i_min.sq().rest()).positive().sqrt();
    let cos_between = (product * 2.0 - cos_mirror).max(product - sin_product);
    (cos_between * 0.5 + L::from(0.5 - SLACK)).positive().sqrt()
}

/// Bounds of a set of directions towards light. The normal is on the side of `wo`: it is the reversed shading normal if
/// a two-sided surface is seen from behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionBound<L = f32> {
    /// Maximum cosine to the normal. If it is <= 0, nothing is reflected.
    pub cos_i_max: L,
    /// Minimum cosine to the normal. If it is <= 0, grazing light is possible.
    pub cos_i_min: L,
    /// Maximum cosine to the mirror direction of `wo`.
    pub cos_mirror_max: L,
}

impl DirectionBound {
    /// Factor that covers the rounding of the reflectance and of D at the tip of a narrow lobe.
    pub(in crate::material) const WIDER: f32 = 1.000_01;
}

/// Factors of a lobe that depend on the direction of view alone.
#[derive(Clone, Copy)]
pub(in crate::material) struct SeenLobe<L> {
    /// Factor on the value.
    pub masking: L,
    /// Factor on the density.
    pub density: L,
}

impl<L: Lane> SeenLobe<L> {
    /// Returns the factors of a lobe that is not seen.
    #[inline(always)]
    pub fn none() -> SeenLobe<L> {
        SeenLobe { masking: L::from(0.0), density: L::from(0.0) }
    }

    /// Returns the factors in all lanes of a wider type.
    #[inline(always)]
    pub fn widen<D: Lane + From<L>>(&self) -> SeenLobe<D> {
        SeenLobe { masking: D::from(self.masking), density: D::from(self.density) }
    }
}

/// Returns the mean of the channels.
#[inline(always)]
pub(in crate::material) fn mean(c: Rgb) -> f32 {
    means(V3::splat(c))
}

/// Returns the means of the channels.
#[inline(always)]
pub(in crate::material) fn means<L: Lane>(c: V3<L>) -> L {
    (c.x + c.y + c.z) * (1.0 / 3.0)
}
