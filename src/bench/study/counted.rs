//! Statistics of an image in the form in which they are stored. All counters that studies read are read here.

use base::stats::{Counter, Stage, Stats};
use render::cost::Work;
use serde::{Deserialize, Serialize};

/// Counters and times of stages.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct Counted {
    /// Processor seconds and elapsed seconds of the stages in [`Stage::ALL`]; `None` for stages that did not run.
    pub times: [Option<[f64; 2]>; Stage::ALL.len()],
    /// Numbers of records, direct and indirect.
    pub records: Option<[f64; 2]>,
    /// Number of records that a frame of a walk-through adds.
    pub new_records: f64,
    /// Mean number of clusters in a cut of indirect records, or of rays of their gathering; without records, of
    /// clusters in cuts of eye samples.
    pub cut: Option<f64>,
    /// Work of the image; none for a walk-through.
    pub work: Work,
    /// Closest-hit rays and shadow rays of the eye pass.
    pub eye_rays: f64,
}

impl Counted {
    /// Takes the statistics of a render.
    pub fn new(stats: &Stats) -> Counted {
        let counter = |name: &str| match stats.get(name)? {
            Counter::Count(n) => Some(n as f64),
            Counter::Sum(x) => Some(x),
            Counter::Distribution(_) => None,
        };
        let [direct, indirect] = ["Cache/records, direct", "Cache/records, indirect"].map(counter);
        let records = direct.zip(indirect).map(|(direct, indirect)| [direct, indirect]);
        let cut = if records.is_some() { "Cache/cut or rays, indirect" } else { "Lightcut/mean cut" };
        Counted {
            times: Stage::ALL
                .map(|stage| stats.stage(stage).map(|time| [time.cpu_seconds, time.wall_seconds])),
            records,
            new_records: counter("Walk/new records").unwrap_or(0.0),
            cut: counter(cut),
            work: Work::default(),
            eye_rays: ["Eye/closest-hit rays", "Eye/shadow rays"].into_iter().filter_map(counter).sum(),
        }
    }

    /// Returns the processor seconds of some stages.
    pub fn seconds(&self, stages: &[Stage]) -> f64 {
        let times = Stage::ALL.iter().zip(&self.times).filter(|(stage, _)| stages.contains(stage));
        times.filter_map(|(_, time)| *time).map(|[cpu, _]| cpu).fold(0.0, |sum, time| sum + time)
    }

    /// Returns the elapsed seconds of all stages.
    pub fn elapsed(&self) -> f64 {
        self.times.iter().flatten().map(|[_, wall]| wall).fold(0.0, |sum, time| sum + time)
    }

    /// Returns true if the image was denoised.
    pub fn denoised(&self) -> bool {
        Stage::ALL.iter().zip(&self.times).any(|(stage, time)| *stage == Stage::Denoise && time.is_some())
    }

    /// Replaces times and records by means over the frames of a walk-through.
    pub fn average(&mut self, frames: &[Counted]) {
        let share = 1.0 / frames.len() as f64;
        for (i, mean) in self.times.iter_mut().enumerate() {
            let sum =
                frames.iter().filter_map(|frame| frame.times[i]).reduce(|[a, b], [c, d]| [a + c, b + d]);
            *mean = sum.map(|sum| sum.map(|time| time * share));
        }
        self.records = Some([0.0, frames.iter().map(|frame| frame.new_records).sum::<f64>() * share]);
    }
}
