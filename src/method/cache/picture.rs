//! The picture in the making, and if wanted its parts by the light's origin.

use super::inspect::Layers;
use crate::eye::EyePass;
use crate::film::Image;
use crate::math::Rgb;
use crate::vpl::Origin;

/// Sums at each pixel.
pub struct Picture {
    /// All light.
    pub color: Image,
    /// Direct, indirect, and what is not known apart.
    parts: Option<[Image; 3]>,
    /// Radiances that were not finite and left out.
    pub nonfinite: u64,
}

impl Picture {
    /// Only the emitters in view so far.
    pub fn new(samples: &EyePass, with_parts: bool) -> Picture {
        let color = samples.emitted.clone();
        let blank = || Image::new(color.width, color.height);
        let parts = with_parts.then(|| [blank(), blank(), blank()]);
        Picture { color, parts, nonfinite: samples.nonfinite }
    }

    /// Adds radiance that an eye sample reflects, of one origin or of both.
    pub fn add(&mut self, samples: &EyePass, sample: usize, origin: Option<Origin>, radiance: Rgb) {
        if !radiance.is_finite() {
            self.nonfinite += 1;
            return;
        }
        for seen in samples.visibility.of(sample) {
            let light = seen.weight * radiance;
            self.color.pixels[seen.pixel as usize] += light;
            if let Some(parts) = &mut self.parts {
                let part = match origin {
                    Some(Origin::Direct) => 0,
                    Some(Origin::Indirect) => 1,
                    None => 2,
                };
                parts[part].pixels[seen.pixel as usize] += light;
            }
        }
    }

    /// The picture, its parts by name, and how many radiances were left out.
    pub fn finish(self) -> (Image, Layers, u64) {
        let names = ["direct", "indirect", "both"].map(str::to_owned);
        let parts = self.parts.map_or(Vec::new(), |parts| names.into_iter().zip(parts).collect());
        (self.color, parts, self.nonfinite)
    }
}
