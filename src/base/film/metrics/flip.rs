//! FLIP: the difference that a viewer perceives when flipping between two images.
//!
//! Paper: Andersson et al., *FLIP: A Difference Evaluator for Alternating Images*, HPG 2020. The crate `nv-flip`
//! contains the authors' code.
//! Deviations: the crate takes 8-bit images, so display values are quantised first.

use super::super::{Image, tone};
use nv_flip::{FlipImageRgb8, flip};

/// Viewing distance in pixels per degree of visual angle: the authors' default (0.7 m from a 0.7 m wide 4K screen).
pub const PIXELS_PER_DEGREE: f32 = nv_flip::DEFAULT_PIXELS_PER_DEGREE;

/// Returns FLIP of each pixel, 0 to 1, of the displayed images (radiance times `exposure_factor`, clipped, sRGB).
///
/// The images must have one size.
pub fn flip_map(test: &Image, reference: &Image, exposure_factor: f32) -> Vec<f32> {
    if reference.pixels.is_empty() {
        return Vec::new();
    }
    let shown = |image: &Image| {
        let bytes = tone::to_srgb8(image, exposure_factor);
        FlipImageRgb8::with_data(image.width, image.height, &bytes)
    };
    flip(shown(reference), shown(test), PIXELS_PER_DEGREE).to_vec()
}

/// Returns the magma colour map of FLIP's authors, from 0 (black) to 1 (pale yellow): 256 sRGB colours.
pub fn magma() -> Vec<[u8; 3]> {
    nv_flip::magma_lut().to_vec().chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}
