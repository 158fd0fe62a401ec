//! Patches: groups of shading points coherent enough to be shaded together.

use super::{ShadeSettings, ShadingTask};
use crate::eye::{PointGeometry, ShadingPoints};
use crate::lightcut::{CoherenceLimit, OrientedPoint, group_coherent};
use base::math::{Frame, LANES};

/// Minimum number of points of a patch. In smaller patches too few points are interpolated to repay the sixteen
/// anchors.
const MIN_PATCH: usize = 64;

/// Divides tasks into patches. Neighbours in space must be near each other in the list. There are about `count` patches
/// if there is one task for each point.
pub fn patches(
    points: &ShadingPoints,
    tasks: &[ShadingTask],
    count: u32,
    diagonal: f32,
) -> Vec<Vec<ShadingTask>> {
    let max_size = (points.len() / count.max(1) as usize).max(MIN_PATCH);
    let place = |task: &ShadingTask| place(&points.geometry[task.point as usize]);
    let bsdf = |task: &ShadingTask| points.surfaces.get(task.point as usize).bsdf;
    let same = |a: &ShadingTask, b: &ShadingTask| {
        a.lobe_only == b.lobe_only && a.origin == b.origin && bsdf(a).same_lobes(&bsdf(b))
    };
    let all = tasks.iter().copied();
    let patches = group_coherent(CoherenceLimit::close(diagonal), all, max_size, place, same);
    // A cut costs nearly as much for few points as for sixteen, so remnants are grouped with less coherence. All their
    // points are anchors: they are far apart, and light that reaches one of them need not reach its neighbours.
    let (mut patches, remnants): (Vec<_>, Vec<_>) =
        patches.into_iter().partition(|patch| patch.len() >= MIN_PATCH);
    let remnants = remnants.into_iter().flatten();
    patches.extend(group_coherent(CoherenceLimit::remote(diagonal), remnants, LANES, place, same));
    patches
}

/// Moves a group for a shared cut out of the points `left`, in order. The group is the first point and up to fifteen
/// points coherent with it, or the first point alone if there are too few. Returns false if no point is left.
pub(super) fn next_group(
    points: &ShadingPoints,
    settings: &ShadeSettings,
    diagonal: f32,
    left: &mut Vec<u32>,
    group: &mut Vec<ShadingTask>,
) -> bool {
    group.clear();
    let Some(&first) = left.first() else { return false };
    let place = |point: u32| place(&points.geometry[point as usize]);
    let joins = |point: &u32| CoherenceLimit::close(diagonal).holds(place(first), place(*point));
    let count = left.iter().filter(|point| joins(point)).take(LANES).count();
    let count = if settings.shares(count) { count } else { 1 };
    left.retain(|&point| {
        let joins = group.len() < count && (point == first || joins(&point));
        if joins {
            group.push(ShadingTask::all(point));
        }
        !joins
    });
    true
}

/// Returns which tasks of a patch are its anchors: the outermost points, so that light is never extrapolated, and
/// points at a regular stride.
pub(super) fn anchors(points: &ShadingPoints, patch: &[ShadingTask]) -> Vec<bool> {
    if patch.len() <= LANES {
        return vec![true; patch.len()];
    }
    let point = |task: &ShadingTask| &points.geometry[task.point as usize];
    let frame = Frame::from_normal(point(&patch[0]).normal);
    let mut anchors = vec![false; patch.len()];
    let axes = [frame.tangent, -frame.tangent, frame.bitangent, -frame.bitangent];
    for axis in axes {
        let along = |i: &usize| point(&patch[*i]).position.dot(axis);
        let outermost = (0..patch.len()).max_by(|a, b| along(a).total_cmp(&along(b)));
        outermost.into_iter().for_each(|i| anchors[i] = true);
    }
    let stride = patch.len().div_ceil(LANES - axes.len());
    anchors.iter_mut().skip(stride / 2).step_by(stride).for_each(|anchor| *anchor = true);
    anchors
}

fn place(point: &PointGeometry) -> OrientedPoint {
    OrientedPoint { position: point.position, normal: point.normal }
}
