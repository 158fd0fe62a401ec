//! Top-down building: binned splits in position and normal.
//!
//! Paper: the cost is that of Walter et al. 2005 (see `cost`); binning as in Wald, *On fast Construction of
//! SAH-based Bounding Volume Hierarchies*, 2007, over six dimensions in place of three.
//! Deviations: clusters of at most [`SORTED`] are sorted along their widest dimension and split at the best
//! of all places, which is cheaper than clearing bins and at least as good.

use super::cost::{DIMENSIONS, LUMINANCE, Primitive, PrimitiveBounds, cluster_cost};
use super::topology::Topology;
use crate::progress::Control;
use rayon::prelude::*;

/// Number of bins by dimension.
const BINS: usize = 16;
/// Maximum size of a cluster that is sorted, not binned.
const SORTED: usize = 16;
/// Size above which both halves are built in parallel.
const PARALLEL: usize = 4096;
/// Number of primitives binned by one task; fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 1 << 15;

#[derive(Clone, Copy)]
struct Bin {
    bounds: PrimitiveBounds,
    intensity: f64,
}

const EMPTY_BIN: Bin = Bin { bounds: PrimitiveBounds::EMPTY, intensity: 0.0 };

impl Bin {
    fn add(&mut self, other: &Bin) {
        self.bounds.add(&other.bounds);
        self.intensity += other.intensity;
    }
}

type Bins = [[Bin; BINS]; DIMENSIONS];

/// Builds a tree by recursive splits; `c_sq` is the square of the scene's diagonal. Clusters are halved as they come
/// once `control` is cancelled.
pub fn build(mut primitives: Vec<Primitive>, c_sq: f32, control: &Control) -> Topology {
    let mut left_sizes = vec![0; primitives.len().saturating_sub(1)];
    split_all(&mut primitives, &mut left_sizes, c_sq, control);
    Topology { leaves: primitives, left_sizes }
}

fn split_all(primitives: &mut [Primitive], left_sizes: &mut [u32], c_sq: f32, control: &Control) {
    let n = primitives.len();
    let Some((own, rest)) = left_sizes.split_first_mut() else { return };
    let left = if n == 2 {
        1
    } else if n > SORTED && control.is_cancelled() {
        n / 2
    } else if n <= SORTED {
        split_sorted(primitives, c_sq)
    } else {
        split_binned(primitives, c_sq)
    };
    *own = left as u32;
    let (left_records, right_records) = primitives.split_at_mut(left);
    let (left_rest, right_rest) = rest.split_at_mut(left - 1);
    if n > PARALLEL {
        rayon::join(
            || split_all(left_records, left_rest, c_sq, control),
            || split_all(right_records, right_rest, c_sq, control),
        );
    } else {
        split_all(left_records, left_rest, c_sq, control);
        split_all(right_records, right_rest, c_sq, control);
    }
}

/// Sorts a small cluster along its widest dimension and returns the size of the cheapest left part.
fn split_sorted(primitives: &mut [Primitive], c_sq: f32) -> usize {
    let bounds = PrimitiveBounds::around(primitives);
    let half_c = 0.5 * c_sq.sqrt();
    let width = |lane: usize| bounds.extent(lane) * if lane < 3 { 1.0 } else { half_c };
    let widest = (1..DIMENSIONS).fold(0, |a, b| if width(b) > width(a) { b } else { a });
    // Insertion sort: stable, and the fastest for so few.
    for i in 1..primitives.len() {
        let mut j = i;
        while j > 0 && primitives[j].0[widest] < primitives[j - 1].0[widest] {
            primitives.swap(j, j - 1);
            j -= 1;
        }
    }
    let n = primitives.len();
    let mut right_costs = [0.0; SORTED];
    let mut sweep = EMPTY_BIN;
    for i in (1..n).rev() {
        sweep.add(&Bin::of(&primitives[i]));
        right_costs[i] = cluster_cost(&sweep.bounds, sweep.intensity, c_sq);
    }
    let mut sweep = EMPTY_BIN;
    let mut best = (f64::INFINITY, n / 2);
    for i in 1..n {
        sweep.add(&Bin::of(&primitives[i - 1]));
        let cost = cluster_cost(&sweep.bounds, sweep.intensity, c_sq) + right_costs[i];
        // Equal costs (coincident VPLs) halve the cluster.
        let balance = |k: usize| k.abs_diff(n / 2);
        if cost < best.0 || (cost == best.0 && balance(i) < balance(best.1)) {
            best = (cost, i);
        }
    }
    best.1
}

impl Bin {
    #[inline]
    fn of(r: &Primitive) -> Bin {
        Bin { bounds: PrimitiveBounds::of(r), intensity: f64::from(r.0[LUMINANCE]) }
    }
}

/// Partitions a large cluster at the cheapest of all bin borders in all dimensions and returns the left size.
#[inline(never)] // Its bins must not stay on the stack during the recursion.
fn split_binned(primitives: &mut [Primitive], c_sq: f32) -> usize {
    let bounds = if primitives.len() > CHUNK {
        let parts: Vec<PrimitiveBounds> = primitives.par_chunks(CHUNK).map(PrimitiveBounds::around).collect();
        parts.iter().fold(PrimitiveBounds::EMPTY, |mut a, b| {
            a.add(b);
            a
        })
    } else {
        PrimitiveBounds::around(primitives)
    };
    let binning = Binning::new(&bounds);
    let mut bins: Bins = [[EMPTY_BIN; BINS]; DIMENSIONS];
    if primitives.len() > CHUNK {
        let parts: Vec<Box<Bins>> = primitives
            .par_chunks(CHUNK)
            .map(|chunk| {
                let mut bins: Box<Bins> = Box::new([[EMPTY_BIN; BINS]; DIMENSIONS]);
                binning.fill(chunk, &mut bins);
                bins
            })
            .collect();
        for part in &parts {
            for (a, b) in bins.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
                a.add(b);
            }
        }
    } else {
        binning.fill(primitives, &mut bins);
    }
    let n = primitives.len();
    let Some((dimension, border)) = cheapest_border(&bins, &binning, c_sq) else { return n / 2 };
    let left = partition(primitives, |r| binning.bin(r)[dimension] < border as i32);
    if left == 0 || left == n { n / 2 } else { left }
}

/// Maps primitives to bins in every dimension at once.
struct Binning {
    min: [f32; 8],
    scale: [f32; 8],
}

impl Binning {
    fn new(bounds: &PrimitiveBounds) -> Binning {
        let mut scale = [0.0; 8];
        for (d, s) in scale.iter_mut().enumerate().take(DIMENSIONS) {
            // Slightly below BINS, so that the maximum itself falls into the last bin; 0 where flat.
            let inverse = (BINS as f32 * (1.0 - 1e-6)) / bounds.extent(d);
            *s = if inverse.is_finite() { inverse } else { 0.0 };
        }
        Binning { min: bounds.min, scale }
    }

    #[inline]
    fn bin(&self, r: &Primitive) -> [i32; 8] {
        let mut bin = [0; 8];
        for (i, b) in bin.iter_mut().enumerate() {
            *b = (((r.0[i] - self.min[i]) * self.scale[i]) as i32).min(BINS as i32 - 1);
        }
        bin
    }

    fn fill(&self, primitives: &[Primitive], bins: &mut Bins) {
        for r in primitives {
            let single = Bin::of(r);
            let bin = self.bin(r);
            for (d, row) in bins.iter_mut().enumerate() {
                row[bin[d] as usize & (BINS - 1)].add(&single);
            }
        }
    }
}

/// Returns the dimension and the bin at which the cheapest split begins its right part.
fn cheapest_border(bins: &Bins, binning: &Binning, c_sq: f32) -> Option<(usize, usize)> {
    let mut best = None;
    let mut best_cost = f64::INFINITY;
    for (d, row) in bins.iter().enumerate() {
        if binning.scale[d] == 0.0 {
            continue;
        }
        let mut right_costs = [0.0; BINS];
        let mut sweep = EMPTY_BIN;
        for i in (1..BINS).rev() {
            sweep.add(&row[i]);
            right_costs[i] = if sweep.intensity > 0.0 {
                cluster_cost(&sweep.bounds, sweep.intensity, c_sq)
            } else {
                f64::INFINITY
            };
        }
        let mut sweep = EMPTY_BIN;
        for i in 1..BINS {
            sweep.add(&row[i - 1]);
            if sweep.intensity > 0.0 {
                let cost = cluster_cost(&sweep.bounds, sweep.intensity, c_sq) + right_costs[i];
                if cost < best_cost {
                    best_cost = cost;
                    best = Some((d, i));
                }
            }
        }
    }
    best
}

/// Moves primitives that satisfy `goes_left` to the front and returns their number.
fn partition(primitives: &mut [Primitive], goes_left: impl Fn(&Primitive) -> bool) -> usize {
    let (mut i, mut j) = (0, primitives.len());
    loop {
        while i < j && goes_left(&primitives[i]) {
            i += 1;
        }
        while i < j && !goes_left(&primitives[j - 1]) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        primitives.swap(i, j - 1);
        i += 1;
        j -= 1;
    }
}
