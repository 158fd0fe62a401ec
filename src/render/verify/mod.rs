//! Error of a picture, measured without a reference: some of its pixels are path-traced.
//!
//! | setting | default | meaning |
//! |---|---|---|
//! | `pixels` | - | about how many pixels are traced; all, if the picture has no more |
//! | `estimand` | that of the method | a pixel's meaning: mean over its square, or over the picture's own eye samples |
//! | `seed` | 0 | another seed, other pixels and paths |
//! | `max_depth` | the scene's | longest path in edges |
//! | `most_samples` | 4096 | most paths a pixel |
//!
//! A short pilot estimates the number of paths that each pixel takes until its standard error is 1 % of its
//! radiance; they are then traced anew, so that the stopping rule does not bias them. The error is reported
//! with a 95 % confidence interval, which covers the random choice of pixels and the noise of their paths.
//!
//! Pictures that differ in how they were computed, but not in the meaning of a pixel, can be compared with
//! one [`Truth`]. Pictures that were selected for their small error against it need another, of another seed.
//!
//! The measure is limited by the path tracer: light that it hardly finds (small lights through glass) is
//! missing from the truth or widens the interval.

mod interval;
mod measure;
mod picks;
mod trace;

use crate::method::Method;
use base::film::Image;
use base::progress::Control;
use base::stats::Stage;
use serde::Serialize;
use transport::paths::Estimand;
use world::World;
use world::view::View;

pub use interval::{Estimate, NORMAL_975};
use picks::Pick;
use trace::Traced;

/// Settings of a verification.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Approximate number of pixels.
    pub pixels: usize,
    /// Meaning of a pixel's value.
    pub estimand: Estimand,
    /// Seed of the choice of pixels and of their paths.
    pub seed: u32,
    /// Maximum path length in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
    /// Maximum number of paths a pixel.
    pub most_samples: u32,
}

impl Settings {
    /// The same settings for a picture of `method`, whose own eye samples may differ from those planned with.
    pub fn of(self, method: &Method) -> Settings {
        match self.estimand {
            Estimand::Pixels => self,
            Estimand::EyeSamples { .. } => {
                Settings { estimand: Estimand::EyeSamples { spp: method.spp(), seed: method.seed() }, ..self }
            }
        }
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { pixels: 1000, estimand: Estimand::Pixels, seed: 0, max_depth: None, most_samples: 4096 }
    }
}

/// The error of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Verified {
    /// Mean of the picture over mean of the truth, minus 1.
    pub relative_bias: Estimate,
    /// Root of the mean over pixels and channels of `(t - r)² / (r² + 0.01 m²)`, r the truth and m its mean:
    /// the root of [`base::film::metrics::rel_mse`].
    pub relative_rms: Estimate,
    /// Root of the same, pixel by pixel: the value not exceeded by 95 % of the pixels.
    pub relative_error_95: Estimate,
    /// True if errors dominate that figure; if the noise of the paths does, its interval goes from 0 to the
    /// value that the figure would have if all noise were error.
    pub error_95_resolved: bool,
    /// Root of the mean relative variance of the path-traced pixels. It is subtracted from the figures above.
    pub noise: f64,
    /// Number of pixels traced.
    pub pixels: usize,
    /// Number of pixels that would have needed more paths than allowed for a standard error of 1 %.
    pub pixels_at_cap: usize,
    /// Number of paths traced.
    pub paths: u64,
    /// Number of radiances along them that were not finite and count as 0.
    pub nonfinite: u64,
}

/// True values of some pixels of a window.
pub struct Truth {
    picks: Vec<Pick>,
    traced: Traced,
    seed: u32,
}

impl Truth {
    /// Traces pixels of `window`, preferably those of high contrast in `image`, a picture of it; `None` if
    /// cancelled.
    pub fn trace(
        world: &World,
        view: &View,
        image: &Image,
        settings: &Settings,
        control: &Control,
    ) -> Option<Truth> {
        let picks = picks::choose(image, settings.pixels, settings.seed);
        control.begin(Stage::Verify, 2 * picks.len() as u64);
        let traced = trace::trace(world, view, image, &picks, settings, control)?;
        Some(Truth { picks, traced, seed: settings.seed })
    }

    /// Measures the error of `image`, a picture of the same view.window.
    pub fn judge(&self, image: &Image) -> Verified {
        let traced = &self.traced;
        let mut pixels = traced.pixels.clone();
        for (pixel, pick) in pixels.iter_mut().zip(&self.picks) {
            pixel.held = image.pixels[pick.index].as_dvec3();
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

/// Measures the error of `image`, the picture of `window`; `None` if cancelled.
pub fn verify(
    world: &World,
    view: &View,
    image: &Image,
    settings: &Settings,
    control: &Control,
) -> Option<Verified> {
    Some(Truth::trace(world, view, image, settings, control)?.judge(image))
}
