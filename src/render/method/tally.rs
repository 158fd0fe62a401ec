//! Counts of an image in the making: counters by name for reports, and work by type for later stages.

use crate::cost::Work;
use base::stats::{Stage, Stats};
use transport::bias_compensation::points::CompensationCounts;
use transport::eye::{DROPPED_BRANCHES, EyeCounts};
use transport::lightcut::CutCounts;

/// Counters, times and work of an image.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Counters and times, for reports.
    pub stats: Stats,
    /// Work so far.
    pub work: Work,
}

impl Tally {
    /// Runs `work` and adds its time to `stage`.
    pub fn time<R>(&mut self, stage: Stage, work: impl FnOnce() -> R) -> R {
        self.stats.time(stage, work)
    }

    /// Adds `n` to the integer counter `name`.
    pub fn count(&mut self, name: &str, n: u64) {
        self.stats.count(name, n);
    }

    /// Adds closest-hit rays.
    pub fn rays(&mut self, rays: u64) {
        self.work.rays += rays;
        self.stats.count("Rays/closest hit", rays);
    }

    /// Adds shadow rays to a group of counters.
    pub fn shadow_rays(&mut self, name: &str, rays: u64) {
        self.work.shadow_rays += rays;
        self.stats.count(name, rays);
    }

    /// Adds the counts of eye rays and of the specular chains behind them.
    pub fn eye(&mut self, counts: &EyeCounts) {
        self.rays(counts.rays);
        self.stats.count("Eye/closest-hit rays", counts.rays);
        self.shadow_rays("Eye/shadow rays", counts.shadow_rays);
        self.work.dropped_branches += counts.overflow;
        self.stats.count(DROPPED_BRANCHES, counts.overflow);
        self.work.extra_samples += counts.extra_samples;
        if counts.extra_samples > 0 {
            self.stats.count("Eye/extra samples", counts.extra_samples);
        }
    }

    /// Adds the counts of lightcuts to a group of counters.
    pub fn cuts(&mut self, group: &str, counts: &CutCounts) {
        self.shadow_rays(&format!("{group}/shadow rays"), counts.rays);
        let stats = &mut self.stats;
        stats.count(&format!("{group}/cuts"), counts.cuts);
        stats.count(&format!("{group}/clusters"), counts.clusters);
        stats.count(&format!("{group}/capped"), counts.capped);
        stats.count(&format!("{group}/bounds"), counts.bounds);
        stats.count(&format!("{group}/clamped VPLs"), counts.clamped);
        stats.add(&format!("{group}/mean cut"), counts.clusters as f64 / counts.cuts.max(1) as f64);
    }

    /// Adds the share of light that clamping took from eye samples' cuts, and the counts of its compensation.
    pub fn clamping(&mut self, cuts: &CutCounts, compensation: Option<&CompensationCounts>) {
        let percent = 100.0 / if cuts.luminance > 0.0 { cuts.luminance } else { 1.0 };
        self.stats.add("Lightcut/light lost to clamping [%]", percent * cuts.lost);
        if let Some(near) = compensation {
            self.stats.add("Lightcut/light found again by short rays [%]", percent * near.found);
            self.stats.count("Compensation/short rays", near.rays);
            self.cuts("Compensation", &near.cuts);
        }
    }
}
