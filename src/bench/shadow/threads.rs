//! All threads against one.

use super::MRAYS;
use super::trace::{Packet, Traces};
use crate::bench::measure::Case;
use crate::bench::setting::Setting;
use crate::bench::{Clock, Settings, Table};
use crate::shadow::{Engine, Packing};
use rayon::prelude::*;
use std::hint::black_box;

/// Packets that a thread takes at a time.
const SHARE: usize = 64;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    for trace in traces.pixels().iter().filter(|t| t.rays() > 0) {
        let packets: Vec<&Packet> = trace.packets().collect();
        let part = move |packets: &[&Packet]| -> u64 {
            let engine = Engine::new(world);
            let one = |p: &&Packet| {
                let packing = if p.packing == Packing::Single { Packing::Unrelated } else { p.packing };
                engine.occluded16(&p.rays, p.valid, packing, 0).count_ones()
            };
            packets.iter().map(|p| u64::from(one(p))).sum()
        };
        let (against, rays) = (cases.len(), trace.rays() as f64);
        let all = packets.clone();
        cases.push(Case::new(&[trace.name, "1"], against, rays, move || {
            black_box(part(&packets));
        }));
        cases.push(Case::new(&[trace.name, &settings.threads.to_string()], against, rays, move || {
            black_box(all.par_chunks(SHARE).map(part).sum::<u64>());
        }));
    }
    Table::measured(
        ("Threads", "Through the engine, by the time that passes. Ratio to one thread."),
        (&["order", "threads"], "Mrays/s", &[]),
        (Clock::Wall, settings, MRAYS),
        cases,
    )
}
