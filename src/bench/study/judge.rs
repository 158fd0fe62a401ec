//! How far a picture is from another, or from the truth behind a reference.

use super::{Reference, StudyError};
use crate::image::Image;
use crate::image::metrics::{Variances, compare};
use glam::DVec3;
use serde::Serialize;

/// Error measures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// PSNR of the displayed pictures, dB; none if they are the same.
    pub psnr: Option<f64>,
    /// Relative mean square error; against a reference, without the reference's noise, for which reason it may be
    /// slightly negative.
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

    /// Against the truth that a reference estimates. PSNR and FLIP are against the reference as it is.
    pub fn against(test: &Image, reference: &Reference) -> Result<Errors, StudyError> {
        let errors = Errors::between(test, &reference.mean)?;
        let floor = 0.01 * mean(&reference.mean).powi(2);
        let [a, b] = &reference.halves;
        let pixels = test.pixels.iter().zip(&reference.mean.pixels).zip(a.pixels.iter().zip(&b.pixels));
        let sum: f64 = pixels
            .map(|((t, r), (a, b))| {
                let [t, r, a, b] = [t, r, a, b].map(|p| p.as_dvec3());
                let scale = r * r + DVec3::splat(floor.max(f64::MIN_POSITIVE));
                ((t - a) * (t - b) / scale).element_sum() / 3.0
            })
            .sum();
        Ok(Errors { rel_mse: sum / test.pixels.len().max(1) as f64, ..errors })
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
