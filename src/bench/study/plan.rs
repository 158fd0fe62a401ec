//! A study in progress: its plan and its stored images.

use super::store::{Store, program};
use super::{PeerFigure, StudyError};
use crate::machine::{self, Facts};
use base::progress::Control;
use render::denoise::Denoiser;
use std::path::PathBuf;

/// Options of a study that the command line sets.
pub struct Plan {
    /// Folder of results.
    pub folder: PathBuf,
    /// Number of rendering threads.
    pub threads: usize,
    /// Number of runs per image, of which the fastest counts.
    pub repeats: usize,
    /// Width and height of the images.
    pub resolution: [u32; 2],
    /// Quality of the references.
    pub reference: ReferenceSettings,
    /// Names of the settings or quantities to vary, in studies that vary any; if empty, all.
    pub knobs: Vec<String>,
    /// Figures of other programs, for studies with a chart.
    pub peers: Vec<PeerFigure>,
}

impl Plan {
    /// Returns the names to vary among `known`: the names asked for, or all.
    ///
    /// # Errors
    /// If a name asked for is not known.
    pub(crate) fn knobs<'k>(&self, known: &[&'k str]) -> Result<Vec<&'k str>, StudyError> {
        if let Some(name) = self.knobs.iter().find(|name| !known.contains(&name.as_str())) {
            let separator = if known.iter().any(|name| name.contains(',')) { "; " } else { ", " };
            let known = known.join(separator);
            return Err(StudyError::Usage(format!("there is no knob {name}; there are: {known}")));
        }
        let wanted = |name: &str| self.knobs.is_empty() || self.knobs.iter().any(|knob| knob == name);
        Ok(known.iter().copied().filter(|name| wanted(name)).collect())
    }
}

/// Limits at which a reference is good enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceSettings {
    /// Samples per pixel, both halves together.
    pub spp: u32,
    /// Elapsed seconds after which no round begins, including earlier runs.
    pub seconds: f64,
}

impl Default for ReferenceSettings {
    fn default() -> ReferenceSettings {
        ReferenceSettings { spp: 1024, seconds: 1800.0 }
    }
}

/// A study in progress: its plan, its stored images, cancellation and messages.
pub struct Study<'a> {
    /// Options chosen on the command line.
    pub plan: Plan,
    /// Stops the study between images and within them.
    pub control: &'a Control,
    /// Callback for progress messages.
    pub say: &'a (dyn Fn(&str) + Sync),
    /// Stored images.
    pub(super) store: Store,
    /// Facts about machine and program, found before the first image.
    machine: Facts,
    /// Name of the denoiser, if there is one.
    denoiser: Option<String>,
}

impl<'a> Study<'a> {
    /// Creates a study and opens its folder of results.
    ///
    /// # Errors
    /// If the folder cannot be created.
    pub fn new(
        plan: Plan,
        control: &'a Control,
        say: &'a (dyn Fn(&str) + Sync),
    ) -> Result<Study<'a>, StudyError> {
        let store = Store::open(&plan.folder)?;
        let denoiser = match Denoiser::load() {
            Ok(denoiser) => Some(denoiser.name()),
            Err(error) => {
                say(&format!("images are not denoised, and denoised paths are left out: {error}"));
                None
            }
        };
        let machine = machine::facts(plan.threads);
        Ok(Study { plan, control, say, store, machine, denoiser })
    }

    /// Returns true if images can be denoised.
    pub fn denoises(&self) -> bool {
        self.denoiser.is_some()
    }

    /// Returns the conditions that the figures depend on, each with its name.
    pub(crate) fn facts(&self) -> Facts {
        let [width, height] = self.plan.resolution;
        let own = [
            ("pixels", format!("{width}x{height}")),
            ("runs per image", self.plan.repeats.to_string()),
            ("denoiser", self.denoiser.clone().unwrap_or("none".to_owned())),
            ("program", program()),
        ];
        let own = own.map(|(name, value)| (name.to_owned(), value));
        self.machine.iter().cloned().chain(own).collect()
    }
}
