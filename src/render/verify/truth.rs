//! True values of some pixels, and the error of images against them.

use super::interval::Estimate;
use super::measure;
use super::picks::{self, Pick};
use super::trace::{TracedPixels, VerifySettings, trace};
use base::film::Image;
use base::progress::Control;
use base::stats::Stage;
use serde::Serialize;
use world::World;
use world::view::View;

/// Measured error of an image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Verified {
    /// Mean of the image over mean of the truth, minus 1.
    pub relative_bias: Estimate,
    /// Root of the mean over pixels and channels of `(t - r)² / (r² + 0.01 m²)`, with truth r of mean m.
    ///
    /// This is the root of [`base::film::metrics::rel_mse`].
    pub relative_rms: Estimate,
    /// Root of that quotient per pixel: the value not exceeded by 95 % of the pixels.
    pub relative_error_95: Estimate,
    /// True if errors dominate the 95th percentile.
    ///
    /// If the noise of the paths does, its interval reaches from 0 to the percentile with all noise counted as error.
    pub error_95_resolved: bool,
    /// Root of the mean relative variance of the path-traced pixels. It is subtracted from the errors above.
    pub noise: f64,
    /// Number of pixels traced.
    pub pixels: usize,
    /// Number of pixels that would need more paths than allowed for a standard error of 1 %.
    pub pixels_at_cap: usize,
    /// Number of paths traced.
    pub paths: u64,
    /// Number of radiances along them that were not finite and count as 0.
    pub nonfinite: u64,
}

/// True values of some pixels of a window.
pub struct Truth {
    picks: Vec<Pick>,
    traced: TracedPixels,
    seed: u32,
}

impl Truth {
    /// Traces pixels of a view, preferably those of high contrast in `image`; `None` if cancelled.
    pub fn trace(
        world: &World,
        view: &View,
        image: &Image,
        settings: &VerifySettings,
        control: &Control,
    ) -> Option<Truth> {
        let picks = picks::choose(image, settings.pixels, settings.seed);
        control.begin(Stage::Verify, 2 * picks.len() as u64);
        let traced = trace(world, view, image, &picks, settings, control)?;
        Some(Truth { picks, traced, seed: settings.seed })
    }

    /// Measures the error of `image`, an image of the same window.
    pub fn judge(&self, image: &Image) -> Verified {
        let traced = &self.traced;
        let mut pixels = traced.pixels.clone();
        for (pixel, pick) in pixels.iter_mut().zip(&self.picks) {
            pixel.value = image.pixels[pick.index].as_dvec3();
        }
        let sum: f64 = image.pixels.iter().map(|p| p.as_dvec3().element_sum() / 3.0).sum();
        let mean = sum / image.pixels.len().max(1) as f64;
        let errors = measure::errors(&pixels, mean, self.seed);
        Verified {
            relative_bias: errors.bias,
            relative_rms: errors.rms,
            relative_error_95: errors.percentile_95,
            error_95_resolved: errors.percentile_resolved,
            noise: errors.noise,
            pixels: self.picks.len(),
            pixels_at_cap: traced.at_cap,
            paths: traced.paths,
            nonfinite: traced.nonfinite,
        }
    }
}

/// Measures the error of `image`, an image of `view`; `None` if cancelled.
pub fn verify(
    world: &World,
    view: &View,
    image: &Image,
    settings: &VerifySettings,
    control: &Control,
) -> Option<Verified> {
    Some(Truth::trace(world, view, image, settings, control)?.judge(image))
}
