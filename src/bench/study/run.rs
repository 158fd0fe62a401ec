//! A picture by some method and settings, rendered or loaded from the store.

use super::reference::{Reference, reference};
use super::store::{Kept, program};
use super::{Candidate, Study, StudyError, Subject};
use base::film::Image;
use base::stats::{Stage, StageTime, Stats, Stopwatch};
use embree::BuildQuality;
use render::method::LightStore;
use render::session::{Finish, Goal};
use render::walk::{RetentionLimits, Walk};
use serde_json::{Value, json};
use transport::paths::Estimand;
use world::view::View;

/// A rendered picture with its statistics.
#[derive(Clone)]
pub struct Run {
    /// The picture.
    pub color: Image,
    /// Counters and stage times.
    stats: Value,
}

/// Name and key under which a picture is stored; the key holds all that the picture depends on.
struct Place {
    file: String,
    key: Value,
}

impl Study<'_> {
    /// Returns the subject's reference, rendered as far as the settings ask.
    pub fn reference(&self, subject: &Subject, estimand: Estimand) -> Result<Reference, StudyError> {
        reference(self, subject, estimand)
    }

    /// Renders a picture, or loads it if this program has already rendered it.
    pub fn run(&self, subject: &Subject, candidate: &Candidate) -> Result<Run, StudyError> {
        let place = self.place(subject, candidate, None);
        match self.kept(&place) {
            Some(run) => Ok(run),
            None => {
                let views = candidate.walk.and_then(|frames| subject.walk(frames));
                let rendered = match views {
                    Some(views) => self.walk(subject, candidate, &views),
                    None => self.render(subject, candidate),
                };
                self.keep(&place, rendered?)
            }
        }
    }

    /// The same over an acceleration structure built for this run; the time includes the build.
    pub fn run_over(
        &self,
        quality: BuildQuality,
        subject: &mut Subject,
        candidate: &Candidate,
    ) -> Result<Run, StudyError> {
        let place = self.place(subject, candidate, Some(quality));
        if let Some(run) = self.kept(&place) {
            return Ok(run);
        }
        let watch = Stopwatch::start();
        subject.rebuild(quality)?;
        let built = watch.elapsed();
        let run = self.render(subject, candidate);
        subject.rebuild(BuildQuality::default())?;
        let mut run = run?;
        run.stats["times"][Stage::Build.key()] = json!(built);
        self.keep(&place, run)
    }

    /// Returns name and key; a picture whose time includes a build has a key of its own.
    fn place(&self, subject: &Subject, candidate: &Candidate, built: Option<BuildQuality>) -> Place {
        let method = &candidate.method;
        let key = json!({
            "scene": format!("{:016x}", subject.hash),
            "film": subject.view.window.film,
            "program": program(),
            "threads": self.plan.threads,
            "build": built.map(|quality| format!("{quality:?}")),
            "repeats": self.plan.repeats,
            "method": method.name(),
            "denoise": candidate.denoise && self.denoises(),
            "walk": candidate.walk,
            // All settings, including those that the command line lacks.
            "settings": format!("{method:?}"),
        });
        // The label is not part of the key.
        Place { file: format!("{}, {}", subject.name, method.name()), key }
    }

    fn kept(&self, place: &Place) -> Option<Run> {
        let kept = self.store.load(&place.file, &place.key, &[])?;
        Some(Run { color: kept.color, stats: kept.facts })
    }

    fn keep(&self, place: &Place, run: Run) -> Result<Run, StudyError> {
        let kept = Kept { color: run.color.clone(), layers: Vec::new(), facts: run.stats.clone() };
        self.store.save(&place.file, &place.key, &kept)?;
        Ok(run)
    }

    /// Renders a walk-through over `views`, once; returns its last picture with the means over all frames of times and
    /// of records computed.
    fn walk(&self, subject: &Subject, candidate: &Candidate, views: &[View]) -> Result<Run, StudyError> {
        let denoise = Some(candidate.denoise && self.denoises());
        let goal = Goal { method: candidate.method, denoise, ..Goal::default() };
        let mut walk = Walk::new(&subject.session, goal, RetentionLimits::default());
        let mut times = [0.0; Stage::ALL.len()].map(|_: f64| StageTime::default());
        let mut records = 0.0;
        let mut last = None;
        for view in views {
            // The only other errors are of settings, which studies choose, and of memory.
            let frame = walk.frame(view, self.control).ok().filter(|frame| frame.complete);
            let Some(frame) = frame else { return Err(StudyError::Interrupted) };
            for (time, stage) in times.iter_mut().zip(Stage::ALL) {
                *time += frame.stats.stage(stage).unwrap_or_default();
            }
            let run = Run { color: frame.film.color, stats: frame.stats.to_json() };
            records += run.counter("Walk", "new records").unwrap_or_default();
            last = Some(run);
        }
        let Some(mut run) = last else { return Err(StudyError::Interrupted) };
        let frames = views.len() as f64;
        run.stats["times"] = Value::Object(Default::default());
        for (time, stage) in times.iter().zip(Stage::ALL).filter(|(time, _)| time.wall_seconds > 0.0) {
            let StageTime { wall_seconds, cpu_seconds } = *time;
            let mean = StageTime { wall_seconds: wall_seconds / frames, cpu_seconds: cpu_seconds / frames };
            run.stats["times"][stage.key()] = json!(mean);
        }
        for (layer, count) in [("direct", 0.0), ("indirect", records / frames)] {
            run.stats["counters"]["Cache"][format!("records, {layer}")] = json!(count);
        }
        let seconds = run.seconds(&Stage::ALL);
        (self.say)(&format!("{}, {}, a frame: {seconds:.2} s", subject.name, candidate.label));
        Ok(run)
    }

    /// Renders `repeats` times and returns the run that took the least processor time.
    fn render(&self, subject: &Subject, candidate: &Candidate) -> Result<Run, StudyError> {
        let mut best: Option<Run> = None;
        for _ in 0..self.plan.repeats.max(1) {
            let Subject { session, view, .. } = subject;
            let goal = Goal { denoise: Some(candidate.denoise && self.denoises()), ..Goal::default() };
            let mut loading = Stats::new();
            let finish = Finish::new(&session.world, view, &goal, self.control, &mut loading);
            let method = finish.guided(candidate.method);
            let output = method.render(&session.world, &LightStore::default(), view, self.control);
            let mut output = finish.apply(&method, output);
            output.stats.merge(&loading);
            let failure = output.denoised.as_ref().and_then(|denoised| denoised.as_ref().err());
            if let Some(error) = finish.load_error().or(failure) {
                return Err(StudyError::Denoise(error.clone()));
            }
            if !output.complete {
                return Err(StudyError::Interrupted);
            }
            let mut run = Run { color: output.color, stats: output.stats.to_json() };
            run.color.remove_nonfinite();
            if best.as_ref().is_none_or(|best| run.seconds(&Stage::ALL) < best.seconds(&Stage::ALL)) {
                best = Some(run);
            }
        }
        // `None` only if the first run was interrupted.
        let Some(run) = best else { return Err(StudyError::Interrupted) };
        (self.say)(&format!("{}, {}: {:.2} s", subject.name, candidate.label, run.seconds(&Stage::ALL)));
        Ok(run)
    }
}

impl Run {
    /// Returns the sum of some stages' processor seconds.
    pub fn seconds(&self, stages: &[Stage]) -> f64 {
        self.sum(stages, "cpu_seconds")
    }

    /// Returns the sum of all stages' elapsed seconds.
    pub fn elapsed(&self) -> f64 {
        self.sum(&Stage::ALL, "wall_seconds")
    }

    fn sum(&self, stages: &[Stage], clock: &str) -> f64 {
        let times = stages.iter().filter_map(|stage| self.stats["times"][stage.key()][clock].as_f64());
        // The sum of none would be -0.
        times.fold(0.0, |sum, time| sum + time)
    }

    /// True if the picture was denoised.
    pub fn denoised(&self) -> bool {
        self.stats["times"][Stage::Denoise.key()].is_object()
    }

    /// Returns a counter, if it was counted.
    pub fn counter(&self, group: &str, name: &str) -> Option<f64> {
        self.stats["counters"][group][name].as_f64()
    }
}
