//! Figures of a scene that prices and choices are judged by.

use crate::study::Answer;
use render::plan::MethodChoice;

/// A budget, and the errors of both methods within it.
pub struct Budget {
    /// Settings of the cache that take it.
    pub options: String,
    /// Samples per pixel of these.
    pub spp: f64,
    pub seconds: f64,
    pub cache: Figures,
    /// Interpolated errors.
    pub paths: Figures,
    pub chose_paths: bool,
    /// Variance of a path over that of a sample of the cache, and paths that are expected to replace such a sample.
    pub quotient: f64,
    pub paths_a_sample: f64,
    /// Expected work of the other method over the work of the chosen one.
    pub ahead: f64,
    /// Errors of the choice over the errors of the better method.
    pub cost: Figures,
}

/// Errors that choices are judged by: root mean square error of the displayed image, and FLIP.
pub type Figures = [f64; 2];

/// Answer for a scene.
pub struct SceneAnswer {
    pub answer: Answer,
    /// Processor seconds of denoising a pixel, by quality: fast, balanced, high.
    pub denoising: [Option<f64>; 3],
    pub budgets: Vec<Budget>,
    pub pilot_seconds: f64,
    /// Choice at the default settings.
    pub choice: MethodChoice,
}
