//! Building of the binary tree, top-down by binned splits in position.
//!
//! Paper: Conty Estevez & Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, 2018, section 4.4.
//!
//! Deviations: no penalty for thin boxes, and no splits in orientation.

use super::bounds::EmitterBounds;

/// Number of bins along each axis.
const BINS: usize = 16;

/// A node of the binary tree.
pub struct BinaryNode {
    /// Bounds of the emitters below it.
    pub bounds: EmitterBounds,
    /// Indices of both children, or of the emitter.
    pub content: Content,
}

/// Content of a binary node.
#[derive(Clone, Copy)]
pub enum Content {
    /// Nodes below.
    Children([usize; 2]),
    /// A single emitter.
    Emitter(usize),
}

/// Builds a tree over emitters. The root comes last.
pub fn build(emitters: &[EmitterBounds]) -> Vec<BinaryNode> {
    let mut nodes = Vec::with_capacity(2 * emitters.len());
    let mut order: Vec<usize> = (0..emitters.len()).collect();
    if !order.is_empty() {
        build_below(emitters, &mut order, &mut nodes);
    }
    nodes
}

/// Adds the nodes over the emitters in `order`. The topmost node comes last.
fn build_below(emitters: &[EmitterBounds], order: &mut [usize], nodes: &mut Vec<BinaryNode>) {
    if let [emitter] = *order {
        nodes.push(BinaryNode { bounds: emitters[emitter], content: Content::Emitter(emitter) });
        return;
    }
    let middle = split(emitters, order);
    let (left, right) = order.split_at_mut(middle);
    let children = [left, right].map(|part| {
        build_below(emitters, part, nodes);
        nodes.len() - 1
    });
    let bounds = nodes[children[0]].bounds.union(&nodes[children[1]].bounds);
    nodes.push(BinaryNode { bounds, content: Content::Children(children) });
}

/// Sorts the emitters in `order` into two sets at the bin border of least cost. Returns the number of emitters in the
/// first set.
fn split(emitters: &[EmitterBounds], order: &mut [usize]) -> usize {
    let centre = |emitter: usize| 0.5 * (emitters[emitter].low + emitters[emitter].high);
    let low = order.iter().map(|e| centre(*e)).reduce(|a, b| a.min(b)).unwrap_or_default();
    let high = order.iter().map(|e| centre(*e)).reduce(|a, b| a.max(b)).unwrap_or_default();
    let bin = |emitter: usize, axis: usize| {
        let place = (centre(emitter)[axis] - low[axis]) / (high[axis] - low[axis]);
        ((place * BINS as f32) as usize).min(BINS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|axis| high[*axis] > low[*axis]) {
        let mut bins = [None; BINS];
        for emitter in order.iter() {
            grow(&mut bins[bin(*emitter, axis)], Some(emitters[*emitter]));
        }
        let mut above = bins;
        for i in (0..BINS - 1).rev() {
            let next = above[i + 1];
            grow(&mut above[i], next);
        }
        let mut below = None;
        for i in 0..BINS - 1 {
            grow(&mut below, bins[i]);
            let (Some(before), Some(after)) = (&below, &above[i + 1]) else { continue };
            let cost = before.cost() + after.cost();
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, axis, i));
            }
        }
    }
    // Emitters at one position are halved.
    let Some((_, axis, last)) = best else { return order.len() / 2 };
    order.sort_by_key(|emitter| bin(*emitter, axis) > last);
    order.partition_point(|emitter| bin(*emitter, axis) <= last)
}

/// Extends bounds by other bounds, if there are any.
fn grow(bounds: &mut Option<EmitterBounds>, by: Option<EmitterBounds>) {
    *bounds = match (*bounds, by) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    };
}
