//! Two directions and the facet normal half-way between them, and bounds of that normal for a set of directions.
//!
//! With c = cos θ_i and m = wi · (mirror direction of wo), wo · wi = 2 cos θ_o c - m. So the half-way normal h has cos²
//! θ_h = (cos θ_o + c)² / (2 + 4 cos θ_o c - 2 m) and cos² (wo, h) = (1 + 2 cos θ_o c - m) / 2. The first grows with m
//! and has no maximum in c between the ends of its range. The second is least at the smallest c and the largest m.
//! Independently of c, the angle between n and h is at least half that between wi and the mirror direction, and the
//! angle between wo and h is at most half the sum of the two inclinations.

use super::{DirectionBound, DirectionBounds16};
use base::math::{F32x16, LANES, Vec3x16, select};
use glam::Vec3;

/// Rounding error of a cosine or of a product of two. It matters for α below 0.01.
const SLACK: f32 = 5e-7;

/// Squared length of the sum of two unit directions below which they count as opposite, so that no facet is visible.
const MIN_SUM_SQ: f32 = 1e-20;

/// Pair of directions.
#[derive(Clone, Copy, Debug)]
pub(in crate::material) struct Directions {
    pub wo: Vec3,
    pub wi: Vec3,
    /// Unit normal of the facets that reflect one into the other.
    pub half: Vec3,
}

impl Directions {
    /// Pairs two directions; `None` if they are opposite, so that no facet is visible.
    #[inline]
    pub fn new(wo: Vec3, wi: Vec3) -> Option<Directions> {
        let sum = wo + wi;
        let length_sq = sum.length_squared();
        (length_sq >= MIN_SUM_SQ).then(|| Directions { wo, wi, half: sum / length_sq.sqrt() })
    }
}

/// Pairs of directions, in sixteen lanes.
pub(in crate::material) struct Directions16<'a> {
    pub wo: &'a Vec3x16,
    pub wi: &'a Vec3x16,
    /// Squared first coordinates of the facet normals.
    pub x_sq: F32x16,
    /// Squared second coordinates of the facet normals.
    pub y_sq: F32x16,
    /// Squared sines of the facet normals' inclinations; 0, like the cosines, if no facet is visible.
    pub sin_sq: F32x16,
    /// Squared cosines of the facet normals' inclinations.
    pub cos_sq: F32x16,
    /// Cosines between `wo` and facet normal.
    pub cos_d: F32x16,
}

impl Directions16<'_> {
    /// Pairs the directions of each lane.
    #[inline(always)]
    pub fn new<'a>(wo: &'a Vec3x16, wi: &'a Vec3x16) -> Directions16<'a> {
        let zero = [0.0; LANES];
        let mut all =
            Directions16 { wo, wi, x_sq: zero, y_sq: zero, sin_sq: zero, cos_sq: zero, cos_d: zero };
        for l in 0..LANES {
            let (wo, wi) = (wo.get(l), wi.get(l));
            let h = wo + wi;
            let length_sq = h.length_squared();
            let inverse = select(length_sq > MIN_SUM_SQ, 1.0 / length_sq, 0.0);
            all.x_sq[l] = h.x * h.x * inverse;
            all.y_sq[l] = h.y * h.y * inverse;
            all.sin_sq[l] = (h.x * h.x + h.y * h.y) * inverse;
            all.cos_sq[l] = h.z * h.z * inverse;
            let d = wo.dot(h) * inverse.sqrt();
            all.cos_d[l] = select(d < 1.0, d, 1.0);
        }
        all
    }

    /// Sets the facet normals in the lanes of a mask, where rounding of a short sum of directions would blur them.
    #[inline]
    pub fn set_half(&mut self, mask: u16, half: &Vec3x16) {
        for l in 0..LANES {
            let (wo, h) = (self.wo.get(l), half.get(l));
            let (set, d) = (mask >> l & 1 != 0, wo.dot(h));
            self.x_sq[l] = select(set, h.x * h.x, self.x_sq[l]);
            self.y_sq[l] = select(set, h.y * h.y, self.y_sq[l]);
            self.sin_sq[l] = select(set, h.x * h.x + h.y * h.y, self.sin_sq[l]);
            self.cos_sq[l] = select(set, h.z * h.z, self.cos_sq[l]);
            self.cos_d[l] = select(set, select(d < 1.0, d, 1.0), self.cos_d[l]);
        }
    }

    /// Returns true if the lane's `wi` is above the surface and a facet is visible, for a `wo` above the surface.
    #[inline(always)]
    pub fn reflects(&self, lane: usize) -> bool {
        (self.wi.z[lane] > 0.0) & (self.sin_sq[lane] + self.cos_sq[lane] > 0.0)
    }
}

/// Bounds for the facets that reflect a set of directions to `wo`.
pub(in crate::material) struct FacetBound {
    /// Cosine of `wo`, at most 1.
    pub cos_o: f32,
    /// Maximum cosine of a direction.
    pub cos_max: f32,
    /// Minimum cosine of a direction.
    pub cos_min: f32,
    /// Minimum squared sine of the facet normal's inclination.
    pub sin_sq: f32,
    /// Minimum cosine between `wo` and the facet normal.
    pub cos_d: f32,
}

impl FacetBound {
    /// Bounds the facets. `cos_max` is that of the bound, at most 1 and above 0.
    #[inline]
    pub fn new(cos_o: f32, cos_max: f32, bound: &DirectionBound) -> FacetBound {
        let cos_o = cos_o.min(1.0);
        let cos_min = bound.cos_i_min.max(0.0).min(cos_max);
        FacetBound {
            cos_o,
            cos_max,
            cos_min,
            sin_sq: min_sin_sq(cos_o, cos_min, cos_max, bound.cos_mirror_max),
            cos_d: min_cos(cos_o, cos_min, bound.cos_mirror_max),
        }
    }
}

/// [`FacetBound`] in all lanes. Lanes whose directions are all below the horizon are undefined.
pub(in crate::material) struct FacetBounds16<'a> {
    pub cos_max: &'a F32x16,
    pub cos_min: F32x16,
    pub sin_sq: F32x16,
    pub cos_d: F32x16,
}

impl FacetBounds16<'_> {
    /// Bounds the facets of each lane.
    #[inline(always)]
    pub fn new<'a>(cos_o: &F32x16, bounds: &'a DirectionBounds16) -> FacetBounds16<'a> {
        let (mut sin_sq, mut cos_d, mut least) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for l in 0..LANES {
            let cos_o = if cos_o[l] < 1.0 { cos_o[l] } else { 1.0 };
            let cos_max = bounds.cos_i_max[l];
            let cos_min = if bounds.cos_i_min[l] > 0.0 { bounds.cos_i_min[l] } else { 0.0 };
            let cos_min = if cos_min < cos_max { cos_min } else { cos_max };
            least[l] = cos_min;
            let mirror = bounds.cos_mirror_max[l];
            sin_sq[l] = min_sin_sq(cos_o, cos_min, cos_max, mirror);
            cos_d[l] = min_cos(cos_o, cos_min, mirror);
        }
        FacetBounds16 { cos_max: &bounds.cos_i_max, cos_min: least, sin_sq, cos_d }
    }
}

/// Returns the minimum squared sine of the facet normal's inclination.
#[inline(always)]
fn min_sin_sq(cos_o: f32, cos_i_min: f32, cos_i_max: f32, cos_mirror: f32) -> f32 {
    let at = |cos_i: f32| {
        // 1 - cos² θ_h; the order of the numerator avoids cancellation. The value is undefined if cos_i and cos_mirror
        // exclude each other; the bound below holds in that case.
        let length_sq = 2.0 + 4.0 * cos_o * cos_i - 2.0 * cos_mirror;
        let difference = cos_o - cos_i;
        (2.0 * (1.0 - cos_mirror - SLACK) - difference * difference) / length_sq.max(SLACK)
    };
    let by_cosines = at(cos_i_min).min(at(cos_i_max));
    let by_mirror = 0.5 * (1.0 - cos_mirror - SLACK);
    by_cosines.max(by_mirror).max(0.0)
}

/// Returns the minimum cosine between `wo` and the facet normal.
#[inline(always)]
fn min_cos(cos_o: f32, cos_i_min: f32, cos_mirror: f32) -> f32 {
    let product = cos_o * cos_i_min;
    let sin_product = ((1.0 - cos_o * cos_o) * (1.0 - cos_i_min * cos_i_min)).max(0.0).sqrt();
    let cos_between = (2.0 * product - cos_mirror).max(product - sin_product);
    (0.5 * (1.0 + cos_between) - SLACK).max(0.0).sqrt()
}
