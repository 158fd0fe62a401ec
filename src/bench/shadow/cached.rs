//! The occluder cache: share of rays saved, and what is gained.

use super::MRAYS;
use super::trace::{Packet, Trace, Traces};
use crate::bench::measure::Case;
use crate::bench::setting::Setting;
use crate::bench::{Clock, Settings, Table};
use crate::math::lanes_in;
use crate::shadow::{Engine, OccluderCacheSettings, Packing};
use std::hint::black_box;

const SIZES: [(usize, usize); 6] = [(1024, 1), (4096, 1), (4096, 2), (4096, 4), (4096, 8), (16384, 4)];

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    for trace in traces.refined.iter().flatten().filter(|t| t.rays() > 0) {
        let against = cases.len();
        let without = occluded(&Engine::new(world), trace);
        let add = |name: &str, engine| case(name, engine, trace, against, without);
        cases.push(add("none", Engine::new(world)));
        for (slots, ways) in SIZES {
            let engine = Engine::with_cache(world, OccluderCacheSettings { slots, ways });
            cases.push(add(&format!("{slots} x {ways}"), engine));
        }
    }
    Table::measured(
        (
            "Occluder cache",
            "Through the engine, the cache emptied at each stretch of 64 receivers. Ratio to the engine without one.",
        ),
        (&["order", "slots x ways"], "Mrays/s", &["saved %", "answers changed"]),
        (Clock::Thread, settings, MRAYS),
        cases,
    )
}

fn case<'a>(name: &str, engine: Engine<'a>, trace: &'a Trace, against: usize, without: u64) -> Case<'a> {
    let changed = occluded(&engine, trace).abs_diff(without);
    let counts = engine.take_counts().total();
    let saved = 100.0 * counts.saved as f64 / counts.rays.max(1) as f64;
    let mut case = Case::new(&[trace.name, name], against, trace.rays() as f64, move || {
        black_box(occluded(&engine, trace));
    });
    case.figures = vec![Some(saved), Some(changed as f64)];
    case
}

/// How many rays are occluded, asked for one by one or by packets as the trace has them.
pub fn occluded(engine: &Engine, trace: &Trace) -> u64 {
    occluded_by([engine, engine], trace)
}

/// The same with an engine for single rays and one for packets.
pub fn occluded_by([singly, together]: [&Engine; 2], trace: &Trace) -> u64 {
    let mut occluded = 0;
    for chunk in &trace.chunks {
        singly.begin_chunk();
        together.begin_chunk();
        for Packet { packing, rays, valid, keys } in chunk {
            if *packing == Packing::Neighbours {
                occluded += u64::from(together.occluded16(rays, *valid, *packing, keys[0]).count_ones());
            } else {
                for lane in lanes_in(*valid) {
                    occluded += u64::from(singly.occluded(&rays.get(lane), keys[lane]));
                }
            }
        }
    }
    occluded
}
