//! What a frame is rendered for.

use crate::method::Method;
use crate::stats::Stopwatch;
use crate::verify;

/// A method, what its settings are planned for, and how the picture's error is measured.
#[derive(Clone, Debug, Default)]
pub struct Goal {
    /// The method and its settings, from which plans start.
    pub method: Method,
    /// What settings are planned for.
    pub wanted: Wanted,
    /// How the error of the picture is measured, if it is.
    pub verify: Option<verify::Settings>,
}

/// Where settings come from.
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
        /// Most paths at a pixel whose error is measured.
        max_samples: u32,
        /// Keys of settings that the search leaves alone.
        held: Vec<&'static str>,
    },
}
