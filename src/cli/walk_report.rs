//! Report of a walk: statistics of its frames on stdout, a summary on stderr.

use super::chart::chart;
use super::exit::Failure;
use super::picture_args::StatsFormat;
use super::talk;
use base::stats::{Counter, Stage, StageTime, Stats};
use render::session::RenderedFrame;
use serde_json::json;

/// Columns of the table of frames with their counters.
const COUNTS: [(&str, &str); 4] = [
    ("new", "Walk/new records"),
    ("kept", "Walk/records kept"),
    ("idle", "Walk/records evicted, idle"),
    ("over", "Walk/records evicted for memory"),
];
/// Columns of the table of frames with their stages.
const STAGES: [(&str, Stage); 6] = [
    ("eye", Stage::EyePass),
    ("records", Stage::Records),
    ("splat", Stage::Splat),
    ("render", Stage::Render),
    ("denoise", Stage::Denoise),
    ("total", Stage::Total),
];

/// Sums over the frames rendered so far.
#[derive(Default)]
pub struct WalkReport {
    format: Option<StatsFormat>,
    /// Word for an image: frame or view.
    noun: &'static str,
    /// Number of frames rendered.
    rendered: u64,
    /// Number of frames skipped because their files exist.
    skipped: u64,
    /// Number of skipped frames that were rendered for their records.
    repeated: u64,
    new_records: u64,
    /// Number of each frame, and the bytes of the records after it.
    bytes: Vec<(usize, u64)>,
    time: StageTime,
}

impl WalkReport {
    /// Builds a report. `format` is the format of the statistics, if there are to be any. `noun` is the word for an
    /// image.
    pub fn new(format: Option<StatsFormat>, noun: &'static str) -> WalkReport {
        WalkReport { format, noun, ..WalkReport::default() }
    }

    /// Counts a frame that is skipped.
    pub fn skip(&mut self) {
        self.skipped += 1;
    }

    /// Counts a skipped frame that is rendered for its records.
    pub fn repeat(&mut self) {
        self.repeated += 1;
    }

    /// Adds a frame and prints its statistics.
    ///
    /// # Errors
    /// If they cannot be printed.
    pub fn add(&mut self, number: usize, frame: &RenderedFrame) -> Result<(), Failure> {
        let stats = &frame.stats;
        let is_first = self.rendered == 0;
        self.rendered += 1;
        self.new_records += count(stats, "Walk/new records");
        self.bytes.push((number, count(stats, "Walk/bytes kept")));
        self.time += stats.stage(Stage::Total).unwrap_or_default();
        match self.format {
            Some(StatsFormat::Json) => {
                let mut report = stats.to_json();
                report["run"] = frame.facts.clone();
                report["frame"] = json!(number);
                talk::print(&format!("{report}\n"))
            }
            Some(StatsFormat::Text) => {
                talk::print(&format!("{}{}", header(is_first, self.noun), row(number, stats)))
            }
            None => Ok(()),
        }
    }

    /// Prints the summary.
    ///
    /// # Errors
    /// If the statistics cannot be printed.
    pub fn sum_up(&self) -> Result<(), Failure> {
        if let (Some(StatsFormat::Text), [first, .., last]) = (self.format, &self.bytes[..]) {
            let kept: Vec<f64> = self.bytes.iter().map(|(_, bytes)| mib(*bytes)).collect();
            talk::print(&chart(&format!("\nrecords kept by {} [MiB]", self.noun), [first.0, last.0], &kept))?;
        }
        talk::summary(&self.text(), || {
            json!({
                "rendered": self.rendered,
                "skipped": self.skipped,
                "repeated": self.repeated,
                "frame_seconds": self.time.wall_seconds / self.rendered.max(1) as f64,
                "frame_cpu_seconds": self.time.cpu_seconds / self.rendered.max(1) as f64,
            })
        });
        Ok(())
    }

    fn text(&self) -> String {
        let WalkReport { rendered, skipped, repeated, noun, .. } = self;
        let mut text = format!("{rendered} {noun}s rendered");
        if *skipped > 0 {
            text += &format!(", {skipped} existed already");
        }
        if *repeated > 0 {
            text += &format!(" ({repeated} rendered again for their records)");
        }
        if *rendered > 0 {
            let frames = *rendered as f64;
            text += &format!(", {:.2} s per {noun}", self.time.wall_seconds / frames);
        }
        let most = self.bytes.iter().map(|(_, bytes)| *bytes).max().unwrap_or(0);
        if most > 0 {
            let (mean, most) = (self.new_records as f64 / *rendered as f64, mib(most));
            text += &format!(", {mean:.0} new records each, at most {most:.1} MiB of records kept");
        }
        text
    }
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

fn count(stats: &Stats, name: &str) -> u64 {
    match stats.get(name) {
        Some(Counter::Count(n)) => n,
        _ => 0,
    }
}

/// Returns the head of the table, or nothing after the first frame.
fn header(is_first: bool, noun: &str) -> String {
    if !is_first {
        return String::new();
    }
    let counts: String = COUNTS.iter().map(|(name, _)| format!("{name:>9}")).collect();
    let stages: String = STAGES.iter().map(|(name, _)| format!("{name:>9}")).collect();
    format!("{:>7}{counts}{stages}  (CPU s)\n", noun)
}

/// Returns the row of a frame: counts of records, then CPU seconds.
fn row(number: usize, stats: &Stats) -> String {
    let counts: String = COUNTS.iter().map(|(_, name)| format!("{:>9}", count(stats, name))).collect();
    let seconds = |stage| stats.stage(stage).map_or(0.0, |time| time.cpu_seconds);
    let stages: String = STAGES.iter().map(|(_, stage)| format!("{:>9.3}", seconds(*stage))).collect();
    format!("{number:>7}{counts}{stages}\n")
}
