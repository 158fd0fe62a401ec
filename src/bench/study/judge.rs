//! Errors of an image against another image, or against the truth that a reference estimates.

use super::StudyError;
use super::reference::{Reference, mean};
use base::film::Image;
use base::film::metrics::{Variances, compare};
use glam::DVec3;
use serde::Serialize;

/// Share of the pixels, those with the largest error, that is left out, as in `compare`.
const WORST: f64 = 0.001;

/// Error measures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// PSNR of the displayed images, dB; `None` for identical images. Against a reference, its noise is subtracted;
    /// `None` if nothing remains.
    pub psnr: Option<f64>,
    /// Relative mean square error without the worst pixel of a thousand. Where paths rarely find an emitter, a few
    /// wrong pixels of the reference outweigh all others. Against a reference, its noise is subtracted, so that the
    /// value may be slightly negative.
    pub rel_mse: f64,
    /// Mean FLIP of the displayed images.
    pub flip: f64,
    /// Mean radiance over that of the other image. Shows the energy lost by clamping.
    pub brightness: f64,
}

impl Errors {
    /// Placeholder of images without a reference.
    pub const UNKNOWN: Errors =
        Errors { psnr: None, rel_mse: f64::NAN, flip: f64::NAN, brightness: f64::NAN };

    /// Returns the errors against another image.
    pub fn between(test: &Image, other: &Image) -> Result<Errors, StudyError> {
        let found = compare(test, other, Variances::default());
        let found = found.map_err(|error| StudyError::Input(error.to_string()))?;
        let brightness = mean(test) / mean(other).max(f64::MIN_POSITIVE);
        Ok(Errors { psnr: found.psnr, rel_mse: found.rel_mse_trimmed, flip: found.flip, brightness })
    }

    /// Returns the errors against the truth that a reference estimates. FLIP includes the reference's noise.
    pub fn against(test: &Image, reference: &Reference) -> Result<Errors, StudyError> {
        let errors = Errors::between(test, &reference.mean)?;
        let floor = 0.01 * mean(&reference.mean).powi(2);
        let [a, b] = &reference.halves;
        let pixels = test.pixels.iter().zip(&reference.mean.pixels).zip(a.pixels.iter().zip(&b.pixels));
        let mut errors_of_pixels: Vec<f64> = pixels
            .map(|((t, r), (a, b))| {
                let [t, r, a, b] = [t, r, a, b].map(|p| p.as_dvec3());
                let scale = r * r + DVec3::splat(floor.max(f64::MIN_POSITIVE));
                ((t - a) * (t - b) / scale).element_sum() / 3.0
            })
            .collect();
        errors_of_pixels.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let counted = ((1.0 - WORST) * errors_of_pixels.len() as f64) as usize;
        let sum: f64 = errors_of_pixels[..counted].iter().sum();
        let psnr = without_noise(errors.psnr, reference.noise.psnr);
        Ok(Errors { psnr, rel_mse: sum / counted.max(1) as f64, ..errors })
    }

    /// Returns the root mean square error of the displayed image; 0 without a PSNR.
    pub fn displayed_rmse(&self) -> f64 {
        self.psnr.map_or(0.0, rmse_of_psnr)
    }

    /// Returns the root of the relative mean square error; 0 if that is negative.
    pub fn rel_rmse(&self) -> f64 {
        self.rel_mse.max(0.0).sqrt()
    }
}

/// Returns the root mean square error for a PSNR, relative to the peak.
pub fn rmse_of_psnr(psnr: f64) -> f64 {
    10f64.powf(-0.05 * psnr)
}

/// Returns the PSNR against the truth, from the PSNR against a reference and the reference's own.
fn without_noise(psnr: Option<f64>, noise: Option<f64>) -> Option<f64> {
    let square = |psnr: Option<f64>| psnr.map_or(0.0, |psnr| rmse_of_psnr(psnr).powi(2));
    let mse = square(psnr) - square(noise);
    (mse > 0.0).then(|| -10.0 * mse.log10())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::reference::Reference;
    use base::film::metrics::psnr;
    use base::math::Rgb;
    use base::sampling::hash;

    #[test]
    fn noise_of_the_reference_and_emitters_that_its_paths_missed_do_not_count() {
        let noisy = |seed: u32| {
            let mut image = Image::new(128, 128);
            for (i, p) in image.pixels.iter_mut().enumerate() {
                let uniform = hash(i as u32, seed) as f32 / u32::MAX as f32;
                *p = Rgb::splat(0.95 + 0.1 * uniform);
            }
            image
        };
        let reference = Reference::of_halves([noisy(1), noisy(2)], 2, 1.0);
        let mut test = Image::new(128, 128);
        test.pixels.iter_mut().for_each(|p| *p = Rgb::splat(1.1));
        (0..15).for_each(|i| test.pixels[i * 271] = Rgb::splat(300.0));
        let errors = Errors::against(&test, &reference).unwrap();
        // The square of 0.1; leaving out the worst pixels takes a hundredth; with the reference's noise it
        // would be .0103.
        assert!((0.0097..0.0101).contains(&errors.rel_mse), "{errors:?}");
        // With its noise, PSNR would be lower by .17 dB.
        let mut truth = Image::new(128, 128);
        truth.pixels.fill(Rgb::splat(1.0));
        let expected = psnr(&test, &truth, reference.exposure).unwrap();
        assert!((errors.psnr.unwrap() - expected).abs() < 0.05, "{errors:?} {expected}");
    }
}
