//! Looks: exposure and curve of images for display.

use super::Image;
use super::tone::Exposure;
use super::tone_curve::ToneCurve;
use crate::math::Rgb;
use std::fmt;

/// Exposure and curve of an image for display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Exposure.
    pub exposure: Exposure,
    /// Curve to display values.
    pub curve: ToneCurve,
}

impl Tone {
    /// Returns the look for this image.
    pub fn look(self, image: &Image) -> Look {
        Look { factor: self.exposure.factor(image), curve: self.curve }
    }
}

impl fmt::Display for Tone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.exposure, self.curve.name())
    }
}

/// Factor on radiance and curve of an image for display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Factor on radiance.
    pub factor: f32,
    /// Curve to display values.
    pub curve: ToneCurve,
}

impl Look {
    /// Returns the exposure in stops.
    pub fn stops(self) -> f32 {
        self.factor.log2()
    }

    /// Converts the image to 8-bit display values, row-major, three bytes per pixel.
    pub fn to_bytes(self, image: &Image) -> Vec<u8> {
        let quantise = |value: f32| (value * 255.0 + 0.5) as u8;
        let shown = |&p: &Rgb| self.curve.display(p * self.factor).to_array().map(quantise);
        image.pixels.iter().flat_map(shown).collect()
    }
}
