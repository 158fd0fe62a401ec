//! Bounds of angles over boxes.
//!
//! Paper: Walter et al., *Lightcuts*, 2005, section 4.1: the box is turned into the frame of the axis, where
//! the maximum cosine to the axis is at its highest z and minimum distance from the axis.
//! Deviations: if the whole box lies behind the plane across the axis, the bound of the cosine is negative, not 0. The
//! cone of the emitters' normals makes use of it.

use base::math::Frame;
use glam::Vec3;

/// Relative margin of boxes: more than the rounding of the values computed from them.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// Box of offsets from the receiver, or of unit directions.
#[derive(Clone, Copy, Debug)]
pub struct OffsetBox {
    centre: Vec3,
    half: Vec3,
}

impl OffsetBox {
    /// Creates the box between two corners.
    #[inline]
    pub fn new(min: Vec3, max: Vec3) -> OffsetBox {
        let centre = 0.5 * (min + max);
        let half = 0.5 * (max - min);
        OffsetBox { centre, half: half + ROUNDING * (centre.abs() + half) }
    }

    /// Square of the minimum distance from the origin.
    #[inline]
    pub fn min_dist_sq(&self) -> f32 {
        (self.centre.abs() - self.half).max(Vec3::ZERO).length_squared()
    }

    /// Centre of the box.
    #[inline]
    pub fn centre(&self) -> Vec3 {
        self.centre
    }

    /// Returns the box around this one with the axes of `frame`.
    #[inline]
    pub fn turned(&self, frame: &Frame) -> OffsetBox {
        let extent = |axis: Vec3| axis.abs().dot(self.half);
        let centre = frame.to_local(self.centre);
        let half = Vec3::new(extent(frame.tangent), extent(frame.bitangent), extent(frame.normal));
        OffsetBox { centre, half: half + ROUNDING * self.centre.abs().max_element() }
    }

    /// Returns an upper bound of the cosine between z and any vector in the box; 1 if the origin is inside.
    #[inline]
    pub fn max_cos_z(&self) -> f32 {
        let z = self.centre.z + self.half.z;
        let (x, y) = if z > 0.0 {
            ((self.centre.x.abs() - self.half.x).max(0.0), (self.centre.y.abs() - self.half.y).max(0.0))
        } else {
            (self.centre.x.abs() + self.half.x, self.centre.y.abs() + self.half.y)
        };
        // The smallest positive number avoids 0/0 for an empty box at the origin.
        z / (x * x + y * y + z * z).sqrt().max(f32::MIN_POSITIVE)
    }

    /// Returns a lower bound of the cosine between z and any vector in the box, at least 0.
    #[inline]
    pub fn min_cos_z(&self) -> f32 {
        let z = self.centre.z - self.half.z;
        if z <= 0.0 {
            return 0.0;
        }
        let (x, y) = (self.centre.x.abs() + self.half.x, self.centre.y.abs() + self.half.y);
        z / (x * x + y * y + z * z).sqrt()
    }
}

/// Returns an upper bound of the positive part of the cosine between any normal in a cone and any direction. The cone's
/// axis makes an angle of at least acos(`cos_theta`) with every direction.
#[inline]
pub fn max_cos_to_cone(cos_theta: f32, cos_beta: f32, sin_beta: f32) -> f32 {
    max_cos_to_cone_signed(cos_theta, cos_beta, sin_beta).max(0.0)
}

/// Returns the bound of [`max_cos_to_cone`], which may be negative.
#[inline]
pub fn max_cos_to_cone_signed(cos_theta: f32, cos_beta: f32, sin_beta: f32) -> f32 {
    if cos_theta >= cos_beta {
        return 1.0;
    }
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    // The margin covers the rounding of sin θ where cos θ is near 1.
    (cos_theta * cos_beta + sin_theta * sin_beta + 1e-6).min(1.0)
}
