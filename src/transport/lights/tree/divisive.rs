//! Top-down building: binned splits in position and normal.
//!
//! Papers: Walter et al. 2005 for the cost (see `cost`); Wald, *On fast Construction of SAH-based Bounding Volume
//! Hierarchies*, 2007, for binning.
//! Deviations: there are six dimensions in place of three. Clusters of at most [`SORTED`] members are sorted along
//! their widest dimension and split at the best of all places, which is cheaper than clearing bins. A subset of the
//! members evaluates the splits of large clusters.

use super::cost::{DIMENSIONS, LUMINANCE, Primitive, PrimitiveBounds, cluster_cost};
use super::node::Topology;
use super::partition::partition;
use base::progress::Control;

/// Number of bins per dimension.
const BINS: usize = 16;

/// Minimum width of a dimension along which a cluster is split, relative to the widest dimension.
const MIN_WIDTH: f32 = 0.1;

/// Maximum size of a cluster that is sorted, not binned.
const SORTED: usize = 16;

/// Size above which both halves are built in parallel.
const PARALLEL: usize = 4096;

/// Maximum number of primitives that evaluate a split, evenly spaced in the order of the primitives.
const MAX_EVALUATED: usize = 1 << 14;

/// Bins along one dimension. Bounds fill a cache line each, so intensities are in an array of their own.
#[derive(Clone)]
struct AxisBins {
    bounds: [PrimitiveBounds; BINS],
    intensity: [f64; BINS],
}

const NO_BINS: AxisBins = AxisBins { bounds: [PrimitiveBounds::EMPTY; BINS], intensity: [0.0; BINS] };

/// Bins along all dimensions; the first ones are those that a cluster extends along.
type Bins = [AxisBins; DIMENSIONS];

/// Union of the bins on one side of a border.
struct BinUnion {
    bounds: PrimitiveBounds,
    intensity: f64,
}

impl BinUnion {
    const EMPTY: BinUnion = BinUnion { bounds: PrimitiveBounds::EMPTY, intensity: 0.0 };

    #[inline]
    fn add(&mut self, bounds: &PrimitiveBounds, intensity: f64) {
        self.bounds.add(bounds);
        self.intensity += intensity;
    }

    #[inline]
    fn add_one(&mut self, r: &Primitive) {
        self.add(&PrimitiveBounds::around_one(r), luminance(r));
    }
}

#[inline]
fn luminance(r: &Primitive) -> f64 {
    f64::from(r.0[LUMINANCE])
}

/// Builds a tree by recursive splits, unless `control` is cancelled; `c_sq` is the square of the scene's diagonal.
pub fn build(mut primitives: Vec<Primitive>, c_sq: f32, control: &Control) -> Option<Topology> {
    let mut left_sizes = vec![0; primitives.len().saturating_sub(1)];
    split_all(&mut primitives, &mut left_sizes, c_sq, control);
    (!control.is_cancelled()).then_some(Topology { leaves: primitives, left_sizes })
}

fn split_all(primitives: &mut [Primitive], left_sizes: &mut [u32], c_sq: f32, control: &Control) {
    let n = primitives.len();
    let Some((own, rest)) = left_sizes.split_first_mut() else { return };
    if n > SORTED && control.is_cancelled() {
        return;
    }
    let left = if n == 2 {
        1
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

/// Sorts a small cluster along its widest dimension; returns the size of the cheapest left part.
fn split_sorted(primitives: &mut [Primitive], c_sq: f32) -> usize {
    let bounds = PrimitiveBounds::around(primitives.iter());
    let half_c = 0.5 * c_sq.sqrt();
    let width = |lane: usize| bounds.width(lane, half_c);
    let widest = (1..DIMENSIONS).fold(0, |a, b| if width(b) > width(a) { b } else { a });
    // Insertion sort is stable, and the fastest for small clusters.
    for i in 1..primitives.len() {
        let mut j = i;
        while j > 0 && primitives[j].0[widest] < primitives[j - 1].0[widest] {
            primitives.swap(j, j - 1);
            j -= 1;
        }
    }
    let n = primitives.len();
    let mut right_costs = [0.0; SORTED];
    let mut sweep = BinUnion::EMPTY;
    for i in (1..n).rev() {
        sweep.add_one(&primitives[i]);
        right_costs[i] = cluster_cost(&sweep.bounds, sweep.intensity, c_sq);
    }
    let mut sweep = BinUnion::EMPTY;
    let mut best = (f64::INFINITY, n / 2);
    for i in 1..n {
        sweep.add_one(&primitives[i - 1]);
        let cost = cluster_cost(&sweep.bounds, sweep.intensity, c_sq) + right_costs[i];
        // If costs are equal (coincident VPLs), the cluster is halved.
        let balance = |k: usize| k.abs_diff(n / 2);
        if cost < best.0 || (cost == best.0 && balance(i) < balance(best.1)) {
            best = (cost, i);
        }
    }
    best.1
}

/// Partitions a large cluster at the cheapest of all bin borders in all dimensions; returns the left size.
#[inline(never)] // Its bins must not stay on the stack during the recursion.
fn split_binned(primitives: &mut [Primitive], c_sq: f32) -> usize {
    let evaluated = || primitives.iter().step_by(primitives.len().div_ceil(MAX_EVALUATED));
    let binning = Binning::new(&PrimitiveBounds::around(evaluated()), 0.5 * c_sq.sqrt());
    let mut bins: Bins = [NO_BINS; DIMENSIONS];
    binning.fill(evaluated(), &mut bins);
    let n = primitives.len();
    let Some((dimension, border)) = cheapest_border(&bins, &binning, c_sq) else { return n / 2 };
    let border = Binning::border(border);
    let left = partition(primitives, |r| binning.place(r, dimension) < border);
    if left == 0 || left == n { n / 2 } else { left }
}

/// Maps primitives to bins in every dimension at once.
struct Binning {
    min: [f32; 8],
    scale: [f32; 8],
    /// Dimensions that the primitives extend along: the first `count`. A flat wall has two of six.
    dimensions: [usize; DIMENSIONS],
    count: usize,
}

impl Binning {
    fn new(bounds: &PrimitiveBounds, half_c: f32) -> Binning {
        let mut binning = Binning { min: bounds.min, scale: [0.0; 8], dimensions: [0; DIMENSIONS], count: 0 };
        let width = |d: usize| bounds.width(d, half_c);
        let widest = (0..DIMENSIONS).map(width).fold(0.0, f32::max);
        for d in 0..DIMENSIONS {
            // The factor is slightly below 1, so that the maximum itself falls into the last bin.
            let scale = (1.0 - 1e-6) / bounds.extent(d);
            if scale.is_finite() && width(d) >= MIN_WIDTH * widest {
                binning.scale[d] = scale;
                binning.dimensions[binning.count] = d;
                binning.count += 1;
            }
        }
        binning
    }

    /// Returns the place along a dimension, in [1, 2), where the first bits of the mantissa are the number of the bin.
    /// Conversions to integers would not compile to vector code.
    #[inline]
    fn place(&self, r: &Primitive, d: usize) -> f32 {
        (r.0[d] - self.min[d]) * self.scale[d] + 1.0
    }

    /// Returns the place at which a bin begins.
    fn border(bin: usize) -> f32 {
        1.0 + bin as f32 / BINS as f32
    }

    fn fill<'a>(&self, primitives: impl Iterator<Item = &'a Primitive>, bins: &mut Bins) {
        for r in primitives {
            let (bounds, luminance) = (PrimitiveBounds::around_one(r), luminance(r));
            let mut bin = [0; 8];
            for (d, bin) in bin.iter_mut().enumerate() {
                *bin = self.place(r, d).to_bits() >> (f32::MANTISSA_DIGITS - 1 - BINS.ilog2());
            }
            for (d, row) in self.dimensions[..self.count].iter().zip(bins.iter_mut()) {
                let bin = bin[*d] as usize % BINS;
                row.bounds[bin].add(&bounds);
                row.intensity[bin] += luminance;
            }
        }
    }
}

/// Returns the dimension and the bin at which the cheapest split begins its right part.
fn cheapest_border(bins: &Bins, binning: &Binning, c_sq: f32) -> Option<(usize, usize)> {
    let mut best = None;
    let mut best_cost = f64::INFINITY;
    for (d, row) in binning.dimensions[..binning.count].iter().zip(bins) {
        let mut right_costs = [f64::INFINITY; BINS + 1];
        let mut sweep = BinUnion::EMPTY;
        for i in (1..BINS).rev() {
            right_costs[i] = right_costs[i + 1];
            if row.bounds[i].is_empty() {
                continue;
            }
            sweep.add(&row.bounds[i], row.intensity[i]);
            if sweep.intensity > 0.0 {
                right_costs[i] = cluster_cost(&sweep.bounds, sweep.intensity, c_sq);
            }
        }
        let mut sweep = BinUnion::EMPTY;
        for i in 1..BINS {
            // The parts on both sides of an empty bin are equal.
            if row.bounds[i - 1].is_empty() {
                continue;
            }
            sweep.add(&row.bounds[i - 1], row.intensity[i - 1]);
            if sweep.intensity > 0.0 && right_costs[i] < best_cost {
                let cost = cluster_cost(&sweep.bounds, sweep.intensity, c_sq) + right_costs[i];
                if cost < best_cost {
                    best_cost = cost;
                    best = Some((*d, i));
                }
            }
        }
    }
    best
}
