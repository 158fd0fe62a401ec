//! Unit directions of vectors of any length.

use glam::DVec3;

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

#[cfg(test)]
mod tests {
    use super::*;

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
