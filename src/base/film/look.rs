//! Looks: exposure and curve of images for display.

use super::tone::{Exposure, Shown, auto_factor};
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
    pub fn look<'a>(self, image: impl Into<Shown<'a>>) -> Look {
        let automatic = auto_factor(image);
        let own = matches!(self.exposure, Exposure::Ev(_)).then(|| automatic.log2());
        Look { factor: self.exposure.factor(|| automatic), curve: self.curve, automatic: own }
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
    /// Automatic exposure in stops, if another is used and the image is known.
    pub automatic: Option<f32>,
}

impl Look {
    /// Returns the exposure in stops.
    pub fn stops(self) -> f32 {
        self.factor.log2()
    }

    /// Returns the words for the exposure, with automatic exposure for comparison.
    pub fn said(self) -> String {
        let automatic = self.automatic.map_or(String::new(), |stops| format!(" (auto is {stops:+.2})"));
        format!("exposure {:+.2} EV{automatic}", self.stops())
    }

    /// Converts the image to 8-bit display values, row-major: three bytes per pixel, or four if the background is
    /// transparent. Colours of transparent pixels are not premultiplied.
    pub fn to_bytes<'a>(self, image: impl Into<Shown<'a>>) -> Vec<u8> {
        let image = image.into();
        let quantise = |value: f32| (value * 255.0 + 0.5) as u8;
        let mut bytes = Vec::with_capacity(4 * image.color.pixels.len());
        for (color, alpha) in image.colors() {
            let alpha = quantise(alpha);
            let color = if alpha > 0 { color } else { Rgb::ZERO };
            bytes.extend(self.curve.display(color * self.factor).to_array().map(quantise));
            bytes.extend(image.alpha.map(|_| alpha));
        }
        bytes
    }
}
