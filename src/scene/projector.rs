//! Projectors: images projected from a point, and their field of view.

use super::texture::TextureId;
use base::math::Rgb;
use glam::Mat3;

/// Axis of an image to which a field of view refers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// Width.
    X,
    /// Height.
    Y,
    /// Diagonal.
    Diagonal,
    /// The shorter edge.
    Smaller,
    /// The longer edge.
    Larger,
}

impl FovAxis {
    /// Returns the tangent of half the horizontal field of view. `tan_half` is the tangent of half the field of view
    /// along this axis, and `aspect` is width over height.
    pub fn tan_half_x(self, tan_half: f64, aspect: f64) -> f64 {
        match self {
            FovAxis::X => tan_half,
            FovAxis::Y => tan_half * aspect,
            FovAxis::Diagonal => tan_half / (1.0 + 1.0 / (aspect * aspect)).sqrt(),
            FovAxis::Smaller => tan_half * aspect.max(1.0),
            FovAxis::Larger => tan_half * aspect.min(1.0),
        }
    }
}

/// Image projected from a point, as by Mitsuba's plugin `projector`. An image of 1 gives a plane across the axis even
/// light: the intensity grows with 1 / cos³ from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projector {
    /// Radiant intensity on the axis for an image of 1, W/sr.
    pub intensity: Rgb,
    /// The image; `None` for a square of 1.
    pub texture: Option<TextureId>,
    /// Rotation of world directions to the projector's frame: z along the axis, x to the right of the image, y down.
    pub to_local: Mat3,
    /// Tangent of half the field of view along `axis`.
    pub tan_half: f32,
    /// Axis of the field of view.
    pub axis: FovAxis,
}

impl Projector {
    /// Returns the tangent of half the horizontal field of view, for an image of `aspect` (width over height).
    pub fn tan_half_x(&self, aspect: f32) -> f32 {
        self.axis.tan_half_x(self.tan_half.into(), aspect.into()) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_of_view_is_that_along_its_axis() {
        let tan_x = |axis: FovAxis, aspect| axis.tan_half_x(1.0, aspect);
        for (axis, wide, tall) in [
            (FovAxis::X, 1.0, 1.0),
            (FovAxis::Y, 2.0, 0.5),
            (FovAxis::Smaller, 2.0, 1.0),
            (FovAxis::Larger, 1.0, 0.5),
            (FovAxis::Diagonal, 2.0 / 5f64.sqrt(), 1.0 / 5f64.sqrt()),
        ] {
            assert!(
                (tan_x(axis, 2.0) - wide).abs() < 1e-12 && (tan_x(axis, 0.5) - tall).abs() < 1e-12,
                "{axis:?}"
            );
        }
    }
}
