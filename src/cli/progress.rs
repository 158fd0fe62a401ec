//! Progress messages on stderr, from a thread of its own that reads the method's [`Control`].

use super::course::Course;
use super::talk;
use super::values::ProgressMode;
use crate::progress::Control;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Interval between updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Interval between events.
const LINE_INTERVAL: Duration = Duration::from_millis(500);
/// Interval between lines for agents, which write each to a log.
const AGENT_INTERVAL: Duration = Duration::from_secs(2);

/// Tells of the progress of a run's frames.
pub struct Watch {
    mode: ProgressMode,
    course: Course,
}

impl Watch {
    /// A watch over the frames of a part of the run.
    pub fn new(mode: ProgressMode, course: Course) -> Watch {
        Watch { mode, course }
    }

    /// Runs `work`, which renders a frame, while another thread tells of its progress; all is told when this returns.
    pub fn frame<R>(&mut self, number: Option<usize>, control: &Control, work: impl FnOnce() -> R) -> R {
        let bar = std::io::stderr().is_terminal();
        let course = &mut self.course;
        let result = match self.mode {
            ProgressMode::None => work(),
            ProgressMode::Auto if !bar => work(),
            ProgressMode::Auto => beside(work, |stop| show_bar(control, stop)),
            ProgressMode::Ndjson => beside(work, |stop| {
                tell(stop, LINE_INTERVAL, || write_events(course, number, control));
            }),
            ProgressMode::Openjd => beside(work, |stop| {
                tell(stop, AGENT_INTERVAL, || write_for_agents(course, control));
            }),
        };
        self.course.frame_done();
        result
    }

    /// Frames done and all frames.
    pub fn frames(&self) -> [usize; 2] {
        self.course.frames()
    }
}

/// Runs `work` here and `watch` in a thread that learns of the end by its channel closing, panic or not.
fn beside<R>(work: impl FnOnce() -> R, watch: impl FnOnce(Receiver<()>) + Send) -> R {
    thread::scope(|scope| {
        let (open, stop) = channel();
        scope.spawn(|| watch(stop));
        let result = work();
        drop(open);
        result
    })
}

/// Waits; false when the work has ended.
fn goes_on(stop: &Receiver<()>, interval: Duration) -> bool {
    matches!(stop.recv_timeout(interval), Err(RecvTimeoutError::Timeout))
}

fn show_bar(control: &Control, stop: Receiver<()>) {
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
    let known = style("{msg:<10} [{bar:40}] {percent:>3} %  {elapsed_precise}  (ends in {eta})");
    let unknown = style("{msg:<10} {spinner} {pos}  {elapsed_precise}");
    let mut stage = None;
    while goes_on(&stop, BAR_INTERVAL) {
        let Some(progress) = control.progress() else { continue };
        if stage != Some(progress.stage) {
            stage = Some(progress.stage);
            bar.reset();
            bar.set_message(progress.stage.name());
            bar.set_style(if progress.total > 0 { known.clone() } else { unknown.clone() });
        }
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        bar.tick();
    }
    bar.finish_and_clear();
}

fn style(template: &str) -> ProgressStyle {
    // The templates are constants; were one wrong, the plain bar would do.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Tells at intervals, and once more when the work has ended.
fn tell(stop: Receiver<()>, interval: Duration, mut tell: impl FnMut()) {
    while goes_on(&stop, interval) {
        tell();
    }
    tell();
}

/// Writes the stages begun since the last time, and the progress if there is any.
fn write_events(course: &mut Course, number: Option<usize>, control: &Control) {
    let (begun, now) = control.news();
    for stage in begun {
        talk::event("stage", || with_frame(number, json!({ "stage": stage, "seconds": talk::seconds() })));
    }
    let Some(now) = now else { return };
    talk::event("progress", || {
        let fields = json!({
            "stage": now.stage,
            "done": now.done,
            "total": now.total,
            "fraction": course.fraction(Some(&now)),
            "eta_seconds": course.eta_seconds(),
            "seconds": talk::seconds(),
        });
        with_frame(number, fields)
    });
}

fn with_frame(number: Option<usize>, mut fields: Value) -> Value {
    if let Some(number) = number {
        fields["frame"] = number.into();
    }
    fields
}

/// Writes the percentage and the stage at hand, as Open Job Description's sessions read them.
fn write_for_agents(course: &mut Course, control: &Control) {
    if let (_, Some(now)) = control.news() {
        talk::line(&format!("openjd_progress: {:.2}", 100.0 * course.fraction(Some(&now))));
        let [done, frames] = course.frames();
        talk::line(&format!("openjd_status: picture {} of {frames}: {}", done + 1, now.stage.name()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::course::Span;

    #[test]
    fn the_watcher_ends_with_the_work_and_the_result_comes_through() {
        let control = Control::new();
        for mode in [ProgressMode::None, ProgressMode::Auto, ProgressMode::Ndjson, ProgressMode::Openjd] {
            let mut watch = Watch::new(mode, Course::new(2, Span::whole()));
            assert_eq!(watch.frame(None, &control, || 7), 7);
            assert_eq!(watch.course.frames(), [1, 2]);
        }
    }

    #[test]
    fn the_watcher_ends_when_the_work_panics() {
        let result = std::panic::catch_unwind(|| {
            beside(|| panic!("at work"), |stop| while goes_on(&stop, BAR_INTERVAL) {})
        });
        assert!(result.is_err());
    }
}
