//! The goal of a frame.

use crate::denoise::Quality;
use crate::method::Method;
use crate::verify;
use base::stats::Stopwatch;
use transport::eye::Features;

/// A method, the goal that its settings are planned for, and the verification of the picture's error.
#[derive(Clone, Debug, Default)]
pub struct Goal {
    /// The method and its settings, from which plans start.
    pub method: Method,
    /// True if another method may be taken in its place, where a pilot finds it better.
    pub may_choose: bool,
    /// Goal that settings are planned for.
    pub wanted: Wanted,
    /// Features of the surfaces seen that are wanted beside the colour.
    pub features: Features,
    /// True if the picture is to be denoised; by default, if the method's pictures are meant to be.
    pub denoise: Option<bool>,
    /// Quality of denoising; by default, one that goes with the work on the picture.
    pub denoise_quality: Option<Quality>,
    /// True if the picture before denoising is kept as layer `noisy`.
    pub keep_noisy: bool,
    /// Settings of the verification of the picture's error, if any.
    pub verify: Option<verify::Settings>,
}

impl Goal {
    /// True if the picture is to be denoised.
    pub fn denoises(&self) -> bool {
        self.denoise.unwrap_or(self.method.leaves_noise())
    }
}

/// Source of settings.
#[derive(Clone, Debug, Default)]
pub enum Wanted {
    /// From the method as it is.
    #[default]
    AsSet,
    /// From a plan for a whole run of a given time.
    Time {
        /// Seconds from the start of the run to written files.
        seconds: f64,
        /// Start of the run.
        run: Stopwatch,
        /// Keys of settings that the plan leaves alone.
        held: Vec<&'static str>,
    },
    /// From a search for a measured error.
    Error {
        /// Relative RMS error.
        error: f64,
        /// Maximum number of paths at a pixel whose error is measured.
        max_samples: u32,
        /// Keys of settings that the search leaves alone.
        held: Vec<&'static str>,
    },
}
