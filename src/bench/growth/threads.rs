//! Time of an image over the number of threads, and how busy each stage keeps them.
//!
//! A stage is busy for the share cpu / (threads · wall). A serial share `s` of the work limits the speed-up `S` of `n`
//! threads to 1 / (s + (1 - s) / n) (Amdahl's law), so s = (1 / S - 1 / n) / (1 - 1 / n).

use crate::Results;
use crate::document::Grid;
use crate::study::{Candidate, Study, StudyError, figure, seconds};
use base::stats::{Stage, StageTime, Stats};
use rayon::ThreadPoolBuilder;
use render::method::Method;
use serde_json::json;
use std::path::Path;

/// Minimum share of the processor's time with which a stage is listed.
const LISTED: f64 = 0.01;

/// An image by some threads.
struct Run {
    threads: usize,
    stats: Stats,
    /// Sum over all stages.
    whole: StageTime,
}

/// Returns 1, 2, 4 and so on, and the maximum.
fn numbers(most: usize) -> Vec<usize> {
    let mut numbers: Vec<usize> = (0..).map(|i| 1 << i).take_while(|n| *n < most).collect();
    numbers.push(most.max(1));
    numbers
}

/// Returns the serial share of the work by Amdahl's law; `None` for one thread.
fn serial_share(speed_up: f64, threads: usize) -> Option<f64> {
    let n = threads as f64;
    (threads > 1).then(|| (1.0 / speed_up - 1.0 / n) / (1.0 - 1.0 / n))
}

/// Renders the default image of a scene by more and more threads, and adds tables.
pub(super) fn measure(study: &Study, file: &Path, results: &mut Results) -> Result<(), StudyError> {
    let subject = study.subject(file)?;
    let candidate = Candidate::new("default", Method::default());
    let mut runs = Vec::new();
    for threads in numbers(study.plan.threads) {
        (study.say)(&format!("{}, threads: {threads}", subject.name));
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| {
            StudyError::Render(format!("cannot start {threads} threads; try fewer with --threads: {error}"))
        })?;
        let mut fastest: Option<Run> = None;
        for _ in 0..study.plan.repeats.max(1) {
            let stats = pool.install(|| study.render_once(&subject, &candidate))?.stats;
            let mut whole = StageTime::default();
            stats.stages().for_each(|(_, time)| whole += time);
            if fastest.as_ref().is_none_or(|run| whole.wall_seconds < run.whole.wall_seconds) {
                fastest = Some(Run { threads, stats, whole });
            }
        }
        runs.extend(fastest);
    }
    add(results, &subject.name, &runs);
    Ok(())
}

/// Adds the figures of a scene.
fn add(results: &mut Results, scene: &str, runs: &[Run]) {
    let (Some(first), Some(last)) = (runs.first(), runs.last()) else { return };
    let speed_up = |run: &Run| first.whole.wall_seconds / run.whole.wall_seconds.max(f64::MIN_POSITIVE);
    results.document.heading(2, &format!("Threads of {scene}"));
    let heads = ["threads", "wall", "processor", "speed-up", "busy %", "serial %"];
    let mut rows = Vec::new();
    for run in runs {
        let share = serial_share(speed_up(run), run.threads);
        let StageTime { wall_seconds, cpu_seconds } = run.whole;
        let busy = run.whole.busy(run.threads);
        rows.push(vec![
            run.threads.to_string(),
            seconds(wall_seconds),
            seconds(cpu_seconds),
            figure(speed_up(run)),
            figure(100.0 * busy),
            share.map_or("-".to_owned(), |share| figure(100.0 * share)),
        ]);
        let figures = json!({
            "threads": run.threads, "wall_seconds": wall_seconds, "cpu_seconds": cpu_seconds,
            "speed_up": speed_up(run), "busy": busy, "serial_share": share,
        });
        results.push("threads", json!({ "scene": scene }), figures);
    }
    results.document.grid(&Grid::new(0, &heads, rows));
    results.document.grid(&stages(last));
}

/// Returns a table of the stages of an image.
fn stages(run: &Run) -> Grid {
    let share = |time: &StageTime| time.cpu_seconds / run.whole.cpu_seconds.max(f64::MIN_POSITIVE);
    let row = |(stage, time): (Stage, StageTime)| {
        let percent = [share(&time), time.busy(run.threads)].map(|share| figure(100.0 * share));
        let times = [time.wall_seconds, time.cpu_seconds].map(seconds);
        [stage.name().to_owned()].into_iter().chain(times).chain(percent).collect()
    };
    let heads = [&format!("stage, {} threads", run.threads), "wall", "processor", "of all %", "busy %"];
    let listed = run.stats.stages().filter(|(_, time)| share(time) >= LISTED);
    Grid::new(1, &heads, listed.map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_threads_double_up_to_the_maximum() {
        assert_eq!(numbers(0), [1]);
        assert_eq!(numbers(1), [1]);
        assert_eq!(numbers(2), [1, 2]);
        assert_eq!(numbers(6), [1, 2, 4, 6]);
        assert_eq!(numbers(16), [1, 2, 4, 8, 16]);
    }

    #[test]
    fn the_serial_share_is_what_amdahls_law_leaves() {
        for (share, threads) in [(0.0, 2), (0.1, 2), (0.05, 16), (1.0, 4)] {
            let speed_up = 1.0 / (share + (1.0 - share) / threads as f64);
            let found = serial_share(speed_up, threads).unwrap();
            assert!((found - share).abs() < 1e-12, "{share} {threads}: {found}");
        }
        assert_eq!(serial_share(1.0, 1), None);
    }
}
