//! Unit vectors in 28 bits.
//!
//! Paper: Cigolle et al., *A Survey of Efficient Representations for Independent Unit Vectors*, JCGT 2014.

use glam::Vec3;

/// Number of bits of each coordinate.
const BITS: u32 = 14;
const STEPS: f32 = ((1 << BITS) - 2) as f32;
const MASK: u32 = (1 << BITS) - 1;

/// Encodes a unit vector: maps it to the octahedron unfolded over a square. The upper four bits are 0.
///
/// The number of steps is even, so that the axes themselves are exact.
pub fn encode(v: Vec3) -> u32 {
    let v = v / (v.x.abs() + v.y.abs() + v.z.abs()).max(f32::MIN_POSITIVE);
    let (x, y) = if v.z >= 0.0 {
        (v.x, v.y)
    } else {
        ((1.0 - v.y.abs()) * 1f32.copysign(v.x), (1.0 - v.x.abs()) * 1f32.copysign(v.y))
    };
    let quantise = |c: f32| ((c.clamp(-1.0, 1.0) * 0.5 + 0.5) * STEPS).round() as u32;
    quantise(x) | quantise(y) << BITS
}

/// Decodes the unit vector of a code, whose upper four bits are ignored.
#[inline]
pub fn decode(code: u32) -> Vec3 {
    let coordinate = |c: u32| c as f32 * (2.0 / STEPS) - 1.0;
    let (x, y) = (coordinate(code & MASK), coordinate(code >> BITS & MASK));
    let z = 1.0 - x.abs() - y.abs();
    // Below the horizon the corners of the square fold over.
    let fold = (-z).max(0.0);
    Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_exact_and_all_directions_within_3e_4_rad() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
            assert!((decode(encode(axis)) - axis).length() < 1e-6, "{axis}");
        }
        let mut worst = 0.0f32;
        for i in 0..20_000u32 {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / 20_000.0;
            let phi = i as f32 * 2.399_963;
            let r = (1.0 - z * z).sqrt();
            let v = Vec3::new(r * phi.cos(), r * phi.sin(), z);
            let back = decode(encode(v));
            assert!((back.length() - 1.0).abs() < 1e-6);
            worst = worst.max((back - v).length());
        }
        assert!(worst < 3e-4, "{worst}");
    }
}
