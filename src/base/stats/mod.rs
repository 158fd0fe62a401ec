//! Counters and stage times of a run.
//!
//! Counters are named `Group/name` (`Rays/shadow`) and declared where they are counted. The report groups them by name.
//!
//! Each worker fills its own [`Stats`], and the owner merges them in a fixed order. So the figures are the same for any
//! number of threads: integers are exact in any order, real sums only in a fixed one.
//!
//! Units: stage times are wall-clock and CPU seconds, the latter over all threads of the process.

mod contributions;
mod counter;
mod memory;
pub mod meter;
mod report;
mod stage;

use meter::{Metered, Query};
use std::collections::BTreeMap;

pub use contributions::Contributions;
pub use counter::{Counter, Observations, add_fields};
pub use memory::{available_bytes, give_back, peak_resident_bytes};
pub use stage::{Stage, StageTime, Stopwatch};

/// Counters by name and times by stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stats {
    counters: BTreeMap<String, Counter>,
    times: BTreeMap<Stage, StageTime>,
}

impl Stats {
    /// Creates empty statistics.
    pub fn new() -> Stats {
        Stats::default()
    }

    /// Adds `n` to the integer counter `name`.
    pub fn count(&mut self, name: &str, n: u64) {
        self.combine(name, Counter::Count(n));
    }

    /// Adds `value` to the real sum `name`. Deterministic only if the calls come in a fixed order.
    pub fn add(&mut self, name: &str, value: f64) {
        self.combine(name, Counter::Sum(value));
    }

    /// Adds one observation to the summary `name`, which reports count, mean, minimum and maximum.
    pub fn observe(&mut self, name: &str, value: u64) {
        self.combine(name, Counter::Distribution(Observations::one(value)));
    }

    /// Adds a summary of observations to the summary `name`.
    pub fn distribution(&mut self, name: &str, distribution: Observations) {
        self.combine(name, Counter::Distribution(distribution));
    }

    /// Adds a time to that of `stage`.
    pub fn add_time(&mut self, stage: Stage, time: StageTime) {
        *self.times.entry(stage).or_default() += time;
    }

    /// Runs `work` and adds its time to `stage`.
    pub fn time<R>(&mut self, stage: Stage, work: impl FnOnce() -> R) -> R {
        let (watch, before) = (Stopwatch::start(), meter::figures());
        let result = work();
        self.add_time(stage, watch.elapsed());
        if let (Some(before), Some(after)) = (before, meter::figures()) {
            for (kind, (before, after)) in Query::ALL.into_iter().zip(before.into_iter().zip(after)) {
                let [rays, seconds] = metered_counters(kind, stage);
                self.add(&rays, after.rays - before.rays);
                self.add(&seconds, after.seconds - before.seconds);
            }
        }
        result
    }

    /// Returns the queries of a stage that [`Stats::time`] ran while the meter was on.
    pub fn metered(&self, stage: Stage) -> [Metered; 3] {
        Query::ALL.map(|kind| {
            let [rays, seconds] = metered_counters(kind, stage).map(|name| match self.get(&name) {
                Some(Counter::Sum(figure)) => figure,
                _ => 0.0,
            });
            Metered { rays, seconds }
        })
    }

    /// Adds everything in `other`. A fixed order of merging gives the same figures on every run.
    pub fn merge(&mut self, other: &Stats) {
        for (name, counter) in &other.counters {
            self.combine(name, *counter);
        }
        for (&stage, &time) in &other.times {
            self.add_time(stage, time);
        }
    }

    /// Returns the counter `name`, if anything was counted under it.
    pub fn get(&self, name: &str) -> Option<Counter> {
        self.counters.get(name).copied()
    }

    /// Returns the time of `stage` so far, if it ran.
    pub fn stage(&self, stage: Stage) -> Option<StageTime> {
        self.times.get(&stage).copied()
    }

    /// Returns all counters, sorted by name, so that members of a group are neighbours.
    pub fn counters(&self) -> impl Iterator<Item = (&str, Counter)> {
        self.counters.iter().map(|(name, &counter)| (name.as_str(), counter))
    }

    /// Returns all stage times in the order of the pipeline.
    pub fn stages(&self) -> impl Iterator<Item = (Stage, StageTime)> {
        self.times.iter().map(|(&stage, &time)| (stage, time))
    }

    fn combine(&mut self, name: &str, counter: Counter) {
        match self.counters.get_mut(name) {
            Some(present) => present.combine(counter),
            None => {
                self.counters.insert(name.to_owned(), counter);
            }
        }
    }
}

/// Returns the names of a stage's counters of queries: rays and seconds.
fn metered_counters(kind: Query, stage: Stage) -> [String; 2] {
    ["rays", "seconds"].map(|what| format!("Meter/{kind:?}, {}, {what}", stage.name()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(seed: u64) -> Stats {
        let mut stats = Stats::new();
        stats.count("Rays/shadow", 100 + seed);
        stats.count("Rays/eye", seed);
        stats.observe("Lightcut/cut size", seed * seed);
        stats.add("Light/flux [W]", seed as f64 * 0.5);
        stats
    }

    #[test]
    fn merging_adds_counts_and_joins_distributions() {
        let mut all = Stats::new();
        (1..=4).for_each(|seed| all.merge(&part(seed)));
        assert_eq!(all.get("Rays/shadow"), Some(Counter::Count(410)));
        assert_eq!(all.get("Light/flux [W]"), Some(Counter::Sum(5.0)));
        let Some(Counter::Distribution(cut)) = all.get("Lightcut/cut size") else { panic!() };
        assert_eq!((cut.count, cut.min, cut.max, cut.mean()), (4, 1, 16, 7.5));
        assert_eq!(all.get("Rays/none"), None);
    }

    #[test]
    fn integer_figures_do_not_depend_on_the_order_of_merging() {
        let (mut forward, mut backward) = (Stats::new(), Stats::new());
        (0..9).for_each(|seed| forward.merge(&part(seed)));
        (0..9).rev().for_each(|seed| backward.merge(&part(seed)));
        assert_eq!(forward, backward);
    }

    #[test]
    fn groups_are_neighbours_and_stages_follow_the_pipeline() {
        let mut stats = part(1);
        stats.time(Stage::Render, || ());
        stats.time(Stage::Load, || ());
        let names: Vec<_> = stats.counters().map(|(name, _)| name).collect();
        assert_eq!(names, ["Light/flux [W]", "Lightcut/cut size", "Rays/eye", "Rays/shadow"]);
        assert_eq!(stats.stages().map(|s| s.0).collect::<Vec<_>>(), [Stage::Load, Stage::Render]);
    }
}
