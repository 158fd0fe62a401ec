//! A rendered frame: the image and all that is reported about it.

use crate::denoise::NOISY_VARIANCE;
use crate::method::{Method, Output};
use base::film::metrics::{rel_mse_of_variance, standard_error};
use base::film::{BACKGROUND, Film, Layer, Metadata, NO_BACKGROUND};
use base::stats::Stats;
use scene::Scene;
use serde_json::Value;
use world::view::View;

/// Warning of light that paths miss, with its remedy.
pub(super) const FOCUSED: &str = "path tracing seldom finds sunlight through solid glass, and never finds point and directional \
    lights through it; use --method cache or another method with virtual lights";

/// Warning of a black image, with its remedies.
pub const BLACK: &str = "the image is black: no light reaches the surfaces in view; check the position and direction of \
    the camera, and that lights are inside rooms and face the scene";

/// A rendered frame.
pub struct RenderedFrame {
    /// The image, its layers and metadata.
    pub film: Film,
    /// The method with the settings used.
    pub method: Method,
    /// Counters and stage times of the frame.
    pub stats: Stats,
    /// Facts about the frame for programs: scene, method, settings, window, errors, plan.
    pub facts: Value,
    /// Remarks for the user.
    pub remarks: Vec<Remark>,
    /// Remarks on the measured error of the image.
    pub measured: Vec<Remark>,
    /// False if rendering was cancelled: the image is partial.
    pub complete: bool,
    /// True if measuring the error was cancelled.
    pub unverified: bool,
}

/// A remark for the user about a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remark {
    /// A note, for example on a choice made.
    Note(String),
    /// A warning that the result may differ from the expected one.
    Warning(String),
}

impl RenderedFrame {
    /// True if the image is black everywhere.
    pub fn is_black(&self) -> bool {
        self.film.color.is_black()
    }
}

/// Returns the film of a finished image, and the number of channels that were not finite and became 0.
///
/// If the image is denoised, the variance belongs to the noisy image.
pub(super) fn film(output: Output, view: &View, scene: &Scene) -> (Film, u64) {
    let (layer, of) =
        if matches!(output.denoised, Some(Ok(_))) { (NOISY_VARIANCE, "noisy_") } else { ("variance", "") };
    let mut metadata = Metadata::default();
    if scene.hides_background {
        metadata.set(BACKGROUND, NO_BACKGROUND);
    }
    if let Some(variance) = &output.variance {
        metadata.set(&format!("{of}standard_error"), standard_error(variance));
        metadata.set(&format!("{of}relative_mse_of_noise"), rel_mse_of_variance(variance, &output.color));
    }
    let variance = output.variance.map(|image| Layer::color(layer, image));
    let resumable = output.resumable.into_iter().filter(|_| !output.complete);
    let layers = variance.into_iter().chain(output.extra).chain(resumable).collect();
    let camera = Some(view.matrices(scene.centre, scene.unit()));
    let mut film = Film { window: view.window, color: output.color, layers, camera, metadata };
    let nonfinite = film.remove_nonfinite();
    (film, nonfinite)
}
