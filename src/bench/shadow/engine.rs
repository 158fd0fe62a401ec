//! The engine against bare loops over the same packets.

use super::MRAYS;
use super::trace::{Trace, Traces};
use crate::bench::measure::Case;
use crate::bench::setting::Setting;
use crate::bench::{Clock, Settings, Table};
use crate::embree::{Prepared, Width};
use crate::shadow::{Engine, Packing};
use std::hint::black_box;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    for trace in traces.all().filter(|t| t.rays() > 0) {
        for width in Width::ALL {
            let (labels, rays) = ([trace.name, &width.rays().to_string()], trace.rays() as f64);
            let (coherent, packing) = match width {
                Width::One => (false, Packing::Unrelated),
                _ => (true, Packing::Neighbours),
            };
            let against = cases.len();
            let prepared = Prepared::new(trace.packets().map(|p| (&p.rays, p.valid)), width);
            cases.push(Case::new(&labels, against, rays, move || {
                black_box(prepared.occluded(&world.accel, coherent));
            }));
            let engine = world.shadows().with_width(width);
            cases.push(Case::new(&labels, against, rays, move || {
                black_box(occluded(&engine, trace, packing));
            }));
        }
    }
    let mut table = Table::measured(
        (
            "Engine",
            "Packets flagged coherent, and single rays, through the engine. Ratio to bare loops over the same packets.",
        ),
        (&["packing", "width"], "Mrays/s", &[]),
        (Clock::Thread, settings, MRAYS),
        cases,
    );
    // Every other row is a bare loop.
    table.rows = table.rows.into_iter().skip(1).step_by(2).collect();
    table
}

/// How many rays of the trace are occluded.
pub fn occluded(engine: &Engine, trace: &Trace, packing: Packing) -> u64 {
    let one = |p: &super::trace::Packet| engine.occluded16(&p.rays, p.valid, packing, p.keys[0]).count_ones();
    trace.packets().map(|p| u64::from(one(p))).sum()
}
