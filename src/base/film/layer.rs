//! Layers: images beside a picture's colour, each of a type that names its channels.
//!
//! | type | channels of layer `name` |
//! |---|---|
//! | colour | `name.R`, `name.G`, `name.B` |
//! | vector | `name.X`, `name.Y`, `name.Z` |
//! | scalar | `name` |
//! | id | `name`, unsigned integers |

use super::Image;
use crate::math::Rgb;

/// Layer of the samples of each pixel, where they differ.
pub const SAMPLES: &str = "samples";

/// An image beside the colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name in the file.
    pub name: String,
    /// Values by pixel.
    pub pixels: Pixels,
    /// Display as a picture of its own, if the layer is meant to have one.
    pub preview: Option<Preview>,
}

/// Values of a layer by their type.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Radiances, albedos, or up to three numbers that belong together.
    Color(Image),
    /// Vectors and points in world space.
    Vector(Image),
    /// Numbers.
    Scalar(Image<f32>),
    /// Names of things: never averaged, 0 for nothing.
    Id(Image<u32>),
}

/// Display of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preview {
    /// As radiance, exposed as the picture is.
    Exposed,
    /// Points over the darkened picture: red where the first, green where the second channel is above 0.
    Marks,
    /// Directions in the plane of the two axes along which they vary most, as hues.
    Hues,
    /// Numbers in magma colours: the channels' weighted sum, less an offset.
    Magma {
        /// Weights of the channels.
        weights: Rgb,
        /// Offset taken off the sum.
        offset: f32,
    },
}

impl Layer {
    /// A layer of colours.
    pub fn color(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Color(image), preview: None }
    }

    /// A layer of vectors.
    pub fn vector(name: impl Into<String>, image: Image) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Vector(image), preview: None }
    }

    /// A layer of numbers.
    pub fn scalar(name: impl Into<String>, image: Image<f32>) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Scalar(image), preview: None }
    }

    /// A layer of ids.
    pub fn id(name: impl Into<String>, image: Image<u32>) -> Layer {
        Layer { name: name.into(), pixels: Pixels::Id(image), preview: None }
    }

    /// The same layer, shown as a picture of its own.
    pub fn shown(self, preview: Preview) -> Layer {
        Layer { preview: Some(preview), ..self }
    }

    /// Values of three channels by pixel, where the layer has as many.
    pub fn triples(&self) -> Option<&Image> {
        match &self.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => Some(image),
            Pixels::Scalar(_) | Pixels::Id(_) => None,
        }
    }

    /// Width and height, and the number of pixels held.
    pub(super) fn size(&self) -> ([u32; 2], usize) {
        match &self.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => image.size(),
            Pixels::Scalar(image) => image.size(),
            Pixels::Id(image) => image.size(),
        }
    }

    /// Replaces every channel that is not finite by 0 and returns their number.
    pub(super) fn remove_nonfinite(&mut self) -> u64 {
        match &mut self.pixels {
            Pixels::Color(image) | Pixels::Vector(image) => image.remove_nonfinite(),
            Pixels::Scalar(image) => super::remove_nonfinite(image.pixels.iter_mut()),
            Pixels::Id(_) => 0,
        }
    }
}
