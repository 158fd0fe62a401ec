//! Bottom-up building: clusters merge with their nearest neighbour along a Morton curve.
//!
//! Paper: Meister & Bittner, *Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction*, 2018.
//! Deviations: the curve runs through position and normal (6-D). The distance is the cost of the merged cluster. Ties
//! break by the XOR of the positions. A round with few merges is followed by pairing of neighbours. So neither
//! coincident VPLs nor intensities in geometric progression stall the rounds.

use super::cost::{DIMENSIONS, LUMINANCE, Primitive, PrimitiveBounds, cluster_cost};
use super::node::Topology;
use base::progress::Control;
use rayon::prelude::*;

/// Maximum distance along the curve, in clusters, at which a cluster searches for its neighbour.
const RADIUS: usize = 8;

/// Number of clusters per task. It is fixed, so that the order of the nodes does not depend on threads.
const CHUNK: usize = 4096;

/// Divisor of the number of clusters. A round with no more merges than the quotient is followed by pairing.
const STALLED: usize = 32;

#[derive(Clone, Copy)]
struct ActiveCluster {
    bounds: PrimitiveBounds,
    intensity: f64,
    id: u32,
}

impl ActiveCluster {
    fn merged(&self, other: &ActiveCluster, id: u32) -> ActiveCluster {
        let mut bounds = self.bounds;
        bounds.add(&other.bounds);
        ActiveCluster { bounds, intensity: self.intensity + other.intensity, id }
    }
}

/// Builds a tree by rounds of merges of mutual nearest neighbours; `None` if `control` is cancelled. `c_sq` is the
/// square of the scene's diagonal.
pub fn build(mut primitives: Vec<Primitive>, c_sq: f32, control: &Control) -> Option<Topology> {
    sort_along_curve(&mut primitives, c_sq);
    let leaf = |(i, r): (usize, &Primitive)| ActiveCluster {
        bounds: PrimitiveBounds::around_one(r),
        intensity: f64::from(r.0[LUMINANCE]),
        id: i as u32,
    };
    let mut clusters: Vec<ActiveCluster> = primitives.iter().enumerate().map(leaf).collect();
    let mut pairs = Vec::with_capacity(primitives.len().saturating_sub(1));
    while clusters.len() > 1 {
        if control.is_cancelled() {
            return None;
        }
        let before = clusters.len();
        let nearest = nearest_neighbours(&clusters, c_sq);
        merge(&mut clusters, &nearest, primitives.len(), &mut pairs);
        if before - clusters.len() <= before / STALLED {
            let paired: Vec<u32> = (0..clusters.len() as u32).map(|i| i ^ 1).collect();
            merge(&mut clusters, &paired, primitives.len(), &mut pairs);
        }
    }
    Some(Topology::from_pairs(&primitives, &pairs))
}

fn sort_along_curve(primitives: &mut [Primitive], c_sq: f32) {
    let bounds = PrimitiveBounds::around(primitives.iter());
    let half_c = 0.5 * c_sq.sqrt();
    let weight = |d: usize| if d < 3 { 1.0 } else { half_c };
    let widest = (0..DIMENSIONS).map(|d| bounds.extent(d) * weight(d)).fold(0.0, f32::max);
    let code = |r: &Primitive| {
        let mut code = 0u64;
        for d in 0..DIMENSIONS {
            let x = (r.0[d] - bounds.min[d]) * weight(d) / widest;
            // If all primitives coincide, NaN becomes 0.
            code |= spread_by_6((x * 1023.0) as u64) << d;
        }
        code
    };
    let mut keyed: Vec<(u64, Primitive)> = primitives.par_iter().map(|r| (code(r), *r)).collect();
    keyed.par_sort_unstable_by_key(|(code, r)| (*code, r.index()));
    for (slot, (_, r)) in primitives.iter_mut().zip(keyed) {
        *slot = r;
    }
}

/// Spreads ten bits, with five zeros after each.
fn spread_by_6(x: u64) -> u64 {
    (0..10).fold(0, |code, bit| code | (x >> bit & 1) << (6 * bit))
}

/// Finds the neighbour within [`RADIUS`] that makes the cheapest union with each cluster.
fn nearest_neighbours(clusters: &[ActiveCluster], c_sq: f32) -> Vec<u32> {
    let nearest = |i: usize| {
        let mut best = (f64::INFINITY, usize::MAX, i);
        for j in i.saturating_sub(RADIUS)..(i + RADIUS + 1).min(clusters.len()) {
            if j != i {
                let mut bounds = clusters[i].bounds;
                bounds.add(&clusters[j].bounds);
                let cost = cluster_cost(&bounds, clusters[i].intensity + clusters[j].intensity, c_sq);
                let key = (cost, i ^ j, j);
                if key < best {
                    best = key;
                }
            }
        }
        best.2 as u32
    };
    (0..clusters.len()).into_par_iter().with_min_len(CHUNK).map(nearest).collect()
}

/// Merges clusters that chose each other, in place and in order.
fn merge(clusters: &mut Vec<ActiveCluster>, nearest: &[u32], leaves: usize, pairs: &mut Vec<[u32; 2]>) {
    let mut count = 0;
    for i in 0..clusters.len() {
        let j = nearest[i] as usize;
        let mutual = j < clusters.len() && nearest[j] as usize == i;
        if mutual && j < i {
            continue; // already merged, by its partner
        }
        clusters[count] = if mutual && j > i {
            let id = (leaves + pairs.len()) as u32;
            pairs.push([clusters[i].id, clusters[j].id]);
            clusters[i].merged(&clusters[j], id)
        } else {
            clusters[i]
        };
        count += 1;
    }
    clusters.truncate(count);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_leaves_five_zeros_between_bits() {
        assert_eq!(spread_by_6(0b11), 0b1000001);
        assert_eq!(spread_by_6(1023).count_ones(), 10);
    }
}
