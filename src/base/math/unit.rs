//! Unit directions of vectors of any length, and axes of transforms.

use glam::{DMat4, DVec3, Vec4Swizzles};

/// Range of squared lengths for which division by the length loses no precision.
const SAFE_SQUARED_LENGTHS: std::ops::Range<f64> = 1e-200..1e200;

/// Minimum sine of the angle between two directions that must not be parallel.
const MIN_SINE: f64 = 1e-12;

/// Returns the unit direction of `v`; `None` if `v` is zero or not finite.
///
/// Squares of components may underflow or overflow.
pub fn unit(v: DVec3) -> Option<DVec3> {
    if SAFE_SQUARED_LENGTHS.contains(&v.length_squared()) {
        return Some(v.normalize());
    }
    // The scale is a power of two, applied in two steps: that of the smallest numbers has no reciprocal.
    let exponent = v.abs().max_element().log2().floor();
    if !(exponent.is_finite() && v.is_finite()) {
        return None;
    }
    let half = (-0.5 * exponent).trunc();
    Some((v * half.exp2() * (-exponent - half).exp2()).normalize())
}

/// Returns the unit vector across `forward` and `up`, to the right as seen along the unit vector `forward`.
///
/// Returns `None` if `up` has no direction or is parallel to `forward`.
pub fn right_of(forward: DVec3, up: DVec3) -> Option<DVec3> {
    let across = forward.cross(unit(up)?);
    if !(across.length() > MIN_SINE) {
        return None;
    }
    // Normalising a short product would magnify its rounding error along `forward`.
    unit(unit(across)?.reject_from_normalized(forward))
}

/// Returns an affine transform with unit axes, as upright as the others, in place of axes of length 0.
pub fn unflattened(matrix: DMat4) -> DMat4 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec4Swizzles::xyz);
    let [ux, uy, uz] = [x, y, z].map(unit);
    // The vector product of the next two axes is the third one.
    let across = |a: Option<DVec3>, b: Option<DVec3>| unit(a?.cross(b?));
    let beside = |a: Option<DVec3>| a.map(DVec3::any_orthonormal_vector);
    let axes = match [ux, uy, uz] {
        [Some(_), Some(_), Some(_)] => return matrix,
        [None, None, None] => [DVec3::X, DVec3::Y, DVec3::Z].map(Some),
        [None, None, Some(_)] => [across(beside(uz), uz), beside(uz), Some(z)],
        [None, Some(_), None] => [beside(uy), Some(y), across(beside(uy), uy)],
        [Some(_), None, None] => [Some(x), beside(ux), across(ux, beside(ux))],
        [None, ..] => [across(uy, uz), Some(y), Some(z)],
        [_, None, _] => [Some(x), across(uz, ux), Some(z)],
        [.., None] => [Some(x), Some(y), across(ux, uy)],
    };
    let [x, y, z] = axes.map(Option::unwrap_or_default).map(|axis| axis.extend(0.0));
    DMat4::from_cols(x, y, z, matrix.w_axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DQuat};

    #[test]
    fn directions_of_any_length_are_unit_vectors() {
        for length in [5e-324, 1e-310, 1e-160, 1e-3, 1.0, 1e160, 1e308] {
            for towards in [DVec3::X, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 0.0, -1e-3)] {
                let unit = unit(towards * length).unwrap();
                assert!((unit.length() - 1.0).abs() < 1e-15, "{length}: {unit}");
                assert!(length < 1e-300 || (unit - towards.normalize()).length() < 1e-15, "{length}: {unit}");
            }
        }
        for none in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::new(1.0, f64::NEG_INFINITY, 0.0)] {
            assert_eq!(unit(none), None);
        }
    }

    #[test]
    fn axes_without_length_follow_the_others() {
        let turn = DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(0.3);
        let whole = DMat4::from_rotation_translation(turn, DVec3::splat(3.0));
        for zeros in 0..8 {
            let scale = DVec3::from_array(std::array::from_fn(|i| f64::from(zeros >> i & 1)));
            let flat = whole * DMat4::from_scale(scale);
            let found = unflattened(flat);
            assert!((DMat3::from_mat4(found).determinant() - 1.0).abs() < 1e-12, "{zeros}");
            for axis in 0..3 {
                assert!(scale[axis] == 0.0 || found.col(axis) == flat.col(axis), "{zeros}");
            }
        }
    }

    #[test]
    fn frames_are_orthonormal_however_near_the_axes_are() {
        let forward = DVec3::new(1.0, 2.0, 3.0).normalize();
        for tilt in [1.0, 1e-5, 1e-11] {
            let right = right_of(forward, (forward + DVec3::X * tilt) * 1e-200).unwrap();
            assert!(
                (right.length() - 1.0).abs() < 1e-15 && right.dot(forward).abs() < 1e-15,
                "{tilt}: {right}"
            );
        }
        for along in [forward, -forward * 1e-300, DVec3::ZERO] {
            assert_eq!(right_of(forward, along), None);
        }
    }
}
