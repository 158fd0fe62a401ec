//! The course of a run: the part of it that is done, and how long the rest will take.
//!
//! Frames count alike. Within a frame stages count by their usual shares of the time, from the first that the method
//! has on; plans that render several pictures stand still at the end of the first.

use crate::progress::Progress;
use crate::stats::Stage;
use std::time::Instant;

/// Stages in the order in which they begin, and their usual shares of a picture's time.
const SHARES: [(Stage, f64); 6] = [
    (Stage::EyePass, 0.35),
    (Stage::LightPass, 0.05),
    (Stage::Tree, 0.1),
    (Stage::Records, 0.15),
    (Stage::Render, 0.2),
    (Stage::Denoise, 0.15),
];

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
    /// Frames in the part, and those that are done.
    frames: usize,
    done: usize,
    /// First stage of the frame at hand.
    first: Option<Stage>,
    /// Fraction of the run told last.
    fraction: f64,
}

impl Course {
    /// A part of a run with a number of frames.
    pub fn new(frames: usize, span: Span) -> Course {
        Course { span, frames, done: 0, first: None, fraction: span.fractions[0] }
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
        self.fraction = self.fraction.max(from + in_part.min(1.0) * (to - from));
        self.fraction
    }

    /// Seconds that the rest will take, at the pace so far; `None` as long as there is none.
    pub fn eta_seconds(&self) -> Option<f64> {
        (self.fraction > 0.0)
            .then(|| self.span.start.elapsed().as_secs_f64() * (1.0 - self.fraction) / self.fraction)
    }

    fn in_frame(&mut self, now: &Progress) -> f64 {
        let place = |stage: Stage| SHARES.iter().position(|(known, _)| *known == stage);
        let first = place(*self.first.get_or_insert(now.stage)).unwrap_or(0);
        // Stages without a share come after all others.
        let Some(at) = place(now.stage) else { return 1.0 };
        let sum = |stages: &[(Stage, f64)]| stages.iter().map(|(_, share)| share).sum::<f64>();
        let part = if now.total > 0 { now.done as f64 / now.total as f64 } else { 0.0 };
        let before = SHARES.get(first..at).map_or(0.0, sum);
        (before + part * SHARES[at].1) / sum(&SHARES[first..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(stage: Stage, done: u64) -> Progress {
        Progress { stage, done, total: 10 }
    }

    #[test]
    fn fractions_rise_through_stages_and_frames_to_the_end_of_their_span() {
        let mut course = Course::new(2, Span::whole().part(1, 2));
        let mut last = course.fraction(None);
        assert_eq!(last, 0.5);
        for _ in 0..2 {
            for (stage, _) in SHARES {
                for done in [1, 5, 10] {
                    let fraction = course.fraction(Some(&at(stage, done)));
                    assert!(fraction > last && fraction <= 1.0, "{stage:?} {fraction}");
                    last = fraction;
                }
            }
            course.frame_done();
            assert!((course.fraction(None) - last).abs() < 1e-9);
        }
        assert!((last - 1.0).abs() < 1e-9 && course.frames() == [2, 2]);
    }

    #[test]
    fn methods_of_one_stage_are_half_done_in_its_middle_and_fractions_never_fall() {
        let mut course = Course::new(1, Span::whole());
        assert_eq!((course.fraction(None), course.eta_seconds()), (0.0, None));
        let share = SHARES[4].1 / (SHARES[4].1 + SHARES[5].1);
        assert!((course.fraction(Some(&at(Stage::Render, 5))) - 0.5 * share).abs() < 1e-9);
        assert!((course.fraction(Some(&at(Stage::Render, 1))) - 0.5 * share).abs() < 1e-9);
        assert!(course.eta_seconds().is_some());
        assert_eq!(course.fraction(Some(&at(Stage::Verify, 1))), 1.0);
    }
}
