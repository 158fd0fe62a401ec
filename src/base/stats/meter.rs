//! Meter of the ray-tracing library, for benchmarks: rays by kind of query, and the time of one query of [`STEP`].
//!
//! The meter is off until [`start`] is called. A query then costs a test of a flag more. Figures are of all threads.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::Instant;

/// Number of queries of which one is timed. It is odd, so that no place in a tile of pixels is preferred.
const STEP: u64 = 13;

/// Number of empty measurements, whose mean is the meter's own time.
const EMPTY: u32 = 1000;

/// Nanoseconds per second.
const NANO: f64 = 1e9;

/// Kinds of queries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// Closest hits of a packet of similar rays, as from the eye.
    CoherentHits,
    /// Other closest hits.
    Hits,
    /// Occlusion.
    Shadows,
}

/// Rays of a kind of query, and their time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metered {
    /// Number of rays.
    pub rays: f64,
    /// Seconds, from the timed queries.
    pub seconds: f64,
}

impl Query {
    /// All kinds.
    pub const ALL: [Query; 3] = [Query::CoherentHits, Query::Hits, Query::Shadows];
}

/// Counts of a kind of query.
struct Counts {
    queries: AtomicU64,
    rays: AtomicU64,
    timed_rays: AtomicU64,
    nanoseconds: AtomicU64,
}

static IS_ON: AtomicBool = AtomicBool::new(false);
static COUNTS: [Counts; 3] = [const {
    Counts {
        queries: AtomicU64::new(0),
        rays: AtomicU64::new(0),
        timed_rays: AtomicU64::new(0),
        nanoseconds: AtomicU64::new(0),
    }
}; 3];

/// Sets the counts to zero, and switches the meter on.
pub fn start() {
    for counts in &COUNTS {
        let Counts { queries, rays, timed_rays, nanoseconds } = counts;
        [queries, rays, timed_rays, nanoseconds].into_iter().for_each(|count| count.store(0, Relaxed));
    }
    IS_ON.store(true, Relaxed);
}

/// Switches the meter off, and returns the figures of each kind since [`start`].
pub fn stop() -> [Metered; 3] {
    IS_ON.store(false, Relaxed);
    read()
}

/// Runs a query of some rays.
#[inline(always)]
pub fn query<R>(kind: Query, rays: impl FnOnce() -> u32, work: impl FnOnce() -> R) -> R {
    if IS_ON.load(Relaxed) { metered(kind, rays().into(), work) } else { work() }
}

#[inline(never)]
fn metered<R>(kind: Query, rays: u64, work: impl FnOnce() -> R) -> R {
    let counts = &COUNTS[kind as usize];
    counts.rays.fetch_add(rays, Relaxed);
    if !counts.queries.fetch_add(1, Relaxed).is_multiple_of(STEP) {
        return work();
    }
    let start = Instant::now();
    let result = work();
    counts.nanoseconds.fetch_add(start.elapsed().as_nanos() as u64, Relaxed);
    counts.timed_rays.fetch_add(rays, Relaxed);
    result
}

/// Returns the figures of each kind since [`start`]; `None` if the meter is off.
pub fn figures() -> Option<[Metered; 3]> {
    IS_ON.load(Relaxed).then(read)
}

fn read() -> [Metered; 3] {
    let own = own_nanoseconds();
    COUNTS.each_ref().map(|counts| {
        let [queries, rays, timed, nanoseconds] =
            [&counts.queries, &counts.rays, &counts.timed_rays, &counts.nanoseconds]
                .map(|count| count.load(Relaxed) as f64);
        let spent = (nanoseconds - own * (queries / STEP as f64).ceil()).max(0.0);
        Metered { rays, seconds: spent / NANO * rays / timed.max(1.0) }
    })
}

/// Returns the time that a measurement of nothing takes.
fn own_nanoseconds() -> f64 {
    let empty = |_| Instant::now().elapsed().as_nanos() as f64;
    (0..EMPTY).map(empty).sum::<f64>() / f64::from(EMPTY)
}

#[cfg(test)]
mod tests {
    use super::super::{Stage, Stats};
    use super::*;

    #[test]
    fn queries_count_while_the_meter_is_on() {
        let work = |rays: u32| query(Query::Shadows, || rays, || std::hint::black_box(rays));
        work(5);
        assert_eq!(figures(), None);
        start();
        let mut stats = Stats::new();
        stats.time(Stage::EyePass, || (0..26).map(work).sum::<u32>());
        query(Query::Hits, || 7, || ());
        let all = stop();
        work(5);
        let eye = stats.metered(Stage::EyePass);
        assert_eq!((eye[2].rays, all[2].rays, all[1].rays, all[0]), (325.0, 325.0, 7.0, Metered::default()));
        assert!((0.0..0.1).contains(&eye[2].seconds), "{eye:?}");
        assert_eq!(stats.metered(Stage::Render), [Metered::default(); 3]);
    }
}
