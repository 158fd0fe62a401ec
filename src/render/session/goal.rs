//! The goal of a frame.

use crate::denoise::Quality;
use crate::method::Method;
use crate::verify::VerifySettings;
use base::stats::Stopwatch;
use transport::eye::{Averaging, Features};

/// A method, the goal that its settings are planned for, and what happens to the image afterwards.
#[derive(Clone, Debug, Default)]
pub struct Goal {
    /// The method and its settings, from which plans start.
    pub method: Method,
    /// True if a pilot may choose another method.
    pub may_choose: bool,
    /// Goal that settings are planned for.
    pub plan: PlanGoal,
    /// Features of the visible surfaces that are wanted as layers.
    pub features: Features,
    /// Samples that these layers describe.
    pub averaging: Averaging,
    /// True if the image is to be denoised. By default, images of methods that leave noise are.
    pub denoise: Option<bool>,
    /// Quality of denoising. By default, it depends on the work on the image.
    pub denoise_quality: Option<Quality>,
    /// True if the image before denoising is kept as layer `noisy`.
    pub keep_noisy: bool,
    /// True if no later image of the session can use the virtual lights and photons. They are dropped before denoising.
    pub is_last: bool,
    /// Settings of the verification of the image's error, if it is wanted.
    pub verify: Option<VerifySettings>,
}

impl Goal {
    /// True if the image is to be denoised.
    pub fn denoises(&self) -> bool {
        self.denoise.unwrap_or(self.method.leaves_noise())
    }

    /// Returns the start of the run whose time is planned, if one is.
    pub fn run(&self) -> Option<&Stopwatch> {
        match &self.plan {
            PlanGoal::Time(time) => Some(&time.run),
            PlanGoal::AsSet | PlanGoal::Error(_) => None,
        }
    }
}

/// Source of settings.
#[derive(Clone, Debug, Default)]
pub enum PlanGoal {
    /// The settings of the method as they are.
    #[default]
    AsSet,
    /// A plan for a complete run of a given time.
    Time(TimeGoal),
    /// A search for a measured error.
    Error(ErrorLimit),
}

/// Time of a run.
#[derive(Clone, Debug)]
pub struct TimeGoal {
    /// Seconds from the start of the run to written files.
    pub seconds: f64,
    /// Start of the run.
    pub run: Stopwatch,
    /// Keys of settings that the plan does not change.
    pub pinned: Vec<&'static str>,
}

/// Maximum error of an image.
#[derive(Clone, Debug)]
pub struct ErrorLimit {
    /// Relative RMS error.
    pub error: f64,
    /// Maximum number of paths at a pixel whose error is measured.
    pub max_samples: u32,
    /// Keys of settings that the search does not change.
    pub pinned: Vec<&'static str>,
}
