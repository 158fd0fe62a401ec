//! Progress of a run: the fraction that is done, and the remaining time.
//!
//! All frames have the same weight. Within a frame a stage has its typical share of the time, if the method and the
//! goal include it. The progress of planning is unknown: a plan counts when it is complete.

use base::progress::Progress;
use base::stats::Stage;
use render::session::{Goal, PlanGoal};
use std::time::Instant;

/// Stages in their order, with their typical shares of the time of a frame.
const SHARES: [(Stage, f64); 7] = [
    (Stage::EyePass, 0.35),
    (Stage::LightPass, 0.05),
    (Stage::Tree, 0.1),
    (Stage::Records, 0.15),
    (Stage::Render, 0.2),
    (Stage::Denoise, 0.15),
    (Stage::Verify, 0.5),
];

/// Share of the time of a frame after its last stage.
const END: f64 = 0.01;

/// Share of the choice of a method.
const OF_CHOICE: f64 = 0.05;

/// Share of planning the settings for a time.
const OF_TIME: f64 = 0.3;

/// Share of the search for an error. It ends with the complete image.
const OF_ERROR: f64 = 1.0;

/// Stages of a frame that depend on its goal.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stages {
    /// Share of planning.
    plan: f64,
    denoises: bool,
    verifies: bool,
}

impl Stages {
    /// Returns the stages of a frame with this goal.
    pub fn new(goal: &Goal) -> Stages {
        let (plan, measures) = match goal.plan {
            PlanGoal::AsSet if goal.may_choose && goal.denoises() => (OF_CHOICE, false),
            PlanGoal::AsSet => (0.0, false),
            PlanGoal::Time(_) => (OF_TIME, false),
            PlanGoal::Error(_) => (OF_ERROR, true),
        };
        Stages { plan, denoises: goal.denoises(), verifies: goal.verify.is_some() && !measures }
    }

    /// Returns the fraction of a frame that is done. `first` is the first stage of the method.
    fn in_frame(&self, first: Stage, now: &Progress) -> f64 {
        let is_there = |stage: Stage| match stage {
            Stage::Denoise => self.denoises,
            Stage::Verify => self.verifies,
            _ => true,
        };
        let shares = || SHARES.into_iter().filter(|(stage, _)| is_there(*stage) && *stage >= first);
        let all: f64 = shares().map(|(_, share)| share).sum();
        let before: f64 = shares().filter(|(stage, _)| *stage < now.stage).map(|(_, share)| share).sum();
        let share = shares().find(|(stage, _)| *stage == now.stage).map_or(0.0, |(_, share)| share);
        let part = if now.total > 0 { now.done as f64 / now.total as f64 } else { 0.0 };
        self.plan + (1.0 - self.plan) * (1.0 - END) * (before + part * share) / all.max(share)
    }
}

/// A part of a run.
#[derive(Clone, Copy, Debug)]
pub struct RunSpan {
    /// Start of the run.
    start: Instant,
    /// Fractions of the run at which the part begins and ends.
    fractions: [f64; 2],
}

impl RunSpan {
    /// Returns a run that begins now, without parts.
    pub fn begin() -> RunSpan {
        RunSpan { start: Instant::now(), fractions: [0.0, 1.0] }
    }

    /// Returns one of `count` equal parts.
    pub fn part(self, index: usize, count: usize) -> RunSpan {
        let [from, to] = self.fractions;
        let at = |index: usize| from + (to - from) * index as f64 / count.max(1) as f64;
        RunSpan { fractions: [at(index), at(index + 1)], ..self }
    }
}

/// Progress of a part of a run.
#[derive(Debug)]
pub struct RunProgress {
    span: RunSpan,
    stages: Stages,
    /// Number of frames in the part.
    frames: usize,
    /// Number of complete frames.
    done: usize,
    /// First stage of the current frame after planning.
    first: Option<Stage>,
    /// Last fraction that was reported.
    fraction: f64,
}

impl RunProgress {
    /// Builds the progress of a part with `frames` frames of these stages.
    pub fn new(frames: usize, stages: Stages, span: RunSpan) -> RunProgress {
        RunProgress { span, stages, frames, done: 0, first: None, fraction: span.fractions[0] }
    }

    /// Counts the current frame as complete.
    pub fn frame_done(&mut self) {
        self.done += 1;
        self.first = None;
    }

    /// Returns the number of complete frames and the number of all frames of the part.
    pub fn frames(&self) -> [usize; 2] {
        [self.done, self.frames]
    }

    /// Returns the fraction of the run that is done. It never decreases.
    pub fn fraction(&mut self, now: Option<&Progress>) -> f64 {
        let in_frame = now.map_or(0.0, |now| self.in_frame(now));
        let in_part = (self.done as f64 + in_frame) / self.frames.max(1) as f64;
        let [from, to] = self.span.fractions;
        // The last value is exact.
        let fraction = if in_part < 1.0 { from + in_part * (to - from) } else { to };
        self.fraction = self.fraction.max(fraction);
        self.fraction
    }

    /// Returns the expected seconds until the end; `None` before the first progress.
    pub fn eta_seconds(&self) -> Option<f64> {
        (self.fraction > 0.0)
            .then(|| self.span.start.elapsed().as_secs_f64() * (1.0 - self.fraction) / self.fraction)
    }

    fn in_frame(&mut self, now: &Progress) -> f64 {
        if now.displayed_stage() == Stage::Plan {
            return 0.0;
        }
        let first = *self.first.get_or_insert(now.stage);
        self.stages.in_frame(first, now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use render::session::ErrorLimit;

    fn at(stage: Stage, done: u64) -> Progress {
        Progress { stage, is_planning: false, done, total: 10 }
    }

    const ALL: Stages = Stages { plan: 0.0, denoises: true, verifies: true };

    #[test]
    fn fractions_rise_through_stages_and_frames_to_the_end_of_their_span() {
        let mut course = RunProgress::new(2, ALL, RunSpan::begin().part(2, 3));
        let mut last = course.fraction(None);
        assert!((last - 2.0 / 3.0).abs() < 1e-9);
        for _ in 0..2 {
            for (stage, _) in SHARES {
                for done in [1, 5, 10] {
                    let fraction = course.fraction(Some(&at(stage, done)));
                    assert!(fraction > last && fraction < 1.0, "{stage:?} {fraction}");
                    last = fraction;
                }
            }
            course.frame_done();
            assert!(course.fraction(None) > last);
        }
        assert_eq!((course.fraction(None), course.frames()), (1.0, [2, 2]));
    }

    #[test]
    fn stages_that_a_run_has_not_leave_no_gap_and_fractions_never_fall() {
        let goal = Goal { denoise: Some(false), ..Goal::default() };
        let mut course = RunProgress::new(1, Stages::new(&goal), RunSpan::begin());
        assert_eq!((course.fraction(None), course.eta_seconds()), (0.0, None));
        let half = 0.5 * (1.0 - END);
        assert!((course.fraction(Some(&at(Stage::Render, 5))) - half).abs() < 1e-9);
        assert!((course.fraction(Some(&at(Stage::Render, 1))) - half).abs() < 1e-9);
        assert!((course.fraction(Some(&at(Stage::Render, 10))) - 2.0 * half).abs() < 1e-9);
        assert!(course.eta_seconds().is_some());
    }

    #[test]
    fn plans_and_measurements_have_their_shares() {
        let verify = Some(render::verify::VerifySettings::default());
        let choice = Stages::new(&Goal { may_choose: true, verify, ..Goal::default() });
        let mut course = RunProgress::new(1, choice, RunSpan::begin());
        assert_eq!(course.fraction(Some(&Progress { is_planning: true, ..at(Stage::Verify, 9) })), 0.0);
        assert!(course.fraction(Some(&at(Stage::Render, 0))) >= OF_CHOICE);
        assert!(course.fraction(Some(&at(Stage::Render, 10))) < 0.5);
        assert!(course.fraction(Some(&at(Stage::Verify, 5))) < 0.9);
        let searched = PlanGoal::Error(ErrorLimit { error: 0.1, max_samples: 1, pinned: Vec::new() });
        let mut course =
            RunProgress::new(1, Stages::new(&Goal { plan: searched, ..Goal::default() }), RunSpan::begin());
        assert_eq!(course.fraction(Some(&Progress { is_planning: true, ..at(Stage::Render, 9) })), 0.0);
        course.frame_done();
        assert_eq!(course.fraction(None), 1.0);
    }
}
