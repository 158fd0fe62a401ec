//! The course of a run: the part of it that is done, and how long the rest will take.
//!
//! Frames count alike. Within a frame stages count by their usual shares of the time, from the first that the method
//! has on, and those that the goal asks for. How far a plan is nobody knows: it counts as a whole once it is over.

use base::progress::Progress;
use base::stats::Stage;
use render::session::{Goal, Wanted};
use std::time::Instant;

/// Stages in the order in which they begin, and their usual shares of a picture's time.
const SHARES: [(Stage, f64); 7] = [
    (Stage::EyePass, 0.35),
    (Stage::LightPass, 0.05),
    (Stage::Tree, 0.1),
    (Stage::Records, 0.15),
    (Stage::Render, 0.2),
    (Stage::Denoise, 0.15),
    (Stage::Verify, 0.5),
];

/// Share of a frame's time after its last stage.
const END: f64 = 0.01;

/// Shares of plans: of a method, and of settings for a time. A search for an error ends with the picture.
const OF_CHOICE: f64 = 0.05;
const OF_TIME: f64 = 0.3;
const OF_ERROR: f64 = 1.0;

/// Stages of a frame that its goal decides.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stages {
    /// Share of planning.
    plan: f64,
    denoises: bool,
    verifies: bool,
}

impl Stages {
    /// The stages that lead to `goal`.
    pub fn of(goal: &Goal) -> Stages {
        let (plan, measures) = match goal.wanted {
            Wanted::AsSet if goal.may_choose && goal.denoises() => (OF_CHOICE, false),
            Wanted::AsSet => (0.0, false),
            Wanted::Time { .. } => (OF_TIME, false),
            Wanted::Error { .. } => (OF_ERROR, true),
        };
        Stages { plan, denoises: goal.denoises(), verifies: goal.verify.is_some() && !measures }
    }

    /// Fraction of a frame that is done, of a method whose first stage is `first`.
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
pub struct Span {
    /// Start of the run.
    start: Instant,
    /// Fractions of the run at which the part begins and ends.
    fractions: [f64; 2],
}

impl Span {
    /// All of a run that begins now.
    pub fn whole() -> Span {
        Span { start: Instant::now(), fractions: [0.0, 1.0] }
    }

    /// One of so many equal parts of it.
    pub fn part(self, index: usize, count: usize) -> Span {
        let [from, to] = self.fractions;
        let at = |index: usize| from + (to - from) * index as f64 / count.max(1) as f64;
        Span { fractions: [at(index), at(index + 1)], ..self }
    }
}

/// Part of a run, and its progress.
#[derive(Debug)]
pub struct Course {
    span: Span,
    stages: Stages,
    /// Frames in the part, and those that are done.
    frames: usize,
    done: usize,
    /// First stage of the frame at hand, after plans.
    first: Option<Stage>,
    /// Fraction of the run told last.
    fraction: f64,
}

impl Course {
    /// A part of a run with a number of frames, each of these stages.
    pub fn new(frames: usize, stages: Stages, span: Span) -> Course {
        Course { span, stages, frames, done: 0, first: None, fraction: span.fractions[0] }
    }

    /// Counts the frame at hand as done.
    pub fn frame_done(&mut self) {
        self.done += 1;
        self.first = None;
    }

    /// Frames done and all frames of the part.
    pub fn frames(&self) -> [usize; 2] {
        [self.done, self.frames]
    }

    /// Fraction of the run that is done; it never falls.
    pub fn fraction(&mut self, now: Option<&Progress>) -> f64 {
        let in_frame = now.map_or(0.0, |now| self.in_frame(now));
        let in_part = (self.done as f64 + in_frame) / self.frames.max(1) as f64;
        let [from, to] = self.span.fractions;
        // The end is told exactly.
        let fraction = if in_part < 1.0 { from + in_part * (to - from) } else { to };
        self.fraction = self.fraction.max(fraction);
        self.fraction
    }

    /// Seconds that the rest will take, at the pace so far; `None` as long as there is none.
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

    fn at(stage: Stage, done: u64) -> Progress {
        Progress { stage, is_planning: false, done, total: 10 }
    }

    const ALL: Stages = Stages { plan: 0.0, denoises: true, verifies: true };

    #[test]
    fn fractions_rise_through_stages_and_frames_to_the_end_of_their_span() {
        let mut course = Course::new(2, ALL, Span::whole().part(2, 3));
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
        let mut course = Course::new(1, Stages::of(&goal), Span::whole());
        assert_eq!((course.fraction(None), course.eta_seconds()), (0.0, None));
        let half = 0.5 * (1.0 - END);
        assert!((course.fraction(Some(&at(Stage::Render, 5))) - half).abs() < 1e-9);
        assert!((course.fraction(Some(&at(Stage::Render, 1))) - half).abs() < 1e-9);
        assert!((course.fraction(Some(&at(Stage::Render, 10))) - 2.0 * half).abs() < 1e-9);
        assert!(course.eta_seconds().is_some());
    }

    #[test]
    fn plans_and_measurements_have_their_shares() {
        let verify = Some(render::verify::Settings::default());
        let choice = Stages::of(&Goal { may_choose: true, verify, ..Goal::default() });
        let mut course = Course::new(1, choice, Span::whole());
        assert_eq!(course.fraction(Some(&Progress { is_planning: true, ..at(Stage::Verify, 9) })), 0.0);
        assert!(course.fraction(Some(&at(Stage::Render, 0))) >= OF_CHOICE);
        assert!(course.fraction(Some(&at(Stage::Render, 10))) < 0.5);
        assert!(course.fraction(Some(&at(Stage::Verify, 5))) < 0.9);
        let searched = Wanted::Error { error: 0.1, max_samples: 1, held: Vec::new() };
        let mut course =
            Course::new(1, Stages::of(&Goal { wanted: searched, ..Goal::default() }), Span::whole());
        assert_eq!(course.fraction(Some(&Progress { is_planning: true, ..at(Stage::Render, 9) })), 0.0);
        course.frame_done();
        assert_eq!(course.fraction(None), 1.0);
    }
}
