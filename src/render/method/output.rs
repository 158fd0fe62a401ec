//! Results of a method.

use base::film::{Image, Layer};
use base::stats::Stats;

/// The result of rendering one frame. All images have the size of the rendered window.
#[derive(Clone, Debug)]
pub struct Output {
    /// Radiance by pixel.
    pub color: Image,
    /// Variance of the pixel mean in `color`, per channel, where the method can estimate it.
    pub variance: Option<Image>,
    /// Further images.
    pub extra: Vec<Layer>,
    /// Features that were found on the way and are those of all its samples, by which it may be denoised.
    pub guides: Vec<Layer>,
    /// Layers by which the picture can go on where it is interrupted; none where the method cannot.
    pub begun: Vec<Layer>,
    /// Counters and times.
    pub stats: Stats,
    /// False if the method was cancelled: the picture is partial.
    pub complete: bool,
    /// Samples that were not finite and were dropped; anything but 0 is a defect worth reporting.
    pub nonfinite: u64,
}

impl Output {
    /// A complete picture and nothing besides.
    pub fn new(color: Image, stats: Stats) -> Output {
        Output {
            color,
            variance: None,
            extra: Vec::new(),
            guides: Vec::new(),
            begun: Vec::new(),
            stats,
            complete: true,
            nonfinite: 0,
        }
    }
}
