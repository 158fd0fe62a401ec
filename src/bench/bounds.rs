//! Cluster bounds and contributions of lights, point by point and for sixteen points at once.

use super::lit_scene::{Dice, LitScene, packet};
use super::measure::{Case, Clock, measure};
use super::{Benchmark, Context, Kind, Table};
use base::math::LANES;
use std::cmp::Reverse;
use std::hint::black_box;
use transport::lightcut::ReceiverPacket;
use transport::lights::LightNode;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "bounds",
    about: "Cluster bounds per second, point by point and for sixteen points at once",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Number of clusters chosen at random.
const CLUSTERS: usize = 256;
/// Maximum number of groups.
const GROUPS: usize = 16;

fn run(context: &Context) -> Vec<Table> {
    let Some(lit) = LitScene::new(context) else { return Vec::new() };
    let mut groups: Vec<Vec<usize>> = lit.stretches().iter().flat_map(|s| lit.groups(s)).collect();
    // The largest groups come first, since these are the reason for grouping.
    groups.sort_by_key(|g| Reverse(g.len()));
    groups.truncate(GROUPS);
    let mut dice = Dice(4);
    let inner: Vec<&LightNode> = lit.trees.nodes.iter().filter(|n| !n.is_leaf()).collect();
    let nodes: Vec<&LightNode> =
        (0..CLUSTERS).filter_map(|_| inner.get(dice.below(inner.len())).copied()).collect();
    let (widths, packets) = ([1, LANES], |width| groups.iter().flat_map(move |g| g.chunks(width)));
    let units = (groups.iter().map(Vec::len).sum::<usize>() * nodes.len()) as f64;
    let irradiance: [Vec<ReceiverPacket>; 2] =
        widths.map(|width| packets(width).map(|g| packet(g.iter().map(|&i| lit.irradiance(i)))).collect());
    let surfaces: [Vec<ReceiverPacket>; 2] =
        widths.map(|width| packets(width).map(|g| packet(g.iter().map(|&i| lit.surface(i)))).collect());
    let (transfer, vpls) = (&lit.transfer(), &lit.trees.vpls);
    let light = |node: &LightNode| &vpls[node.representative()];
    let bound = |points: &ReceiverPacket, node: &LightNode| {
        black_box(transfer.errors16(points, node));
    };
    let light_alone = |points: &ReceiverPacket, node: &LightNode| {
        black_box(transfer.unshadowed(points.get(0), light(node), node.kind()));
    };
    let light_together = |points: &ReceiverPacket, node: &LightNode| {
        black_box(transfer.unshadowed16(points, light(node), node.kind()));
    };
    let mut cases = Vec::new();
    for (name, [ones, all]) in [("collectors (Lambert)", &irradiance), ("the scene's materials", &surfaces)] {
        let at = cases.len();
        cases.push(Case::new(&["bound", name, "alone"], at, units, each(ones, &nodes, bound)));
        cases.push(Case::new(&["bound", name, "sixteen"], at, units, each(all, &nodes, bound)));
        cases.push(Case::new(&["light", name, "alone"], at + 2, units, each(ones, &nodes, light_alone)));
        cases.push(Case::new(&["light", name, "sixteen"], at + 2, units, each(all, &nodes, light_together)));
    }
    let table = Table {
        title: "Bounds",
        about: "Error to expect of a cluster, and light of its representative. Ratio to one point at a time.",
        labels: &["what", "surfaces", "points"],
        unit: "M/s",
        ..Table::default()
    };
    vec![measure(table, Clock::Thread, cases, &context.settings)]
}

/// Returns work that calls a function for each packet and each node.
fn each<'a>(
    packets: &'a [ReceiverPacket<'a>],
    nodes: &'a [&'a LightNode],
    call: impl Fn(&ReceiverPacket, &LightNode) + 'a,
) -> impl FnMut() + 'a {
    move || packets.iter().for_each(|points| nodes.iter().for_each(|node| call(points, node)))
}
