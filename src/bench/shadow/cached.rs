//! The occluder cache: share of rays saved, and time gained.

use super::MRAYS;
use super::trace::{Trace, Traces};
use crate::measure::Case;
use crate::setting::Setting;
use crate::{Clock, Settings, Table};
use std::hint::black_box;
use world::shadow::{Engine, OccluderCacheSettings};

const SIZES: [(usize, usize); 6] = [(1024, 1), (4096, 1), (4096, 2), (4096, 4), (4096, 8), (16384, 4)];

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    for trace in traces.refined.iter().map(|[alone, _]| alone).filter(|t| t.rays() > 0) {
        let against = cases.len();
        let without = occluded(&Engine::new(world), trace);
        let add = |name: &str, engine| case(name, engine, trace, against, without);
        cases.push(add("none", Engine::new(world)));
        for (slots, ways) in SIZES {
            let engine = Engine::with(world, true, OccluderCacheSettings { slots, ways });
            cases.push(add(&format!("{slots} x {ways}"), engine));
        }
    }
    Table::measured(
        (
            "Occluder cache",
            "Single rays through the engine, the cache emptied at each stretch of 64 receivers. Ratio to the engine \
             without one.",
        ),
        (&["order", "slots x ways"], "Mrays/s", &["saved %", "answers changed"]),
        (Clock::Thread, settings, MRAYS),
        cases,
    )
}

fn case<'a>(name: &str, engine: Engine<'a>, trace: &'a Trace, against: usize, without: u64) -> Case<'a> {
    let changed = occluded(&engine, trace).abs_diff(without);
    let counts = engine.take_counts().single;
    let saved = 100.0 * counts.saved as f64 / counts.rays.max(1) as f64;
    let mut case = Case::new(&[trace.name, name], against, trace.rays() as f64, move || {
        black_box(occluded(&engine, trace));
    });
    case.figures = vec![Some(saved), Some(changed as f64)];
    case
}

/// Number of occluded rays, asked for one by one or by packets as the trace has them.
pub fn occluded(engine: &Engine, trace: &Trace) -> u64 {
    let mut occluded = 0;
    for chunk in &trace.chunks {
        engine.begin_chunk();
        for packet in chunk {
            if packet.neighbours {
                occluded += u64::from(engine.occluded16(&packet.rays, packet.valid).count_ones());
            } else {
                occluded += packet.singles().filter(|(ray, key)| engine.occluded(ray, *key)).count() as u64;
            }
        }
    }
    occluded
}
