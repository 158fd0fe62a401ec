//! Studies: benchmarks that render whole pictures by several methods and judge them against a converged
//! reference.
//!
//! Every picture is stored in the study's folder under a key of all it depends on (`store`), so that an
//! interrupted run resumes where it stopped, and a second run renders only missing pictures. References are
//! path-traced in two independent halves, whose difference is their noise (`reference`).
//!
//! Units: processor seconds, over all threads, unless stated to be elapsed.

mod candidate;
mod equal;
mod judge;
mod numbers;
pub(super) mod page;
mod reference;
mod run;
pub(super) mod scatter;
mod store;
mod subject;

pub use judge::{Errors, rmse_of_psnr};
pub use reference::{Noise, Reference, ReferenceSettings};
pub use run::Run;
pub use subject::Subject;

pub(super) use candidate::{Candidate, eye_samples, qualities};
pub(super) use equal::{Bounded, bounded, time_to};
pub(super) use numbers::{figure, optional, seconds};
pub(super) use store::program;
pub use subject::file_of;

use super::document::Document;
use base::film::ImageError;
use base::progress::Control;
use candidate::DENOISED_SPP;
use render::denoise::{DenoiseError, Denoiser};
use render::session::OpenError;
use std::path::{Path, PathBuf};
use store::Store;

/// A study in progress: its plan, its store of pictures, cancellation and messages.
pub struct Study<'a> {
    /// Options chosen on the command line.
    pub plan: Plan,
    /// Stops the study between pictures and within them.
    pub control: &'a Control,
    /// Callback for progress messages.
    pub say: &'a (dyn Fn(&str) + Sync),
    store: Store,
    /// Name of the denoiser, if there is one.
    denoiser: Option<String>,
}

/// A study's results.
pub struct Results {
    /// All figures, for programs.
    pub json: serde_json::Value,
    /// The same for people.
    pub document: Document,
}

/// Options of a study that the command line sets.
pub struct Plan {
    /// Folder of results.
    pub folder: PathBuf,
    /// Number of rendering threads.
    pub threads: usize,
    /// Number of times that each picture is rendered; the run of the least processor time counts. Number of seeds in
    /// studies of scenes of their own.
    pub repeats: usize,
    /// Width and height of the pictures.
    pub resolution: [u32; 2],
    /// Quality of the references.
    pub reference: ReferenceSettings,
    /// Number of points of a designed sample, in studies that have one.
    pub samples: u32,
    /// Names of the settings, or extremes, to vary, in studies that vary any; if empty, all.
    pub knobs: Vec<String>,
}

/// Default number of points of a designed sample.
pub const SAMPLES: u32 = 32;

/// A reason for which a study ended early. Pictures rendered until then are kept.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene cannot be read or prepared.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// Pictures of different sizes are compared.
    #[error(transparent)]
    Compare(ImageError),
    /// A result cannot be written.
    #[error(transparent)]
    Write(ImageError),
    /// The folder cannot be created.
    #[error("cannot make the folder {}: {source}", path.display())]
    Folder {
        /// Path of the folder.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A scene that the study makes cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Scene {
        /// File of the scene.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The name of a setting to vary does not exist.
    #[error("there is no knob {name}; there are: {known}")]
    Knob {
        /// Name asked for.
        name: String,
        /// Names that exist.
        known: String,
    },
    /// A picture cannot be denoised.
    #[error(transparent)]
    Denoise(DenoiseError),
    /// The study was cancelled.
    #[error("interrupted; what is rendered is kept, the same command goes on from there")]
    Interrupted,
}

impl<'a> Study<'a> {
    /// Creates a study and opens its folder of results.
    pub fn new(
        plan: Plan,
        control: &'a Control,
        say: &'a (dyn Fn(&str) + Sync),
    ) -> Result<Study<'a>, StudyError> {
        let store = Store::open(&plan.folder)?;
        let denoiser = match Denoiser::load() {
            Ok(denoiser) => Some(denoiser.name()),
            Err(error) => {
                say(&format!("pictures keep their noise, denoised paths are left out: {error}"));
                None
            }
        };
        Ok(Study { plan, control, say, store, denoiser })
    }

    /// Loads a scene.
    pub fn subject(&self, path: &Path) -> Result<Subject, StudyError> {
        Subject::load(path, self)
    }

    /// True if pictures can be denoised.
    pub fn denoises(&self) -> bool {
        self.denoiser.is_some()
    }

    /// Returns denoised paths of several numbers of samples a pixel; none without a denoiser.
    pub fn denoised_paths(&self) -> impl Iterator<Item = Candidate> {
        let spps = DENOISED_SPP.into_iter().filter(|_| self.denoises());
        spps.map(|spp| Candidate::denoised_path(format!("path --denoise, {spp} spp"), spp))
    }

    /// Returns the conditions that the figures depend on, by name.
    pub fn facts(&self) -> Vec<(String, String)> {
        let [width, height] = self.plan.resolution;
        vec![
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("program".to_owned(), program()),
            ("pixels".to_owned(), format!("{width}x{height}")),
            ("threads".to_owned(), self.plan.threads.to_string()),
            ("runs a picture".to_owned(), self.plan.repeats.to_string()),
            ("denoiser".to_owned(), self.denoiser.clone().unwrap_or("none".to_owned())),
        ]
    }
}
