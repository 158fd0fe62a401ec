//! A picture by some method and settings, rendered or found again.

use super::reference::{Reference, reference};
use super::store::{Kept, program};
use super::{Study, StudyError, Subject};
use crate::eye::Look;
use crate::image::Image;
use crate::method::Method;
use crate::stats::Stage;
use serde_json::{Value, json};

/// What may be rendered.
#[derive(Clone)]
pub struct Candidate {
    /// What it is called.
    pub label: String,
    /// How it is rendered.
    pub method: Method,
}

/// What was rendered.
#[derive(Clone)]
pub struct Run {
    /// The picture.
    pub color: Image,
    /// Counters and stage times.
    stats: Value,
}

impl Study<'_> {
    /// The subject's reference, as far as the settings ask.
    pub fn reference(&self, subject: &Subject, look: Look) -> Result<Reference, StudyError> {
        reference(self, subject, look)
    }

    /// Renders, unless this program has already done so.
    pub fn run(&self, subject: &Subject, candidate: &Candidate) -> Result<Run, StudyError> {
        let method = &candidate.method;
        let name = format!("{}, {}", subject.name, candidate.label);
        let key = json!({
            "scene": format!("{:016x}", subject.hash),
            "film": self.plan.resolution,
            "program": program(),
            "threads": self.plan.threads,
            "repeats": self.plan.repeats,
            "method": method.name(),
            // All settings, those without a name on the command line too.
            "settings": format!("{method:?}"),
        });
        // Whatever it is called here.
        let file = format!("{}, {}", subject.name, method.name());
        if let Some(kept) = self.store.load(&file, &key, &[]) {
            return Ok(Run { color: kept.color, stats: kept.facts });
        }
        let mut best: Option<Run> = None;
        for _ in 0..self.plan.repeats.max(1) {
            let output = method.render(&subject.world, &subject.window, self.control);
            if !output.complete {
                return Err(StudyError::Interrupted);
            }
            let mut run = Run { color: output.color, stats: output.stats.to_json() };
            run.color.remove_nonfinite();
            if best.as_ref().is_none_or(|best| run.seconds(&Stage::ALL) < best.seconds(&Stage::ALL)) {
                best = Some(run);
            }
        }
        // At least one was rendered.
        let Some(run) = best else { return Err(StudyError::Interrupted) };
        (self.say)(&format!("{name}: {:.2} s", run.seconds(&Stage::ALL)));
        let kept = Kept { color: run.color.clone(), layers: Vec::new(), facts: run.stats.clone() };
        self.store.save(&file, &key, &kept)?;
        Ok(run)
    }
}

impl Run {
    /// Processor seconds of some stages.
    pub fn seconds(&self, stages: &[Stage]) -> f64 {
        self.sum(stages, "cpu_seconds")
    }

    /// Elapsed seconds of all stages.
    pub fn elapsed(&self) -> f64 {
        self.sum(&Stage::ALL, "wall_seconds")
    }

    fn sum(&self, stages: &[Stage], clock: &str) -> f64 {
        stages.iter().filter_map(|stage| self.stats["times"][stage.key()][clock].as_f64()).sum()
    }

    /// A counter, if it was counted.
    pub fn counter(&self, group: &str, name: &str) -> Option<f64> {
        self.stats["counters"][group][name].as_f64()
    }
}
