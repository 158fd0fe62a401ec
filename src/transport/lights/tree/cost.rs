//! Primitives that both builders sort, their bounds, and the cost of a cluster.
//!
//! Paper: Walter et al., *Lightcuts: A Scalable Approach to Illumination*, 2005, section 3.1: I(α² + c²(1 - cos β)²).
//! c is the scene's diagonal, as in the paper.
//! Deviations: while building, β is estimated from the box around the unit normals (a chord of length e spans a cone of
//! sin β = e/2). The finished nodes carry exact cones.

use crate::lights::{Profiles, VplKind, VplSet};
use base::math::luminance;
use glam::Vec3;

/// Coordinates of a primitive: position, normal, luminance of the intensity, and the bits of the VPL's index.
pub type PrimitiveCoordinates = [f32; 8];

/// Index of the luminance in [`PrimitiveCoordinates`].
pub const LUMINANCE: usize = 6;
/// Number of coordinates to cluster by: the first ones.
pub const DIMENSIONS: usize = 6;

/// VPL in the layout of the builders: 32 bytes, one vector register.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Primitive(pub PrimitiveCoordinates);

impl Primitive {
    /// Creates the primitive of VPL number `index` of a set.
    pub fn new(set: &VplSet, profiles: &Profiles, index: u32) -> Primitive {
        let vpl = &set.vpls[index as usize];
        let luminance = luminance(set.intensities[index as usize]);
        let (p, n) = match set.kind {
            VplKind::Lobed => (vpl.position, profiles.lobes[vpl.lobe()].axis()),
            VplKind::Omni => (vpl.position, Vec3::ZERO),
            VplKind::Oriented => (vpl.position, vpl.normal()),
            VplKind::Directional => (Vec3::ZERO, vpl.position),
        };
        Primitive([p.x, p.y, p.z, n.x, n.y, n.z, luminance, f32::from_bits(index)])
    }

    /// Index of the VPL.
    pub fn index(&self) -> u32 {
        self.0[7].to_bits()
    }

    /// Normal, axis of a lobe, or direction to the light; zero for omni VPLs.
    pub fn normal(&self) -> Vec3 {
        Vec3::new(self.0[3], self.0[4], self.0[5])
    }
}

/// Box around primitives, in all coordinates at once.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct PrimitiveBounds {
    /// Minimum of each coordinate.
    pub min: PrimitiveCoordinates,
    /// Maximum of each coordinate.
    pub max: PrimitiveCoordinates,
}

impl PrimitiveBounds {
    /// The empty box.
    pub const EMPTY: PrimitiveBounds =
        PrimitiveBounds { min: [f32::INFINITY; 8], max: [f32::NEG_INFINITY; 8] };

    /// True if nothing has been added.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.min[0] == f32::INFINITY
    }

    /// Creates the box around one primitive.
    #[inline]
    pub fn around_one(r: &Primitive) -> PrimitiveBounds {
        PrimitiveBounds { min: r.0, max: r.0 }
    }

    /// Creates the box around many primitives.
    pub fn around<'a>(primitives: impl Iterator<Item = &'a Primitive>) -> PrimitiveBounds {
        let mut b = PrimitiveBounds::EMPTY;
        for r in primitives {
            b.add(&PrimitiveBounds::around_one(r));
        }
        b
    }

    /// Extends the box to contain `other`. Each plain comparison is one instruction; no NaN can occur.
    #[inline]
    pub fn add(&mut self, other: &PrimitiveBounds) {
        for i in 0..8 {
            self.min[i] = if other.min[i] < self.min[i] { other.min[i] } else { self.min[i] };
            self.max[i] = if other.max[i] > self.max[i] { other.max[i] } else { self.max[i] };
        }
    }

    /// Extent along one coordinate.
    #[inline]
    pub fn extent(&self, i: usize) -> f32 {
        self.max[i] - self.min[i]
    }

    /// Extent along one dimension in units of length; `half_c` is half the diagonal of the scene.
    #[inline]
    pub fn width(&self, i: usize, half_c: f32) -> f32 {
        self.extent(i) * if i < 3 { 1.0 } else { half_c }
    }
}

/// Cost of a cluster of primitives within `bounds` of total luminance `intensity`. `c_sq` is the square of the scene's
/// diagonal, which makes an angle comparable with a length.
#[inline]
pub fn cluster_cost(bounds: &PrimitiveBounds, intensity: f64, c_sq: f32) -> f64 {
    let sq: PrimitiveCoordinates = std::array::from_fn(|i| {
        let extent = bounds.max[i] - bounds.min[i];
        extent * extent
    });
    let diagonal_sq = sq[0] + sq[1] + sq[2];
    let quarter_chord_sq = 0.25 * (sq[3] + sq[4] + sq[5]);
    let one_minus_cos = if quarter_chord_sq < 1.0 {
        1.0 - (1.0 - quarter_chord_sq).sqrt()
    } else {
        quarter_chord_sq.min(2.0)
    };
    intensity * f64::from(diagonal_sq + c_sq * one_minus_cos * one_minus_cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::{Origin, Vpl};
    use base::math::Rgb;

    fn oriented(p: Vec3, n: Vec3) -> Primitive {
        let mut set = VplSet::new(VplKind::Oriented, Origin::Direct);
        (0..8).for_each(|_| set.push(Vpl::oriented(p, n), Rgb::ONE));
        Primitive::new(&set, &Profiles::default(), 7)
    }

    #[test]
    fn a_primitive_keeps_its_index_and_bounds_ignore_its_bits() {
        let r = oriented(Vec3::ONE, Vec3::Y);
        assert_eq!(r.index(), 7);
        let b = PrimitiveBounds::around([r, oriented(Vec3::ZERO, Vec3::X)].iter());
        assert_eq!((b.extent(0), b.extent(3), b.extent(4)), (1.0, 1.0, 1.0));
    }

    #[test]
    fn cost_grows_with_size_angle_and_intensity() {
        let cost = |p: Vec3, n: Vec3, intensity| {
            let b = PrimitiveBounds::around([oriented(Vec3::ZERO, Vec3::Z), oriented(p, n)].iter());
            cluster_cost(&b, intensity, 4.0)
        };
        assert_eq!(cost(Vec3::ZERO, Vec3::Z, 1.0), 0.0);
        let (a, b, c) =
            (cost(Vec3::ZERO, Vec3::X, 1.0), cost(Vec3::X, Vec3::X, 1.0), cost(Vec3::X, -Vec3::Z, 1.0));
        assert!(0.0 < a && a < b && b < c, "{a} {b} {c}");
        assert_eq!(cost(Vec3::X, Vec3::X, 2.0), 2.0 * b);
    }
}
