//! Options of studies.

use super::{PeerFigure, StudyError};
use std::path::PathBuf;

/// Options of a study that the command line sets.
pub struct Plan {
    /// Folder of results.
    pub folder: PathBuf,
    /// Number of rendering threads.
    pub threads: usize,
    /// Number of runs per image, of which the fastest counts; number of seeds in studies of scenes of their own.
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
