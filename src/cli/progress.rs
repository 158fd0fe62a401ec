//! Progress messages on stderr, from a thread of its own that reads the method's [`Control`].

use super::talk;
use super::values::ProgressMode;
use crate::progress::{Control, Progress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Interval between updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);
/// Interval between lines.
const LINE_INTERVAL: Duration = Duration::from_millis(500);

/// Runs `work` while another thread tells of its progress; all is told when this returns.
pub fn watched<R>(mode: ProgressMode, control: &Control, work: impl FnOnce() -> R) -> R {
    let bar = std::io::stderr().is_terminal();
    match mode {
        ProgressMode::None => work(),
        ProgressMode::Auto if !bar => work(),
        ProgressMode::Auto => beside(work, |stop| show_bar(control, stop)),
        ProgressMode::Ndjson => beside(work, |stop| write_lines(control, stop)),
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

fn write_lines(control: &Control, stop: Receiver<()>) {
    let start = Instant::now();
    let mut told: Option<Progress> = None;
    let mut tell = || {
        let now = control.progress();
        if let Some(progress) = now.filter(|_| now != told) {
            told = now;
            talk::event(&json!({
                "event": "progress",
                "stage": progress.stage,
                "done": progress.done,
                "total": progress.total,
                "seconds": start.elapsed().as_secs_f64(),
            }));
        }
    };
    while goes_on(&stop, LINE_INTERVAL) {
        tell();
    }
    tell();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_watcher_ends_with_the_work_and_the_result_comes_through() {
        let control = Control::new();
        for mode in [ProgressMode::None, ProgressMode::Auto, ProgressMode::Ndjson] {
            assert_eq!(watched(mode, &control, || 7), 7);
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
