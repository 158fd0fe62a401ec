//! Studies: benchmarks that render whole pictures by several methods and judge them against a converged reference.
//!
//! Everything rendered is kept in the study's folder under what it depends on (`store`), so that a run that was
//! interrupted goes on where it stopped, and a second run renders only what is missing. References are path-traced in
//! two independent halves, whose difference is their noise (`reference`).
//! Units: processor seconds, over all threads, unless they are said to be elapsed.

mod judge;
mod numbers;
pub(super) mod page;
mod reference;
mod run;
pub(super) mod scatter;
mod store;
mod subject;

pub use judge::Errors;
pub use reference::{Noise, Reference, ReferenceSettings};
pub use run::Run;
pub use subject::Subject;

pub(super) use numbers::{figure, optional, seconds};
pub(super) use run::Candidate;
pub(super) use store::program;
pub use subject::file_of;

use crate::film::ImageError;
use crate::progress::Control;
use crate::session::OpenError;
use std::path::{Path, PathBuf};
use store::Store;

/// What a study is given.
pub struct Study<'a> {
    /// What was chosen.
    pub plan: Plan,
    /// Stops the study between pictures and within them.
    pub control: &'a Control,
    /// Called with what is being done.
    pub say: &'a (dyn Fn(&str) + Sync),
    store: Store,
}

/// What a study wrote down: the same in three formats.
pub struct Document {
    /// For programs.
    pub json: serde_json::Value,
    /// For people and terminals.
    pub markdown: String,
    /// One page that needs nothing else.
    pub html: String,
}

/// What the command line chooses of a study.
pub struct Plan {
    /// Where results are kept.
    pub folder: PathBuf,
    /// Threads that render.
    pub threads: usize,
    /// How often a picture is rendered; the run that took the least processor time counts.
    pub repeats: usize,
    /// Width and height of the pictures.
    pub resolution: [u32; 2],
    /// How good references are to be.
    pub reference: ReferenceSettings,
    /// Points of a designed sample, where there is one.
    pub samples: u32,
    /// Names of the settings that are varied, where any are; if there are none, all.
    pub knobs: Vec<String>,
}

/// Points of a designed sample, unless the user wants others.
pub const SAMPLES: u32 = 32;

/// Why a study ended early. What had been rendered until then is kept.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A scene cannot be read or made ready.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// Pictures of different sizes are compared.
    #[error(transparent)]
    Compare(ImageError),
    /// A result cannot be kept.
    #[error(transparent)]
    Write(ImageError),
    /// The folder cannot be made.
    #[error("cannot make the folder {}: {source}", path.display())]
    Folder {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A setting to vary that does not exist.
    #[error("there is no knob {name}; there are: {known}")]
    Knob {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// It was cancelled.
    #[error("interrupted; what is rendered is kept, the same command goes on from there")]
    Interrupted,
}

impl<'a> Study<'a> {
    /// Opens the folder of results.
    pub fn new(
        plan: Plan,
        control: &'a Control,
        say: &'a (dyn Fn(&str) + Sync),
    ) -> Result<Study<'a>, StudyError> {
        let store = Store::open(&plan.folder)?;
        Ok(Study { plan, control, say, store })
    }

    /// Loads a scene.
    pub fn subject(&self, path: &Path) -> Result<Subject, StudyError> {
        Subject::load(path, self)
    }

    /// What the figures depend on, by name.
    pub fn facts(&self) -> Vec<(String, String)> {
        let [width, height] = self.plan.resolution;
        vec![
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("program".to_owned(), program()),
            ("pixels".to_owned(), format!("{width}x{height}")),
            ("threads".to_owned(), self.plan.threads.to_string()),
            ("runs a picture".to_owned(), self.plan.repeats.to_string()),
        ]
    }
}
