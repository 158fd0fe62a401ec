//! The engine against bare loops over the same packets.

use super::MRAYS;
use super::trace::{Packet, Trace, Traces, count};
use crate::bench::measure::Case;
use crate::bench::setting::Setting;
use crate::bench::{Clock, Settings, Table};
use crate::embree::{Prepared, Ray, Width};
use crate::shadow::{Engine, Packing};
use std::hint::black_box;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    for trace in traces.all().filter(|t| count(t.bundles()) > 0) {
        for width in Width::ALL {
            let (labels, rays) = ([trace.name, &width.rays().to_string()], count(trace.bundles()) as f64);
            let coherent = width != Width::One;
            let against = cases.len();
            let prepared = Prepared::new(trace.bundles().map(|p| (&p.rays, p.valid)), width);
            cases.push(Case::new(&labels, against, rays, move || {
                black_box(prepared.occluded(&world.accel, coherent));
            }));
            let engine = Engine::new(world).with_width(width);
            if width == Width::One {
                let singles: Vec<(Ray, u32)> = trace.bundles().flat_map(Packet::singles).collect();
                cases.push(Case::new(&labels, against, rays, move || {
                    black_box(singles.iter().filter(|(ray, key)| engine.occluded(ray, *key)).count());
                }));
                continue;
            }
            cases.push(Case::new(&labels, against, rays, move || {
                black_box(occluded(&engine, trace));
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
fn occluded(engine: &Engine, trace: &Trace) -> u64 {
    let one = |p: &Packet| engine.occluded16(&p.rays, p.valid, Packing::Neighbours, p.keys[0]).count_ones();
    trace.bundles().map(|p| u64::from(one(p))).sum()
}
