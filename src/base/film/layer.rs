//! Layers: further images of an image file. The type of a layer names its channels.
//!
//! | type | channels of layer `name` |
//! |---|---|
//! | colour | `name.R`, `name.G`, `name.B` |
//! | vector | `name.X`, `name.Y`, `name.Z` |
//! | scalar | `name` |
//! | id | `name`, unsigned integers |
//! | ranks | `name.R`, `name.G`, `name.B`, `name.A`: twice an id and its coverage, as in Cryptomatte |

use super::Image;
use crate::math::Rgb;

/// Layer of the share of each pixel that surfaces cover.
pub const ALPHA: &str = "A";
/// Fact about an image that says whether the camera sees the background.
pub const BACKGROUND: &str = "background";
/// Value of [`BACKGROUND`] if the background is hidden from the camera.
pub const NO_BACKGROUND: &str = "none";
/// Layer of the number of samples per pixel, if it varies.
pub const SAMPLES: &str = "samples";

/// Start of the names of layers of Cryptomatte, whose numbers are ids and must not be averaged or rounded.
pub const CRYPTO: &str = "Crypto";

/// A further image of an image file.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name in the file.
    pub name: String,
    /// Value of each pixel.
    pub pixels: Pixels,
    /// Display as an image of its own, if there is one.
    pub preview: Option<Preview>,
}

/// Values of a layer by their type.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Radiances, albedos, or triples of related numbers.
    Color(Image),
    /// Vectors and points in world space.
    Vector(Image),
    /// Numbers.
    Scalar(Image<f32>),
    /// Ids of objects; never averaged. 0 stands for no object.
    Id(Image<u32>),
    /// Two ranks of ids as 32-bit floats, each with the share of the pixel that it covers.
    Ranks(Image<[f32; 4]>),
}

/// Display of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preview {
    /// Radiance, with the exposure of the image.
    Exposed,
    /// Points over the darkened image: red if the first channel is above 0, green if the second is.
    Marks,
    /// Hues of directions, in the plane of the two axes of greatest variation.
    Hues,
    /// Magma colours of the channels' weighted sum minus an offset.
    Magma {
        /// Weights of the channels.
        weights: Rgb,
        /// Offset subtracted from the sum.
        offset: f32,
    },
}

impl Layer {
    /// Creates a layer of colours.
    pub fn color(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Color(image), preview: None }
    }

    /// Creates a layer of vectors.
    pub fn vector(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Vector(image), preview: None }
    }

    /// Creates a layer of numbers.
    pub fn scalar(name: impl Into<String>, image: Image<f32>) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Scalar(image), preview: None }
    }

    /// Creates a layer of ids.
    pub fn id(name: impl Into<String>, image: Image<u32>) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Id(image), preview: None }
    }

    /// Returns the layer with a display of its own.
    pub fn shown(self, preview: Preview) -> Layer {
        Layer { preview: Some(preview), ..self }
    }

    /// Returns the values of layers with three channels.
    pub fn triples(&self) -> Option<&Image> {
        match &self.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => Some(image),
            Pixels::Scalar(_) | Pixels::Id(_) | Pixels::Ranks(_) => None,
        }
    }

    /// Returns width and height, and the number of pixels.
    pub(super) fn size(&self) -> ([u32; 2], usize) {
        match &self.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => image.size(),
            Pixels::Scalar(image) => image.size(),
            Pixels::Id(image) => image.size(),
            Pixels::Ranks(image) => image.size(),
        }
    }

    /// Replaces every non-finite channel by 0; returns their number.
    pub(super) fn remove_nonfinite(&mut self) -> u64 {
        match &mut self.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => image.remove_nonfinite(),
            Pixels::Scalar(image) => super::remove_nonfinite(image.pixels.iter_mut()),
            Pixels::Id(_) | Pixels::Ranks(_) => 0,
        }
    }
}
