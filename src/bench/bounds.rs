//! Cluster bounds and contributions of lights, point by point and for sixteen points at once.

use super::measure::Case;
use super::setting::{Dice, Setting};
use super::{Benchmark, Clock, Context, Kind, Table};
use base::math::luminance;
use std::hint::black_box;
use transport::lightcut::{Receiver, ReceiverPacket};
use transport::lights::LightNode;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "bounds",
    about: "Cluster bounds a second, point by point and for sixteen points at once",
    kind: Kind::Parts { needs_scene: true, run },
};

/// Number of clusters drawn for each group.
const CLUSTERS: usize = 256;
/// Maximum number of groups.
const GROUPS: usize = 16;

fn run(context: &Context) -> Vec<Table> {
    let Some(setting) = Setting::new(context) else { return Vec::new() };
    let stretches = setting.pixels();
    let mut groups: Vec<Vec<usize>> = stretches.iter().flat_map(|s| setting.groups(s)).collect();
    // Largest groups first: they are the reason for grouping.
    groups.sort_by_key(|g| std::cmp::Reverse(g.len()));
    groups.truncate(GROUPS);
    let transfer = setting.transfer();
    let mut dice = Dice(4);
    // Inner nodes, and their representative lights.
    let inner: Vec<&LightNode> = setting.trees.nodes.iter().filter(|n| !n.is_leaf()).collect();
    let nodes: Vec<&LightNode> =
        (0..CLUSTERS).filter_map(|_| inner.get(dice.below(inner.len())).copied()).collect();
    let units = (groups.iter().map(Vec::len).sum::<usize>() * nodes.len()) as f64;
    let collectors: Vec<ReceiverPacket> =
        groups.iter().map(|g| points(g.iter().map(|&i| setting.collector(i)))).collect();
    let surfaces: Vec<ReceiverPacket> =
        groups.iter().map(|g| points(g.iter().map(|&i| setting.reflector(i)))).collect();
    let mut cases = Vec::new();
    for (name, all) in [("collectors (Lambert)", &collectors), ("the scene's materials", &surfaces)] {
        let (nodes, transfer, vpls) = (&nodes, &transfer, &setting.trees.vpls);
        let bound_alone = move || {
            for points in all {
                for node in nodes {
                    for lane in 0..points.len() {
                        let bound = transfer.bound(points.get(lane), node);
                        black_box(luminance(bound.most * node.intensity) * bound.share);
                    }
                }
            }
        };
        let bound_together = move || {
            for points in all {
                for node in nodes {
                    black_box(transfer.errors16(points, node));
                }
            }
        };
        let light_alone = move || {
            for points in all {
                for node in nodes {
                    for lane in 0..points.len() {
                        black_box(transfer.unshadowed(
                            points.get(lane),
                            &vpls[node.representative()],
                            node.kind(),
                        ));
                    }
                }
            }
        };
        let light_together = move || {
            for points in all {
                for node in nodes {
                    let vpl = &vpls[node.representative()];
                    black_box(transfer.unshadowed16(points, vpl, node.kind()));
                }
            }
        };
        let at = cases.len();
        cases.push(Case::new(&["bound", name, "alone"], at, units, bound_alone));
        cases.push(Case::new(&["bound", name, "sixteen"], at, units, bound_together));
        cases.push(Case::new(&["light", name, "alone"], at + 2, units, light_alone));
        cases.push(Case::new(&["light", name, "sixteen"], at + 2, units, light_together));
    }
    vec![Table::measured(
        (
            "Bounds",
            "Error to expect of a cluster, and light of its representative. Ratio to one point at a time.",
        ),
        (&["what", "surfaces", "points"], "M/s", &[]),
        (Clock::Thread, &context.settings, 1e-6),
        cases,
    )]
}

fn points<'m>(reflectors: impl Iterator<Item = Receiver<'m>>) -> ReceiverPacket<'m> {
    let mut points = ReceiverPacket::new();
    points.set(reflectors);
    points
}
