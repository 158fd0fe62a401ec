//! Progress messages on stderr. A thread of their own reads the [`Control`] of the method.

use super::beside::{beside, goes_on};
use super::course::RunProgress;
use super::talk;
use super::values::{Loudness, ProgressMode};
use base::progress::{Control, Progress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::io::IsTerminal;
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// Interval between updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Number of steps of the bar.
const STEPS: u64 = 1000;
/// Seconds between lines off a terminal: the minimum, and the maximum if nothing changes.
const LINES: [f64; 2] = [3.0, 30.0];
/// Interval between events.
const LINE_INTERVAL: Duration = Duration::from_millis(500);
/// Interval between lines for agents, which log every line.
const AGENT_INTERVAL: Duration = Duration::from_secs(2);

/// Reporter of the progress of frames.
pub struct Watch {
    mode: ProgressMode,
    run: RunProgress,
}

impl Watch {
    /// Builds the reporter of a part of a run.
    pub fn new(mode: ProgressMode, run: RunProgress) -> Watch {
        Watch { mode, run }
    }

    /// Runs `work`, which renders a frame, while another thread reports its progress.
    ///
    /// The frame counts as complete if `is_done` accepts the result.
    pub fn frame<R>(
        &mut self,
        number: Option<usize>,
        control: &Control,
        work: impl FnOnce() -> R,
        is_done: impl FnOnce(&R) -> bool,
    ) -> R {
        control.begin_frame();
        let bar = std::io::stderr().is_terminal();
        let [done, frames] = self.run.frames();
        let place = format!("image {} of {frames}", done + 1);
        let run = &mut self.run;
        let result = match self.mode {
            ProgressMode::None => work(),
            ProgressMode::Auto => match (talk::loudness(), bar) {
                (Loudness::Quiet, _) => work(),
                (Loudness::Verbose, _) => beside(work, |stop| {
                    while goes_on(&stop, BAR_INTERVAL) {
                        write_stages(control);
                    }
                    write_stages(control);
                }),
                (Loudness::Normal, false) => beside(work, |stop| write_lines(control, run, stop)),
                (Loudness::Normal, true) => beside(work, |stop| show_bar(control, run, stop)),
            },
            ProgressMode::Ndjson => beside(work, |stop| {
                while goes_on(&stop, LINE_INTERVAL) {
                    write_events(control, number, |now| fraction_and_eta(run, Some(now)));
                }
            }),
            ProgressMode::Openjd => beside(work, |stop| {
                while goes_on(&stop, AGENT_INTERVAL) {
                    write_for_agents(control, &place, |now| run.fraction(Some(now)));
                }
            }),
        };
        if is_done(&result) {
            self.run.frame_done();
        }
        // The fraction of a frame that is not complete stays at its last value.
        match self.mode {
            ProgressMode::Ndjson => write_events(control, number, |_| fraction_and_eta(&mut self.run, None)),
            ProgressMode::Openjd => {
                write_for_agents(control, &place, |_| self.run.fraction(None));
            }
            ProgressMode::Auto | ProgressMode::None => {}
        }
        result
    }
}

/// Shows one progress bar of the whole run until the work ends.
fn show_bar(control: &Control, run: &mut RunProgress, stop: Receiver<()>) {
    let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden());
    let bar = bar.with_style(style("{prefix:>6} [{bar:40}] {percent:>3} %  {wide_msg}"));
    while goes_on(&stop, BAR_INTERVAL) {
        let Some(progress) = control.progress() else { continue };
        let fraction = run.fraction(Some(&progress));
        bar.set_position((fraction * STEPS as f64) as u64);
        bar.set_prefix(format!("{:.0} s", talk::seconds()));
        bar.set_message(stage_and_rest(&progress, run));
        if bar.is_hidden() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.tick();
    }
    bar.finish_and_clear();
}

/// Returns the stage, and the expected time until the end if it is known.
fn stage_and_rest(progress: &Progress, run: &RunProgress) -> String {
    let stage = progress.displayed_stage().name();
    match run.eta_seconds() {
        Some(seconds) if seconds >= 1.0 => format!("{stage}, about {seconds:.0} s left"),
        _ => stage.to_owned(),
    }
}

/// Writes a line now and then until the work ends: after a tenth of the run, or after a time.
fn write_lines(control: &Control, run: &mut RunProgress, stop: Receiver<()>) {
    let (mut said, mut at) = (0.0, talk::seconds());
    while goes_on(&stop, BAR_INTERVAL) {
        let Some(progress) = control.progress() else { continue };
        let (fraction, now) = (run.fraction(Some(&progress)), talk::seconds());
        let (is_tenth, waited) = (fraction >= said + 0.1, now - at);
        if waited >= LINES[1] || is_tenth && waited >= LINES[0] {
            let percent = (100.0 * fraction) as u32;
            talk::line(&format!("{percent:>3} %, {now:.0} s: {}", stage_and_rest(&progress, run)));
            (said, at) = (fraction, now);
        }
    }
}

/// Writes a line for each stage that began since the last call.
fn write_stages(control: &Control) {
    let (begun, _) = control.news();
    for stage in begun {
        talk::line(&format!("{:>8.2} s: {}", talk::seconds(), stage.name()));
    }
}

fn style(template: &str) -> ProgressStyle {
    // The templates are constants. The default bar replaces a wrong one.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Returns the fraction of the run that is done, and the expected seconds until its end. `now` is `None` at the end of
/// a frame.
fn fraction_and_eta(run: &mut RunProgress, now: Option<&Progress>) -> (f64, Option<f64>) {
    (run.fraction(now), run.eta_seconds())
}

/// Writes events of the stages that began since the last call, and of the progress if there is any.
fn write_events(
    control: &Control,
    number: Option<usize>,
    fraction_and_eta: impl FnOnce(&Progress) -> (f64, Option<f64>),
) {
    let (begun, now) = control.news();
    for stage in begun {
        talk::event("stage", || with_frame(number, json!({ "stage": stage, "seconds": talk::seconds() })));
    }
    let Some(now) = now else { return };
    talk::event("progress", || {
        let (fraction, eta_seconds) = fraction_and_eta(&now);
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

/// Writes the percentage, the place and the stage for sessions of Open Job Description.
fn write_for_agents(control: &Control, place: &str, fraction: impl FnOnce(&Progress) -> f64) {
    if let (_, Some(now)) = control.news() {
        talk::line(&format!("openjd_progress: {:.2}", 100.0 * fraction(&now)));
        let stage = now.displayed_stage().name();
        talk::line(&format!("openjd_status: {place}: {stage}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::course::{RunSpan, Stages};

    #[test]
    fn the_watcher_ends_with_the_work_and_the_result_comes_through() {
        let control = Control::new();
        for mode in [ProgressMode::None, ProgressMode::Auto, ProgressMode::Ndjson, ProgressMode::Openjd] {
            let mut watch = Watch::new(mode, RunProgress::new(2, Stages::default(), RunSpan::begin()));
            assert_eq!(watch.frame(None, &control, || 7, |result| *result == 7), 7);
            assert_eq!(watch.frame(None, &control, || 8, |result| *result == 7), 8);
            assert_eq!(watch.run.frames(), [1, 2]);
        }
    }
}
