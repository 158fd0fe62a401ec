//! Results of a method.

use super::tally::Tally;
use crate::cost::Work;
use crate::denoise::{DenoiseError, Quality};
use base::film::{Image, Layer};
use base::stats::Stats;

/// Result of rendering one frame. All images have the size of the rendered window.
#[derive(Clone, Debug)]
pub struct Output {
    /// Radiance per pixel.
    pub color: Image,
    /// Variance of the pixel mean in `color`, per channel, if the method can estimate it.
    pub variance: Option<Image>,
    /// Further images.
    pub extra: Vec<Layer>,
    /// Features of the surfaces seen by all samples, to guide a denoiser; empty if the method finds none.
    pub guides: Vec<Layer>,
    /// Layers from which a partial image can be resumed; empty if the method cannot resume.
    pub resumable: Vec<Layer>,
    /// Counters and times, for reports.
    pub stats: Stats,
    /// Work that the image took, on which later stages depend.
    pub work: Work,
    /// Quality of denoising, or the reason why it failed; `None` if the image was not denoised.
    pub denoised: Option<Result<Quality, DenoiseError>>,
    /// False if the method was cancelled: the image is partial.
    pub complete: bool,
    /// Samples that were not finite and were dropped. Anything but 0 is a defect that should be reported.
    pub nonfinite: u64,
}

impl Output {
    /// Creates a complete image without further layers.
    pub(super) fn new(color: Image, tally: Tally) -> Output {
        Output {
            color,
            variance: None,
            extra: Vec::new(),
            guides: Vec::new(),
            resumable: Vec::new(),
            stats: tally.stats,
            work: tally.work,
            denoised: None,
            complete: true,
            nonfinite: 0,
        }
    }
}
