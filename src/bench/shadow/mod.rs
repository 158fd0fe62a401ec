//! Shadow rays per second: packet widths in plain Embree loops, the renderer's engine against these loops, and the
//! occluder cache in front of single rays and of packets.
//!
//! The rays are those of the renderer's own cuts, from the surfaces that the camera sees to virtual lights: of pixels
//! and of cache records, with a cut per point ("alone") or with cuts shared by neighbours. One thread.

mod trace;

use super::lit_scene::LitScene;
use super::measure::{Case, Clock, measure};
use super::{Benchmark, Context, Kind, Table};
use embree::{PreparedRays, Ray, Width};
use std::hint::black_box;
use trace::{SegmentPacket, Trace};
use world::World;
use world::shadow::{Engine, OccluderCacheSettings};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "shadow",
    about: "Shadow rays per second, by packet width, engine, occluder cache and order",
    kind: Kind::Parts(run),
};

fn run(context: &Context) -> Vec<Table> {
    let lit = LitScene::new(context);
    let traces = Trace::all(&lit);
    let measured = |(name, set_up): (&str, SetUp)| {
        (context.say)(name);
        let (table, cases) = set_up(lit.world, &traces);
        measure(table, Clock::Thread, cases, &context.settings)
    };
    ALL.into_iter().map(measured).collect()
}

/// Function that sets up a table and its cases, in millions of rays per second on the calling thread.
type SetUp = for<'a> fn(&'a World, &'a [Trace]) -> (Table, Vec<Case<'a>>);

/// All tables, each with a name for messages.
const ALL: [(&str, SetUp); 3] =
    [("packet widths", widths), ("engine against plain loops", engine), ("occluder cache", cache)];

/// Creates a case that traces rays and counts something about them.
fn case<'a>(labels: &[&str], against: usize, rays: u64, count: impl Fn() -> u64 + 'a) -> Case<'a> {
    Case::new(labels, against, rays as f64, move || {
        black_box(count());
    })
}

/// Compares packet widths, with and without the flag for coherent rays.
fn widths<'a>(world: &'a World, traces: &'a [Trace]) -> (Table, Vec<Case<'a>>) {
    let mut cases = Vec::new();
    for trace in traces {
        let (against, rays) = (cases.len(), trace.rays());
        let forms = Width::ALL.into_iter().flat_map(|width| [(width, ""), (width, "coherent")]);
        for (width, flag) in forms.filter(|form| *form != (Width::One, "coherent")) {
            let coherent = !flag.is_empty();
            let prepared = PreparedRays::new(trace.packets().map(|p| (&p.rays, p.valid)), width);
            let occluded = prepared.occluded(&world.accel, coherent) as f64;
            let figures = [rays as f64 / prepared.queries().max(1) as f64, 100.0 * occluded / rays as f64];
            let labels = [trace.name, &width.rays().to_string(), flag];
            let count = move || prepared.occluded(&world.accel, coherent);
            cases.push(case(&labels, against, rays, count).with(&figures));
        }
    }
    let table = Table {
        title: "Packet widths",
        about: "Plain loops over Embree's queries. Ratio to single rays.",
        labels: &["rays", "width", "flag"],
        figures: &["rays per query", "occluded %"],
        unit: "Mrays/s",
        ..Table::default()
    };
    (table, cases)
}

/// Compares the engine with plain loops over the same single rays, and over the same packets.
fn engine<'a>(world: &'a World, traces: &'a [Trace]) -> (Table, Vec<Case<'a>>) {
    let mut cases = Vec::new();
    for trace in traces {
        for width in [Width::One, world.accel.widest()] {
            let (against, name) = (cases.len(), width.rays().to_string());
            let prepared = PreparedRays::new(trace.packets().map(|p| (&p.rays, p.valid)), width);
            let plain = move || prepared.occluded(&world.accel, width != Width::One);
            cases.push(case(&[trace.name, &name, "plain loop"], against, trace.rays(), plain));
            let engine = Engine::new(world);
            let singles: Vec<(Ray, u32)> = trace.packets().flat_map(SegmentPacket::singles).collect();
            let engine = move || match width {
                Width::One => singles.iter().filter(|(ray, key)| engine.occluded(ray, *key)).count() as u64,
                _ => {
                    trace.packets().map(|p| u64::from(engine.occluded16(&p.rays, p.valid).count_ones())).sum()
                }
            };
            cases.push(case(&[trace.name, &name, "engine"], against, trace.rays(), engine));
        }
    }
    let table = Table {
        title: "Engine",
        about: "The renderer's engine against plain Embree loops over the same rays, coherent in packets. Ratio to \
                the plain loop.",
        labels: &["rays", "width", "traced by"],
        unit: "Mrays/s",
        ..Table::default()
    };
    (table, cases)
}

/// Slots and ways of the occluder caches that are compared.
const SIZES: [(usize, usize); 6] = [(1024, 1), (4096, 1), (4096, 2), (4096, 4), (4096, 8), (16384, 4)];

/// Compares occluder caches in front of the queries of each order, single rays and packets.
fn cache<'a>(world: &'a World, traces: &'a [Trace]) -> (Table, Vec<Case<'a>>) {
    let mut cases = Vec::new();
    for trace in traces {
        let against = cases.len();
        let without = occluded(&Engine::new(world), trace);
        let caches = SIZES.map(|(slots, ways)| Some(OccluderCacheSettings { slots, ways }));
        for cache in [None].into_iter().chain(caches) {
            let name = cache.map_or("none".to_owned(), |c| format!("{} x {}", c.slots, c.ways));
            let engine = Engine::with(world, cache.is_some(), cache.unwrap_or_default());
            let changed = occluded(&engine, trace).abs_diff(without) as f64;
            let counts = engine.take_counts();
            let mut all = counts.single;
            all += counts.packets;
            let percent = |rays: u64| 100.0 * rays as f64 / all.rays.max(1) as f64;
            let figures = [percent(all.saved), changed, percent(counts.packets.rays)];
            let count = move || occluded(&engine, trace);
            cases.push(case(&[trace.name, &name], against, all.rays, count).with(&figures));
        }
    }
    let table = Table {
        title: "Occluder cache",
        about: "A cache in front of the engine's queries, single rays and packets as the cuts ask for them. It is \
                cleared after each stretch of 64 receivers. Ratio to the engine without a cache.",
        labels: &["rays", "slots x ways"],
        figures: &["saved %", "answers changed", "in packets %"],
        unit: "Mrays/s",
        ..Table::default()
    };
    (table, cases)
}

/// Returns the number of occluded rays of a trace, in the order and in the packets of its queries.
fn occluded(engine: &Engine, trace: &Trace) -> u64 {
    let mut occluded = 0;
    for chunk in &trace.chunks {
        engine.begin_chunk();
        for packet in chunk {
            occluded += match packet.neighbours {
                true => {
                    let occluded = engine.occluded16_cached(&packet.rays, packet.valid, packet.keys[0]);
                    u64::from(occluded.count_ones())
                }
                false => packet.singles().filter(|(ray, key)| engine.occluded(ray, *key)).count() as u64,
            };
        }
    }
    occluded
}
