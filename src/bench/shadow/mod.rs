//! Shadow rays per second: packet widths in plain Embree loops, the renderer's engine against these loops, and the
//! occluder cache in front of single rays and of packets.
//!
//! The rays are those of the renderer's own cuts, from the surfaces that the camera sees to virtual lights: of pixels
//! and of cache records, with a cut per point ("alone") or with cuts shared by neighbours. One thread.

mod tables;
mod trace;

use super::lit_scene::LitScene;
use super::measure::{Clock, measure};
use super::{Benchmark, Context, Kind, Table};
use trace::Trace;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "shadow",
    about: "Shadow rays per second, by packet width, engine, occluder cache and order",
    kind: Kind::Parts { needs_scene: true, run },
};

fn run(context: &Context) -> Vec<Table> {
    let Some(lit) = LitScene::new(context) else { return Vec::new() };
    let traces = Trace::all(&lit);
    let measured = |(name, set_up): (&str, tables::SetUp)| {
        (context.say)(name);
        let (table, cases) = set_up(lit.world, &traces);
        measure(table, Clock::Thread, cases, &context.settings)
    };
    tables::ALL.into_iter().map(measured).collect()
}
