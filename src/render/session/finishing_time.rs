//! Time of the stages after the method, measured on a smaller image.

use super::finish::{Finish, guides};
use crate::calibration::PRICES;
use crate::denoise::effort;
use crate::method::Method;
use crate::plan::smaller;
use base::stats::Stopwatch;
use world::view::View;

/// Divisor of each side of the image that is tried.
const TRIAL_SCALE: u32 = 4;
/// Maximum samples per pixel of the image that is tried.
const TRIAL_SPP: u32 = 4;

/// Time of the stages after the method.
#[derive(Clone, Copy, Debug, Default)]
pub struct FinishingTime {
    /// Seconds of denoising.
    pub denoising: f64,
    /// Seconds per eye sample whose surfaces are found again.
    pub sample: f64,
}

impl FinishingTime {
    /// Predicts the time for an image of `method` that is rendered in `within` seconds.
    pub fn of(finish: &Finish, view: &View, method: &Method, within: f64) -> FinishingTime {
        let Some(denoiser) = finish.denoiser() else { return FinishingTime::default() };
        let small = smaller(view, TRIAL_SCALE);
        let spp = method.spp().min(TRIAL_SPP);
        let watch = Stopwatch::start();
        let layers = finish.features(&small, method, spp);
        let finds_guides = !finish.keeps_features() && method.finds_guides();
        let looking = if finds_guides { 0.0 } else { watch.elapsed().wall_seconds };
        let mut denoising = 0.0;
        let guides = guides(&layers);
        let Some(color) = guides.albedo else { return FinishingTime::default() };
        let quality = finish.fixed_quality();
        // The first image of a device takes longer, whatever its size.
        for _ in 0..2 {
            let watch = Stopwatch::start();
            // An error of the library is reported when the image itself is denoised.
            let _ = denoiser.denoise(color, &guides, quality.unwrap_or_default());
            denoising = watch.elapsed().wall_seconds;
        }
        let [all, part] = [view, &small].map(|view| view.window.pixel_count() as f64);
        let sample = looking / (part * f64::from(spp));
        denoising *= all / part;
        if quality.is_none() {
            let looking = sample * all * f64::from(method.spp());
            let likely = effort::for_work(within - looking - denoising, denoising, method.sampled());
            denoising *= PRICES.denoising(likely);
        }
        FinishingTime { denoising, sample }
    }
}
