//! An interrupted image, from which the method resumes to the bits of an image that was not interrupted.

use base::film::{ExrFile, Image, Layer, SAMPLES};

/// Layer of the sums of squared differences from the means.
const SQUARES: &str = "squares";

/// Samples of an interrupted image.
#[derive(Clone, Debug)]
pub struct PartialImage {
    /// Mean radiance per pixel.
    pub color: Image,
    /// Sum of squared differences from the mean, per pixel.
    pub squares: Image,
    /// Number of samples per pixel.
    pub samples: Image<u32>,
    /// Samples that were not finite and count as 0.
    pub nonfinite: u64,
    /// Seconds that rendering took.
    pub seconds: f64,
}

impl PartialImage {
    /// Reads the samples of an image file; `None` if the file cannot be resumed.
    pub fn of(file: &ExrFile) -> Option<PartialImage> {
        let facts = file.metadata();
        let number = |key| facts.number(key).unwrap_or_default();
        Some(PartialImage {
            color: file.color().ok()?,
            squares: file.layer(SQUARES).ok()?,
            samples: file.numbers(SAMPLES)?,
            nonfinite: number("nonfinite") as u64,
            seconds: number("render_seconds"),
        })
    }

    /// Removes the sums of squares from a file.
    pub fn remove_squares(file: &mut ExrFile) {
        file.remove_layer(SQUARES);
    }

    /// Returns the layers from which an interrupted image is resumed, besides its colour.
    pub fn layers(squares: Image, samples: Image<u32>) -> Vec<Layer> {
        vec![Layer::color(SQUARES, squares), Layer::id(SAMPLES, samples)]
    }
}
