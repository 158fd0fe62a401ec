//! Shadow rays: widths, packings and flags by bare loops over Embree's queries, the engine against them,
//! build qualities, the occluder cache, and the rays of refinement.
//!
//! All segments are those of the scene: from the surfaces that its camera sees to its virtual lights. One
//! thread and its processor time.

mod cached;
mod engine;
mod orders;
mod quality;
mod refinement;
mod trace;
mod widths;

use super::setting::Setting;
use super::{Benchmark, Context, Kind, Table};
use orders::Orders;
use trace::Traces;
use transport::radiance_cache::CacheSettings;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "shadow",
    about: "Shadow rays a second, by packet width, packing, build quality, cache and order",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Millions of rays a second.
const MRAYS: f64 = 1e-6;

fn run(context: &Context) -> Vec<Table> {
    let Some(setting) = Setting::new(context) else { return Vec::new() };
    let cache = CacheSettings::default();
    let orders = Orders::new(&setting, &cache);
    let traces = Traces::record(&setting, &orders);
    let say = context.say;
    let settings = &context.settings;
    let mut tables = Vec::new();
    say("refinement");
    tables.push(refinement::table(&setting, &traces, settings));
    say("packings and widths");
    tables.push(widths::table(&setting, &traces, settings));
    say("engine against bare loops");
    tables.push(engine::table(&setting, &traces, settings));
    say("occluder cache");
    tables.push(cached::table(&setting, &traces, settings));
    say("build qualities");
    tables.push(quality::table(&setting, &traces, settings));
    tables
}
