//! The engine against bare loops over the same packets.

use super::MRAYS;
use super::trace::{SegmentPacket, Traces, count};
use crate::measure::Case;
use crate::setting::Setting;
use crate::{Clock, Settings, Table};
use embree::{PreparedRays, Ray, Width};
use std::hint::black_box;
use world::shadow::Engine;

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    for trace in traces.all().filter(|t| count(t.bundles()) > 0) {
        let rays = count(trace.bundles()) as f64;
        for width in [Width::One, world.accel.widest()] {
            let labels = [trace.name, &width.rays().to_string()];
            let against = cases.len();
            let prepared = PreparedRays::new(trace.bundles().map(|p| (&p.rays, p.valid)), width);
            cases.push(Case::new(&labels, against, rays, move || {
                black_box(prepared.occluded(&world.accel, width != Width::One));
            }));
            let engine = Engine::new(world);
            if width == Width::One {
                let singles: Vec<(Ray, u32)> = trace.bundles().flat_map(SegmentPacket::singles).collect();
                cases.push(Case::new(&labels, against, rays, move || {
                    black_box(singles.iter().filter(|(ray, key)| engine.occluded(ray, *key)).count());
                }));
            } else {
                let one =
                    move |p: &SegmentPacket| u64::from(engine.occluded16(&p.rays, p.valid).count_ones());
                cases.push(Case::new(&labels, against, rays, move || {
                    black_box(trace.bundles().map(&one).sum::<u64>());
                }));
            }
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
