//! Progress messages on stderr, from a thread of its own that reads the method's [`Control`].

use super::course::Course;
use super::talk;
use super::values::ProgressMode;
use base::progress::{Control, Progress};
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
    /// The frame is done if `is_done` says so of the result.
    pub fn frame<R>(
        &mut self,
        number: Option<usize>,
        control: &Control,
        work: impl FnOnce() -> R,
        is_done: impl FnOnce(&R) -> bool,
    ) -> R {
        control.begin_frame();
        let bar = std::io::stderr().is_terminal();
        let [done, frames] = self.course.frames();
        let course = &mut self.course;
        let result = match self.mode {
            ProgressMode::None => work(),
            ProgressMode::Auto if !bar => work(),
            ProgressMode::Auto => beside(work, |stop| show_bar(control, stop)),
            ProgressMode::Ndjson => beside(work, |stop| {
                while goes_on(&stop, LINE_INTERVAL) {
                    write_events(control, number, |now| told(course, Some(now)));
                }
            }),
            ProgressMode::Openjd => beside(work, |stop| {
                while goes_on(&stop, AGENT_INTERVAL) {
                    write_for_agents(control, (done, frames), |now| course.fraction(Some(now)));
                }
            }),
        };
        if is_done(&result) {
            self.course.frame_done();
        }
        // The fraction of a frame that is not done stays as it was told last.
        match self.mode {
            ProgressMode::Ndjson => write_events(control, number, |_| told(&mut self.course, None)),
            ProgressMode::Openjd => {
                write_for_agents(control, (done, frames), |_| self.course.fraction(None));
            }
            ProgressMode::Auto | ProgressMode::None => {}
        }
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
    let known = style("{msg:<10} [{bar:40}] {percent:>3} %  {elapsed_precise}  (ends in {eta})");
    let unknown = style("{msg:<10} {spinner} {pos}  {elapsed_precise}");
    // Whatever is set draws the bar anew, by the style that it has then.
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(unknown.clone());
    let mut stage = None;
    while goes_on(&stop, BAR_INTERVAL) {
        let Some(progress) = control.progress() else { continue };
        if stage != Some((progress.stage, progress.is_planning)) {
            bar.set_style(if progress.total > 0 { known.clone() } else { unknown.clone() });
            bar.set_message(progress.displayed_stage().name());
            bar.set_length(progress.total);
            bar.reset();
            if stage.is_none() {
                bar.set_draw_target(ProgressDrawTarget::stderr());
            }
            stage = Some((progress.stage, progress.is_planning));
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

/// Fraction of the run that is done, and the seconds that the rest will take; at the end of a frame, there is no `now`.
fn told(course: &mut Course, now: Option<&Progress>) -> (f64, Option<f64>) {
    (course.fraction(now), course.eta_seconds())
}

/// Writes the stages begun since the last time, and the progress if there is any.
fn write_events(
    control: &Control,
    number: Option<usize>,
    told: impl FnOnce(&Progress) -> (f64, Option<f64>),
) {
    let (begun, now) = control.news();
    for stage in begun {
        talk::event("stage", || with_frame(number, json!({ "stage": stage, "seconds": talk::seconds() })));
    }
    let Some(now) = now else { return };
    talk::event("progress", || {
        let (fraction, eta_seconds) = told(&now);
        let fields = json!({
            "stage": now.displayed_stage(),
            "done": now.done,
            "total": now.total,
            "fraction": fraction,
            "eta_seconds": eta_seconds,
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

/// Writes the percentage and the stage at hand, as Open Job Description's sessions read them, of the frame at `place`
/// among `frames`.
fn write_for_agents(
    control: &Control,
    (place, frames): (usize, usize),
    fraction: impl FnOnce(&Progress) -> f64,
) {
    if let (_, Some(now)) = control.news() {
        talk::line(&format!("openjd_progress: {:.2}", 100.0 * fraction(&now)));
        let stage = now.displayed_stage().name();
        talk::line(&format!("openjd_status: picture {} of {frames}: {stage}", place + 1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::course::{Span, Stages};

    #[test]
    fn the_watcher_ends_with_the_work_and_the_result_comes_through() {
        let control = Control::new();
        for mode in [ProgressMode::None, ProgressMode::Auto, ProgressMode::Ndjson, ProgressMode::Openjd] {
            let mut watch = Watch::new(mode, Course::new(2, Stages::default(), Span::whole()));
            assert_eq!(watch.frame(None, &control, || 7, |result| *result == 7), 7);
            assert_eq!(watch.frame(None, &control, || 8, |result| *result == 7), 8);
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
