//! Progress and cancellation of a running method, seen from another thread.
//!
//! A method calls [`Control::begin`] at the start of a stage, and [`Control::advance`] during it. Between units of work
//! (a tile, a batch of photon paths) it asks [`Control::is_cancelled`]. If that is true, the method returns its partial
//! result, marked incomplete. Nothing here influences the image.

use crate::live::LiveImage;
use crate::stats::Stage;
use std::mem;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// State shared between the rendering thread and watching threads.
#[derive(Debug, Default)]
pub struct Control {
    /// Controls of images that are rendered side by side share it.
    cancelled: Arc<AtomicBool>,
    /// Stage and total. `done` is reset under this lock, so a snapshot never mixes two stages.
    stage: Mutex<ProgressState>,
    done: AtomicU64,
    /// Image that watchers see, if there are any.
    live: Mutex<Option<Arc<LiveImage>>>,
}

#[derive(Debug, Default)]
struct ProgressState {
    /// Current stage and its total.
    current: Option<(Stage, u64)>,
    /// True while settings are planned.
    is_planning: bool,
    /// Stages of the frame that [`Control::news`] has returned or will return.
    reported: Vec<Stage>,
    news: Vec<Stage>,
}

impl ProgressState {
    /// Adds a stage to the news, once per frame.
    fn report(&mut self, stage: Stage) {
        if !self.reported.contains(&stage) {
            self.reported.push(stage);
            self.news.push(stage);
        }
    }
}

/// A snapshot of a method's progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The current stage.
    pub stage: Stage,
    /// True if the stage is part of planning settings.
    pub is_planning: bool,
    /// Units of work done in this stage, at most `total`.
    pub done: u64,
    /// Total units of work in this stage; 0 if unknown.
    pub total: u64,
}

impl Progress {
    /// Returns the stage to display: planning, or the current one.
    pub fn displayed_stage(&self) -> Stage {
        if self.is_planning { Stage::Plan } else { self.stage }
    }
}

impl Control {
    /// Creates a control: not cancelled, no stage state.
    pub fn new() -> Control {
        Control::default()
    }

    /// Returns the control of one of several images that are rendered side by side. All of them are cancelled together.
    pub fn of_image(&self) -> Control {
        Control { cancelled: Arc::clone(&self.cancelled), ..Control::default() }
    }

    /// Asks the method to stop soon. May be called from a signal-handling thread, any number of times.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// True if the method should return its partial result.
    #[inline]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Sets the image that watchers see; `None` if nobody watches.
    pub fn watch(&self, live: Option<Arc<LiveImage>>) {
        *self.live.lock().unwrap_or_else(PoisonError::into_inner) = live;
    }

    /// Returns the image that watchers see, if they watch an image of this width and height.
    ///
    /// Renders of another size are trials of a plan.
    pub fn live(&self, size: [u32; 2]) -> Option<Arc<LiveImage>> {
        let live = self.live.lock().unwrap_or_else(PoisonError::into_inner);
        live.clone().filter(|live| live.size() == size)
    }

    /// Clears the stages of the previous frame.
    pub fn begin_frame(&self) {
        *self.lock() = ProgressState::default();
    }

    /// Starts a stage of `total` units; 0 if unknown. Stages are consecutive.
    pub fn begin(&self, stage: Stage, total: u64) {
        let mut state = self.lock();
        self.done.store(0, Ordering::Relaxed);
        state.current = Some((stage, total));
        if !state.is_planning {
            state.report(stage);
        }
    }

    /// Runs `work`, whose stages are part of planning settings.
    pub fn plan<R>(&self, work: impl FnOnce() -> R) -> R {
        self.begin(Stage::Plan, 0);
        self.lock().is_planning = true;
        let result = work();
        let mut state = self.lock();
        (state.is_planning, state.current) = (false, Some((Stage::Plan, 0)));
        result
    }

    /// Counts `n` more finished units of the current stage. Any worker may call it.
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
        let mut state = self.lock();
        (mem::take(&mut state.news), self.progress_of(&state))
    }

    fn progress_of(&self, state: &ProgressState) -> Option<Progress> {
        let (stage, total) = state.current?;
        let done = self.done.load(Ordering::Relaxed);
        let done = if total > 0 { done.min(total) } else { done };
        Some(Progress { stage, is_planning: state.is_planning, done, total })
    }

    fn lock(&self) -> MutexGuard<'_, ProgressState> {
        // The data is plain, so a panic in another thread cannot have left it inconsistent.
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
    fn only_images_of_the_size_that_is_watched_are_shown() {
        let control = Control::new();
        assert!(control.live([2, 1]).is_none());
        control.watch(Some(Arc::new(LiveImage::new([2, 1]))));
        assert!(control.live([2, 1]).is_some() && control.live([1, 2]).is_none());
        control.watch(None);
        assert!(control.live([2, 1]).is_none());
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
        let of_image = control.of_image();
        assert_eq!(of_image.progress(), None);
        std::thread::scope(|scope| drop(scope.spawn(|| control.cancel())));
        assert!(control.is_cancelled() && of_image.is_cancelled());
    }
}
