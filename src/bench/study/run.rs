//! An image rendered by a method, or loaded from the store.

use super::store::{Stored, program};
use super::{Candidate, Counted, Study, StudyError, Subject};
use base::film::Image;
use base::stats::{Stage, Stats};
use render::method::{LightStore, Output};
use render::session::{Finish, Goal};
use render::walk::{RetentionLimits, Walk};
use serde_json::json;
use world::view::View;

/// A rendered image with its statistics.
pub struct Run {
    /// The image.
    pub color: Image,
    /// Counters and times of stages.
    pub counted: Counted,
}

impl Study<'_> {
    /// Renders an image, or loads it if this program has rendered it before. Of several runs the fastest counts.
    pub fn run(&self, subject: &Subject, candidate: &Candidate) -> Result<Run, StudyError> {
        let method = &candidate.method;
        let name = format!("{}, {}", subject.name, method.name());
        // The label is not part of the key.
        let key = json!({
            "scene": format!("{:016x}", subject.hash),
            "film": subject.view.window.film,
            "program": program(),
            "threads": self.plan.threads,
            "repeats": self.plan.repeats,
            "method": method.name(),
            "denoise": candidate.denoise && self.denoises(),
            "walk": candidate.walk,
            // The debug text holds all settings, also those without an option.
            "settings": format!("{method:?}"),
        });
        if let Some(Stored { color, facts, .. }) = self.store.load(&name, &key, &[])
            && let Ok(counted) = serde_json::from_value(facts)
        {
            return Ok(Run { color, counted });
        }
        let views = candidate.walk.and_then(|frames| subject.walk(frames));
        let run = match views {
            Some(views) => self.walk(subject, candidate, &views)?,
            None => self.render(subject, candidate)?,
        };
        let unit = if candidate.walk.is_some() { ", per frame" } else { "" };
        let seconds = run.counted.seconds(&Stage::ALL);
        (self.say)(&format!("{}, {}{unit}: {seconds:.2} s", subject.name, candidate.label));
        let facts = json!(run.counted);
        self.store.save(&name, &key, &Stored { color: run.color.clone(), layers: Vec::new(), facts })?;
        Ok(run)
    }

    /// Renders a walk-through over `views` once. Returns its last image with mean times and numbers of new records.
    fn walk(&self, subject: &Subject, candidate: &Candidate, views: &[View]) -> Result<Run, StudyError> {
        let denoise = Some(candidate.denoise && self.denoises());
        let goal = Goal { method: candidate.method, denoise, ..Goal::default() };
        let mut walk = Walk::new(&subject.session, goal, RetentionLimits::default());
        let mut frames = Vec::new();
        let mut last = None;
        for view in views {
            // Other errors are of settings, which studies choose, and of memory.
            let frame = walk.frame(view, self.control).ok().filter(|frame| frame.complete);
            let frame = frame.ok_or(StudyError::Interrupted)?;
            frames.push(Counted::new(&frame.stats));
            last = Some(frame.film.color);
        }
        let mut counted = frames.last().cloned().unwrap_or_default();
        counted.average(&frames);
        Ok(Run { color: last.ok_or(StudyError::Interrupted)?, counted })
    }

    /// Renders several times and returns the run that took the least processor time.
    fn render(&self, subject: &Subject, candidate: &Candidate) -> Result<Run, StudyError> {
        let mut best: Option<Run> = None;
        for _ in 0..self.plan.repeats.max(1) {
            let mut output = self.render_once(subject, candidate)?;
            output.color.remove_nonfinite();
            let counted = Counted { work: output.work, ..Counted::new(&output.stats) };
            let run = Run { color: output.color, counted };
            let seconds = |run: &Run| run.counted.seconds(&Stage::ALL);
            if best.as_ref().is_none_or(|best| seconds(&run) < seconds(best)) {
                best = Some(run);
            }
        }
        // The first run is `None` only if it was interrupted.
        best.ok_or(StudyError::Interrupted)
    }

    /// Renders once with virtual lights of its own, and returns the image with all of its statistics.
    pub fn render_once(&self, subject: &Subject, candidate: &Candidate) -> Result<Output, StudyError> {
        let Subject { session, view, .. } = subject;
        let goal = Goal { denoise: Some(candidate.denoise && self.denoises()), ..Goal::default() };
        let mut stats = Stats::new();
        let finish = Finish::new(&session.world, view, &goal, self.control, &mut stats);
        let method = finish.guided(candidate.method);
        let output = method.render(&session.world, &LightStore::default(), view, self.control);
        let mut output = finish.apply(&method, output);
        let failure = output.denoised.as_ref().and_then(|denoised| denoised.as_ref().err());
        if let Some(error) = finish.load_error().or(failure) {
            return Err(StudyError::Render(error.to_string()));
        }
        if !output.complete {
            return Err(StudyError::Interrupted);
        }
        stats.merge(&output.stats);
        output.stats = stats;
        Ok(output)
    }
}
