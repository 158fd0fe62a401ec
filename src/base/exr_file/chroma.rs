//! Colours from luminance and chroma.

use crate::math::Rgb;

/// Returns the colour of luminance Y and chroma RY = (R - Y) / Y and BY = (B - Y) / Y.
///
/// `weights` are the luminances of the primaries, whose sum is 1. Source: *Technical Introduction to OpenEXR*,
/// "Luminance/Chroma Images".
pub fn from_luma_chroma([y, ry, by]: [f32; 3], weights: Rgb) -> Rgb {
    if ry == 0.0 && by == 0.0 {
        return Rgb::splat(y);
    }
    let (red, blue) = ((1.0 + ry) * y, (1.0 + by) * y);
    Rgb::new(red, (y - red * weights.x - blue * weights.z) / weights.y, blue)
}
