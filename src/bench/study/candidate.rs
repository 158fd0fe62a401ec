//! Images that a study renders: methods with settings.

use super::Study;
use render::method::{Method, path, vpl};
use render::plan::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE};
use serde::Serialize;
use transport::paths::Estimand;

/// Samples per pixel of the denoised paths that make a curve.
const DENOISED_SPP: [u32; 5] = [1, 4, 16, 64, 256];

/// An image to be rendered.
#[derive(Clone)]
pub struct Candidate {
    /// Label of its row or point.
    pub label: String,
    /// Method and settings.
    pub method: Method,
    /// True if the image is denoised.
    pub denoise: bool,
    /// Number of frames of a walk-through whose last frame is the image; `None` for a single image.
    pub walk: Option<usize>,
    /// Options for the settings that differ from the defaults.
    pub options: String,
    /// Group that the image belongs to.
    pub group: Group,
    /// False for a mere point on the curve of its group.
    pub main: bool,
}

/// Groups of images, by the reason for which these are rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// The defaults, and methods that are compared by themselves.
    Default,
    /// Settings of `--quality`.
    Quality,
    /// One setting varied.
    Sweep,
    /// Other methods.
    Other,
    /// Denoised paths of several sample counts.
    DenoisedPath,
    /// Lightcuts with cuts shared between neighbours.
    Lightcuts,
    /// Lightcuts with a cut per sample, as in the paper.
    Unshared,
    /// Final gathering over a photon map.
    PhotonCache,
}

impl Candidate {
    /// Creates a candidate that is denoised if its method leaves noise.
    pub fn new(label: impl Into<String>, method: Method) -> Candidate {
        Candidate {
            label: label.into(),
            denoise: method.leaves_noise(),
            method,
            walk: None,
            options: String::new(),
            group: Group::Default,
            main: true,
        }
    }

    /// Creates denoised paths.
    pub fn denoised_path(spp: u32) -> Candidate {
        let method = Method::Path(path::Settings { spp, ..path::Settings::default() });
        let group = Group::DenoisedPath;
        let label = format!("path --denoise, {spp} spp");
        Candidate { denoise: true, group, ..Candidate::new(label, method) }
    }

    /// Returns true for the path tracer.
    pub fn is_path(&self) -> bool {
        matches!(self.method, Method::Path(_))
    }

    /// Returns true if the method estimates whole pixels, false if it keeps eye samples.
    pub fn whole_pixels(&self) -> bool {
        self.method.estimand() == Estimand::Pixels
    }
}

/// Returns denoised paths of several sample counts; none if the study has no denoiser.
pub fn denoised_paths(study: &Study) -> impl Iterator<Item = Candidate> {
    DENOISED_SPP.into_iter().filter(|_| study.denoises()).map(Candidate::denoised_path)
}

/// Returns the default method at the named levels of the quality scale.
pub fn qualities() -> impl Iterator<Item = Candidate> {
    let ladder = Ladder::new(Method::default(), &[]);
    let named = [("draft", DRAFT), ("preview", PREVIEW), ("final", FINAL), ("reference", REFERENCE)];
    ladder.into_iter().flat_map(move |ladder| {
        named.map(|(name, level)| {
            let method = ladder.at(level);
            Candidate {
                options: method.scaled_options(),
                group: Group::Quality,
                ..Candidate::new(name, method)
            }
        })
    })
}

/// Returns the eye samples of methods that keep these: the samples of reconstruction cuts.
pub fn eye_samples() -> Estimand {
    let vpl::Settings { spp, seed, .. } = vpl::Settings::reconstruction();
    Estimand::EyeSamples { spp, seed }
}

/// Returns the photon cache on the eye samples of reconstruction cuts.
pub fn photons_on_eye_samples() -> vpl::Settings {
    let spp = vpl::Settings::reconstruction().spp;
    vpl::Settings { spp, ..vpl::Settings::photon_cache() }
}
