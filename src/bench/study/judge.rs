//! How far a picture is from another, or from the truth behind a reference.

use super::{Reference, StudyError};
use crate::image::Image;
use crate::image::metrics::{Variances, compare};
use glam::DVec3;
use serde::Serialize;

/// Share of the pixels in which a reference is trusted: all but the noisiest.
const KNOWN: f64 = 0.995;

/// Error measures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// PSNR of the displayed pictures, dB; none if they are the same.
    pub psnr: Option<f64>,
    /// Relative mean square error; against a reference, without the reference's noise, for which reason it may be
    /// slightly negative, and without the pixels where that is largest.
    pub rel_mse: f64,
    /// Mean FLIP of the displayed pictures.
    pub flip: f64,
    /// Mean radiance over that of the other: what clamping takes away shows here.
    pub brightness: f64,
}

impl Errors {
    /// Against another picture.
    pub fn between(test: &Image, other: &Image) -> Result<Errors, StudyError> {
        let found = compare(test, other, Variances::default()).map_err(StudyError::Compare)?;
        let brightness = mean(test) / mean(other).max(f64::MIN_POSITIVE);
        Ok(Errors { psnr: found.psnr, rel_mse: found.rel_mse, flip: found.flip, brightness })
    }

    /// Against the truth that a reference estimates. PSNR and FLIP are against the reference as it is; relMSE leaves
    /// out the pixels of which the reference knows least, the same ones for every picture: a few paths that happened to find a lamp
    /// would outweigh all others.
    pub fn against(test: &Image, reference: &Reference) -> Result<Errors, StudyError> {
        let errors = Errors::between(test, &reference.mean)?;
        let floor = 0.01 * mean(&reference.mean).powi(2);
        let [a, b] = &reference.halves;
        let pixels = test.pixels.iter().zip(&reference.mean.pixels).zip(a.pixels.iter().zip(&b.pixels));
        let mut errors_of_pixels: Vec<[f64; 2]> = pixels
            .map(|((t, r), (a, b))| {
                let [t, r, a, b] = [t, r, a, b].map(|p| p.as_dvec3());
                let scale = r * r + DVec3::splat(floor.max(f64::MIN_POSITIVE));
                let relative = |squares: DVec3| (squares / scale).element_sum() / 3.0;
                [relative((a - b) * (a - b)), relative((t - a) * (t - b))]
            })
            .collect();
        errors_of_pixels.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let known = (KNOWN * errors_of_pixels.len() as f64).ceil() as usize;
        let sum: f64 = errors_of_pixels[..known].iter().map(|[_, error]| error).sum();
        Ok(Errors { rel_mse: sum / known.max(1) as f64, ..errors })
    }

    /// Root of the relative mean square error; 0 where that is negative.
    pub fn rel_rmse(&self) -> f64 {
        self.rel_mse.max(0.0).sqrt()
    }
}

fn mean(image: &Image) -> f64 {
    let sum: f64 = image.pixels.iter().map(|p| p.as_dvec3().element_sum() / 3.0).sum();
    sum / image.pixels.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::study::reference::Reference;
    use crate::math::Rgb;
    use crate::sampling::hash;

    #[test]
    fn noise_of_the_reference_and_its_fireflies_do_not_count() {
        let noisy = |seed: u32| {
            let mut image = Image::new(128, 128);
            for (i, p) in image.pixels.iter_mut().enumerate() {
                let uniform = hash(i as u32, seed) as f32 / u32::MAX as f32;
                *p = Rgb::splat(0.7 + 0.6 * uniform);
            }
            image
        };
        let mut halves = [noisy(1), noisy(2)];
        for i in 0..60 {
            halves[i % 2].pixels[i * 271] = Rgb::splat(300.0);
        }
        let reference = Reference::of_halves(halves, 2, 1.0);
        let mut test = Image::new(128, 128);
        test.pixels.iter_mut().for_each(|p| *p = Rgb::splat(1.1));
        let errors = Errors::against(&test, &reference).unwrap();
        // 0.1 squared over the square of the noisy mean, 1 and a little, with the floor.
        assert!((0.007..0.013).contains(&errors.rel_mse), "{errors:?}");
    }
}
