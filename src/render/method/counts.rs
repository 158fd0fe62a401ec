//! Counts of the stages, under the names that methods share.

use base::stats::Stats;
use transport::bias_compensation::points::CompensationCounts;
use transport::eye::{DROPPED_BRANCHES, EyeCounts};
use transport::lightcut::CutCounts;

/// Of eye rays and the specular chains behind them.
pub fn eye(stats: &mut Stats, counts: &EyeCounts) {
    stats.count("Rays/closest hit", counts.rays);
    stats.count("Eye/shadow rays", counts.shadow_rays);
    stats.count(DROPPED_BRANCHES, counts.overflow);
    if counts.extra_samples > 0 {
        stats.count("Eye/extra samples", counts.extra_samples);
    }
}

/// Of lightcuts, in a group of counters.
pub fn cuts(stats: &mut Stats, group: &str, counts: &CutCounts) {
    stats.count(&format!("{group}/shadow rays"), counts.rays);
    stats.count(&format!("{group}/cuts"), counts.cuts);
    stats.count(&format!("{group}/clusters"), counts.clusters);
    stats.count(&format!("{group}/capped"), counts.capped);
    stats.count(&format!("{group}/bounds"), counts.bounds);
    stats.count(&format!("{group}/clamped VPLs"), counts.clamped);
    stats.add(&format!("{group}/mean cut"), counts.clusters as f64 / counts.cuts.max(1) as f64);
}

/// Reports the counts of clamping in eye samples' cuts, and of its compensation.
pub fn clamping(stats: &mut Stats, cuts: &CutCounts, near: Option<&CompensationCounts>) {
    let percent = 100.0 / if cuts.luminance > 0.0 { cuts.luminance } else { 1.0 };
    stats.add("Lightcut/light lost to clamping [%]", percent * cuts.lost);
    if let Some(near) = near {
        stats.add("Lightcut/light found again by short rays [%]", percent * near.found);
        stats.count("Compensation/short rays", near.rays);
        self::cuts(stats, "Compensation", &near.cuts);
    }
}
