//! Progress and cancellation of a running method, from another thread.
//!
//! A method calls [`Control::begin`] when a stage starts, [`Control::advance`] as it goes, and between units
//! of work (a tile, a batch of photon paths) asks [`Control::is_cancelled`]; once that is true it returns its
//! partial result, marked incomplete. Nothing here influences the picture.

use crate::stats::Stage;
use std::mem;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// State shared between the thread that renders and those that watch it.
#[derive(Debug, Default)]
pub struct Control {
    cancelled: AtomicBool,
    /// Stage and total; `done` is reset under this lock, so a snapshot never mixes two stages.
    stage: Mutex<Begun>,
    done: AtomicU64,
}

#[derive(Debug, Default)]
struct Begun {
    /// The current stage, and its total.
    current: Option<(Stage, u64)>,
    /// True while settings are planned.
    is_planning: bool,
    /// Stages of the frame that [`Control::news`] has returned, or is to return.
    told: Vec<Stage>,
    news: Vec<Stage>,
}

impl Begun {
    /// Each stage of a frame is news once.
    fn tell(&mut self, stage: Stage) {
        if !self.told.contains(&stage) {
            self.told.push(stage);
            self.news.push(stage);
        }
    }
}

/// A snapshot of a method's progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The current stage.
    pub stage: Stage,
    /// True if it is a part of planning settings.
    pub is_planning: bool,
    /// Units of work done in this stage, at most `total`.
    pub done: u64,
    /// Units of work in this stage; 0 if not known.
    pub total: u64,
}

impl Progress {
    /// The stage that people are told: planning, or the current one.
    pub fn told(&self) -> Stage {
        if self.is_planning { Stage::Plan } else { self.stage }
    }
}

impl Control {
    /// Creates a control: not cancelled, no stage begun.
    pub fn new() -> Control {
        Control::default()
    }

    /// Asks the method to stop soon. Safe to call from a signal-handling thread, any number of times.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// True if the method should return its partial result.
    #[inline]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Forgets the stages of the frame before.
    pub fn begin_frame(&self) {
        *self.lock() = Begun::default();
    }

    /// Starts a stage of `total` units (0 if their number is not known). Stages follow one another.
    pub fn begin(&self, stage: Stage, total: u64) {
        let mut begun = self.lock();
        self.done.store(0, Ordering::Relaxed);
        begun.current = Some((stage, total));
        if !begun.is_planning {
            begun.tell(stage);
        }
    }

    /// Does `work`, whose stages are parts of planning settings and not of the picture.
    pub fn plan<R>(&self, work: impl FnOnce() -> R) -> R {
        self.begin(Stage::Plan, 0);
        self.lock().is_planning = true;
        let result = work();
        let mut begun = self.lock();
        (begun.is_planning, begun.current) = (false, Some((Stage::Plan, 0)));
        result
    }

    /// Counts `n` more finished units of the current stage. Callable from any worker.
    #[inline]
    pub fn advance(&self, n: u64) {
        self.done.fetch_add(n, Ordering::Relaxed);
    }

    /// Returns the progress; `None` before the first stage.
    pub fn progress(&self) -> Option<Progress> {
        self.progress_of(&self.lock())
    }

    /// Returns the stages of the frame that began since the last call, each once, and the progress.
    pub fn news(&self) -> (Vec<Stage>, Option<Progress>) {
        let mut begun = self.lock();
        (mem::take(&mut begun.news), self.progress_of(&begun))
    }

    fn progress_of(&self, begun: &Begun) -> Option<Progress> {
        let (stage, total) = begun.current?;
        let done = self.done.load(Ordering::Relaxed);
        let done = if total > 0 { done.min(total) } else { done };
        Some(Progress { stage, is_planning: begun.is_planning, done, total })
    }

    fn lock(&self) -> MutexGuard<'_, Begun> {
        // The data is plain: a panic elsewhere cannot have left it half-written.
        self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_restarts_with_each_stage_and_never_passes_the_total() {
        let control = Control::new();
        assert_eq!(control.progress(), None);
        control.begin(Stage::LightPass, 10);
        control.advance(25);
        let all = Progress { stage: Stage::LightPass, is_planning: false, done: 10, total: 10 };
        assert_eq!(control.progress(), Some(all));
        control.begin(Stage::Render, 0);
        control.advance(3);
        let now = Some(Progress { stage: Stage::Render, done: 3, total: 0, ..all });
        assert_eq!(control.progress(), now);
        assert_eq!(control.news(), (vec![Stage::LightPass, Stage::Render], now));
        assert_eq!(control.news(), (vec![], now));
        control.begin(Stage::LightPass, 0);
        assert_eq!(control.news().0, []);
        control.begin_frame();
        assert_eq!(control.news(), (vec![], None));
    }

    #[test]
    fn stages_of_plans_are_told_as_planning() {
        let control = Control::new();
        let planned = control.plan(|| {
            control.begin(Stage::Render, 5);
            control.news()
        });
        let now = Progress { stage: Stage::Render, is_planning: true, done: 0, total: 5 };
        assert_eq!(planned, (vec![Stage::Plan], Some(now)));
        control.begin(Stage::Render, 5);
        assert_eq!(control.news(), (vec![Stage::Render], Some(Progress { is_planning: false, ..now })));
    }

    #[test]
    fn workers_advance_together_and_cancellation_reaches_them() {
        let control = Control::new();
        control.begin(Stage::Render, 4000);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..1000).for_each(|_| control.advance(1)));
            }
        });
        assert_eq!(control.progress().unwrap().done, 4000);
        assert!(!control.is_cancelled());
        std::thread::scope(|scope| drop(scope.spawn(|| control.cancel())));
        assert!(control.is_cancelled());
    }
}
