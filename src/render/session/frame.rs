//! A rendered frame: the picture and all that is reported about it.

use crate::denoise::NOISY_VARIANCE;
use crate::method::{Method, Output};
use base::film::metrics::{rel_mse_of_variance, standard_error};
use base::film::{Film, Layer, Metadata};
use base::stats::Stats;
use scene::Scene;
use serde_json::Value;
use world::view::View;

/// Warning of light that paths miss, with its remedy.
pub(super) const FOCUSED: &str = "paths hardly find light of the sun, and none of points and directions, that comes \
    through solid glass; use --method cache or another with virtual lights";

/// Warning of a black picture, with its remedies.
pub const BLACK: &str = "the picture is black: no light reaches what the camera sees; check the camera's place and \
                         direction, and that lights are on the near side of walls and face the scene";

/// A rendered frame.
pub struct Frame {
    /// The picture, its layers and metadata.
    pub film: Film,
    /// The method with the settings used.
    pub method: Method,
    /// Counters and stage times of the frame.
    pub stats: Stats,
    /// Facts about the frame for programs: scene, method, settings, window, errors, plan.
    pub facts: Value,
    /// Remarks for the user.
    pub remarks: Vec<Remark>,
    /// Remarks on the picture's measured error.
    pub measured: Vec<Remark>,
    /// False if rendering was cancelled: the picture is partial.
    pub complete: bool,
    /// True if measuring the picture's error was cancelled.
    pub unverified: bool,
}

/// Something that people should be told about a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remark {
    /// A note, for example on a choice made.
    Note(String),
    /// A warning that the result may differ from the expected one.
    Warning(String),
}

impl Frame {
    /// True if the picture is black everywhere.
    pub fn is_black(&self) -> bool {
        self.film.color.is_black()
    }
}

/// The film of a method's output, without channels that are not finite, whose number is returned. The variance is that
/// of the noisy picture if `denoised`.
pub(super) fn film(output: Output, view: &View, scene: &Scene, denoised: bool) -> (Film, u64) {
    let (layer, of) = if denoised { (NOISY_VARIANCE, "noisy_") } else { ("variance", "") };
    let mut metadata = Metadata::default();
    if let Some(variance) = &output.variance {
        metadata.set(&format!("{of}standard_error"), standard_error(variance));
        metadata.set(&format!("{of}relative_mse_of_noise"), rel_mse_of_variance(variance, &output.color));
    }
    let variance = output.variance.map(|image| Layer::color(layer, image));
    let begun = output.begun.into_iter().filter(|_| !output.complete);
    let layers = variance.into_iter().chain(output.extra).chain(begun).collect();
    let camera = Some(view.matrices(scene.centre, scene.unit()));
    let mut film = Film { window: view.window, color: output.color, layers, camera, metadata };
    let nonfinite = film.remove_nonfinite();
    (film, nonfinite)
}
