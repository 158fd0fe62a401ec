//! A rendered frame: the image and all that is reported about it.

use crate::denoise::NOISY_VARIANCE;
use crate::method::{Method, Output};
use base::film::metrics::{rel_mse_of_variance, standard_error};
use base::film::{BACKGROUND, Film, Layer, Metadata, NO_BACKGROUND};
use base::shown::shown_line;
use base::stats::Stats;
use scene::Scene;
use serde_json::Value;
use world::view::View;

/// Warning of light that paths miss, with its remedy.
pub(super) const FOCUSED: &str = "path tracing seldom finds sunlight through solid glass, and never finds point and directional \
    lights through it; use --method cache or another method with virtual lights";

/// Start of the warning of a black image.
const BLACK: &str = "the image is black: no light reaches the surfaces in view";

/// Maximum number of emitters that the warning of a black image names.
const MAX_NAMED: usize = 3;

/// Returns the warning of a black image of a scene that has light: names of its lights, and remedies.
pub(super) fn black_warning(scene: &Scene) -> String {
    let mut emitters: Vec<String> = Vec::new();
    for mesh in scene.meshes.iter().filter(|mesh| mesh.emission.is_some()) {
        let name = format!("the emitter \"{}\"", shown_line(&mesh.name));
        if !emitters.contains(&name) {
            emitters.push(name);
        }
    }
    let left_out = emitters.len().saturating_sub(MAX_NAMED);
    emitters.truncate(MAX_NAMED);
    let counted = |count: usize, what: &str| (count > 0).then(|| format!("{count} {what}"));
    let others = [
        counted(left_out, "more emitters"),
        counted(scene.lights.len(), "point, spot or directional lights"),
        counted(scene.discs.len(), "suns"),
        scene.environment.is_some().then(|| "the environment".to_owned()),
    ];
    let lights: Vec<String> = emitters.into_iter().chain(others.into_iter().flatten()).collect();
    format!(
        "{BLACK} from its lights ({}); check the position and direction of the camera, and that lights are inside rooms \
         and face the scene: emitters shine from their fronts",
        lights.join(", ")
    )
}

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
    /// Returns the warning that the image is black, if there is one.
    pub fn black_warning(&self) -> Option<&str> {
        self.remarks.iter().find_map(|remark| match remark {
            Remark::Warning(text) if text.starts_with(BLACK) => Some(text.as_str()),
            _ => None,
        })
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
    let mut film = Film { window: view.window, color: output.color, layers, camera, metadata, half: false };
    let nonfinite = film.remove_nonfinite();
    (film, nonfinite)
}
