//! A picture that was interrupted: the samples that its pixels have, from which it goes on to the bits of one that was
//! not.

use base::film::{ExrFile, Image, Layer, SAMPLES};

/// Layer of the sums of squared differences from the means.
const SQUARES: &str = "squares";

/// The samples that an interrupted picture has.
#[derive(Clone, Debug)]
pub struct Begun {
    /// Mean radiance by pixel.
    pub color: Image,
    /// Sum of squared differences from it.
    pub squares: Image,
    /// Number of samples.
    pub samples: Image<u32>,
    /// Samples that were not finite and count as 0.
    pub nonfinite: u64,
    /// Seconds that rendering took.
    pub seconds: f64,
}

impl Begun {
    /// The samples that a file has of a picture; `None` if it is none that can go on.
    pub fn of(file: &ExrFile) -> Option<Begun> {
        let facts = file.metadata();
        let number = |key| facts.number(key).unwrap_or_default();
        Some(Begun {
            color: file.color().ok()?,
            squares: file.layer(SQUARES).ok()?,
            samples: file.numbers(SAMPLES)?,
            nonfinite: number("nonfinite") as u64,
            seconds: number("render_seconds"),
        })
    }

    /// Takes the sums of squares out of a file.
    pub fn remove_squares(file: &mut ExrFile) {
        file.remove_layer(SQUARES);
    }

    /// The layers of an interrupted picture from which it goes on, besides its colour.
    pub fn layers(squares: Image, samples: Image<u32>) -> Vec<Layer> {
        vec![Layer::color(SQUARES, squares), Layer::id(SAMPLES, samples)]
    }
}
