//! A study in progress.

use super::store::{Store, program};
use super::{Plan, StudyError};
use crate::machine::{self, Facts};
use base::progress::Control;
use render::denoise::Denoiser;

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
