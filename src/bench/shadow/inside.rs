//! Shadow rays inside the refinement: the time that the whole refinement takes, less what it takes where every answer is
//! known beforehand.
//!
//! What is known is played back from a recording, ray by ray, so that both runs make the same cuts. The difference is what
//! making and tracing rays takes among everything else that the caches have to hold.

use super::orders::{Order, Orders};
use super::trace::Traces;
use crate::bench::measure::Case;
use crate::bench::{Clock, Settings, Table};
use crate::light_tree::Node;
use crate::lightcut::{PacketVisibility, ReceiverPacket, Visibility};
use crate::shadow::{Engine, OccluderCacheSettings};
use crate::vpl::Vpl;
use crate::world::World;
use glam::Vec3;
use std::cell::Cell;
use std::hint::black_box;

/// How each order is run; the last three against the first of their kind of cuts.
const RUNS: [(bool, &str, Option<bool>); 5] = [
    (false, "single rays", Some(false)),
    (false, "with occluder cache", Some(true)),
    (false, "answers known", None),
    (true, "engine", Some(false)),
    (true, "answers known", None),
];

pub fn table(world: &World, orders: &Orders, traces: &Traces, settings: &Settings) -> Table {
    let mut cases = Vec::new();
    let mut rays = Vec::new();
    for (order, pair) in Order::ALL.into_iter().zip(&traces.refined) {
        if pair.iter().any(|trace| trace.rays() == 0) {
            continue;
        }
        let against = cases.len();
        for (shared, how, cached) in RUNS {
            let trace = &pair[usize::from(shared)];
            let labels = [trace.name, how];
            let units = orders.points(order) as f64;
            rays.push(trace.rays() as f64 / units);
            let engine = cached.map(|cached| Engine::with(world, cached, OccluderCacheSettings::default()));
            cases.push(Case::new(&labels, against, units, move || {
                for chunk in 0..orders.chunks() {
                    match &engine {
                        Some(engine) => {
                            engine.begin_chunk();
                            black_box(orders.light(order, chunk, shared, engine));
                        }
                        None => {
                            let known = Known { answers: &trace.answers[chunk], next: Cell::new(0) };
                            black_box(orders.light(order, chunk, shared, &known));
                        }
                    }
                }
            }));
        }
    }
    let mut table = Table::measured(
        (
            "Inside the refinement",
            "Points lit a second, everything included. Ratio to single points and single rays. Shadow time is what the \
             refinement takes beyond one to which all answers are known; its rate is rays asked for over that time, and \
             the last figure that rate over the one of single rays.",
        ),
        (
            &["order", "traced"],
            "k points/s",
            &["rays a point", "shadow time %", "Mrays/s of it", "of single rays"],
        ),
        (Clock::Thread, settings, 1e-3),
        cases,
    );
    for (group, rays) in table.rows.chunks_mut(RUNS.len()).zip(rays.chunks(RUNS.len())) {
        let time = |run: usize, rows: &[crate::bench::Row]| 1e3 / rows[run].rate.median;
        let mut single = None;
        for (run, known) in [(0, 2), (1, 2), (3, 4)] {
            let (whole, known) = (time(run, group), time(known, group));
            let rate = rays[run] / (whole - known);
            let single = *single.get_or_insert(rate);
            let share = 100.0 * (whole - known) / whole;
            group[run].figures = vec![Some(rays[run]), Some(share), Some(rate), Some(rate / single)];
        }
        for run in [2, 4] {
            group[run].figures = vec![Some(rays[run]), None, None, None];
        }
    }
    table
}

/// Visibility as it was recorded.
struct Known<'a> {
    answers: &'a [u16],
    next: Cell<usize>,
}

impl Known<'_> {
    #[inline]
    fn answer(&self) -> u16 {
        let next = self.next.get();
        self.next.set(next + 1);
        self.answers.get(next).copied().unwrap_or(0)
    }
}

impl Visibility for Known<'_> {
    #[inline]
    fn visible(&self, _: Vec3, _: Vec3, _: &Vpl, _: &Node) -> bool {
        self.answer() != 0
    }
}

impl PacketVisibility for Known<'_> {
    #[inline]
    fn visible16(&self, _: &ReceiverPacket, lanes: u16, _: &Vpl, _: &Node) -> u16 {
        lanes & self.answer()
    }
}
