//! Builds of the acceleration structure, which are no setting of a method: the default picture, rendered over
//! each.

use super::{Candidate, Judge, Sort, StudyError, Sweep};
use base::setting::JudgedBy;
use embree::BuildQuality;
use render::method::Method;

/// A choice between builds.
pub struct Builds {
    /// Name of the choice.
    pub name: &'static str,
    /// Levels from coarse to fine.
    levels: &'static [(&'static str, BuildQuality)],
}

/// All choices.
pub const BUILDS: [Builds; 2] = [
    Builds {
        name: "build quality",
        levels: &[("low", BuildQuality::Low), ("medium", BuildQuality::Medium), ("high", BuildQuality::High)],
    },
    Builds {
        name: "robust traversal",
        levels: &[("off", BuildQuality::Medium), ("on", BuildQuality::Robust)],
    },
];

impl Judge<'_> {
    /// Renders the default over every build; times include the build.
    pub fn sweep_builds(&mut self, builds: &Builds) -> Result<Sweep, StudyError> {
        let mut levels = Vec::with_capacity(builds.levels.len());
        for &(text, quality) in builds.levels {
            let label = format!("{} {text}", builds.name);
            let candidate = Candidate::new(label, Method::default());
            let run = self.study.run_over(quality, &mut self.subject, &candidate)?;
            let point = self.judge(&candidate, &candidate.label, Sort::Sweep, &run)?;
            levels.push((text.to_owned(), point));
        }
        Ok(self.judged(builds.name, levels, JudgedBy::Limit))
    }
}
