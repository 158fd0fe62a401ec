//! Refinement of single points and of groups: rays asked for a second, and time a point.

use super::trace::{Trace, Traces, count};
use super::{MRAYS, cached};
use crate::measure::Case;
use crate::setting::Setting;
use crate::{Clock, Settings, Table};
use embree::{PreparedRays, Width};
use std::hint::black_box;
use world::shadow::{Engine, OccluderCacheSettings};

pub fn table(setting: &Setting, traces: &Traces, settings: &Settings) -> Table {
    let world = setting.world;
    let mut cases = Vec::new();
    let mut facts = Vec::new();
    for [alone, shared] in &traces.refined {
        if alone.rays() == 0 || shared.rays() == 0 {
            continue;
        }
        let against = cases.len();
        let prepared = PreparedRays::new(alone.packets().map(|p| (&p.rays, p.valid)), Width::One);
        cases.push(Case::new(
            &[alone.name, "single rays, bare loop"],
            against,
            alone.rays() as f64,
            move || {
                black_box(prepared.occluded(&world.accel, false));
            },
        ));
        let engine = |cached| Engine::with(world, cached, OccluderCacheSettings::default());
        cases.push(through(alone, "engine with cache", engine(true), against));
        cases.push(through(shared, "engine", engine(false), against));
        cases.push(through(shared, "cache for single rays", engine(true), against));
        let of = |t: &Trace| {
            let singles = count(t.packets().filter(|p| !p.neighbours));
            [t.rays() as f64 / t.points.max(1) as f64, 100.0 * singles as f64 / t.rays() as f64]
        };
        facts.extend([alone, alone, shared, shared].map(of));
    }
    let against: Vec<usize> = cases.iter().map(|c| c.against).collect();
    let mut table = Table::measured(
        (
            "Refinement",
            "Rays that cuts ask for, in their order: cuts of single points, and cuts shared by up to sixteen \
             neighbours. Ratio to single rays in the order of single points; time a point is relative to that, and \
             counts that shared cuts ask for more.",
        ),
        (&["order", "traced"], "Mrays/s", &["time a point", "rays a point", "single %"]),
        (Clock::Thread, settings, MRAYS),
        cases,
    );
    for (i, row) in table.rows.iter_mut().enumerate() {
        let [rays, singles] = facts[i];
        let more = rays / facts[against[i]][0];
        row.figures = vec![Some(more / row.ratio.median), Some(rays), Some(singles)];
    }
    table
}

fn through<'a>(trace: &'a Trace, how: &str, engine: Engine<'a>, against: usize) -> Case<'a> {
    Case::new(&[trace.name, how], against, trace.rays() as f64, move || {
        black_box(cached::occluded(&engine, trace));
    })
}
