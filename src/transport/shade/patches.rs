//! Patches: groups of shading points coherent enough to be shaded together.

use super::{ShadeSettings, ShadingTask};
use crate::eye::{PointGeometry, ShadingPoints, edge_class};
use crate::lightcut::{CoherenceLimit, OrientedPoint, group_coherent, group_compact};
use base::math::{Frame, LANES};
use std::collections::HashMap;

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
    let kind = |task: &ShadingTask| {
        let point = task.point as usize;
        let edges = edge_class(points.geometry[point].edges);
        (task.lobe_only, task.origin, points.surfaces.lobe_list(point), edges)
    };
    let all = tasks.iter().copied();
    let patches = group_coherent(CoherenceLimit::of(diagonal), all, max_size, place, kind);
    // A cut costs nearly as much for few points as for sixteen, so remnants are grouped again, into full groups. All
    // their points are anchors: they are far apart, and light that reaches one of them need not reach its neighbours.
    let (mut patches, remnants): (Vec<_>, Vec<_>) =
        patches.into_iter().partition(|patch| patch.len() >= MIN_PATCH);
    let (mut alike, mut places) = (Vec::<Vec<ShadingTask>>::new(), HashMap::new());
    for remnant in remnants {
        let place = *places.entry(kind(&remnant[0])).or_insert(alike.len());
        if place == alike.len() {
            alike.push(Vec::new());
        }
        alike[place].extend(remnant);
    }
    patches.extend(alike.into_iter().flat_map(|tasks| group_compact(tasks, diagonal, place)));
    patches
}

/// Moves a group for a shared cut out of the points `left`, in order. The group is the first point and up to fifteen
/// points coherent with it, or the first point alone if points share no cuts. Returns false if no point is left.
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
    let joins = |point: &u32| CoherenceLimit::of(diagonal).holds(place(first), place(*point));
    let count = left.iter().filter(|point| joins(point)).take(LANES).count();
    let count = if settings.share { count } else { 1 };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eye::PointSurface;
    use crate::lightcut::fixtures::all_materials;
    use base::sampling::{owen_sobol_2d, uniform_sphere};
    use glam::Vec2;
    use scene::MaterialId;
    use world::material::Materials;

    #[test]
    fn remnants_make_full_patches_of_equal_lobes() {
        let scene = all_materials();
        let materials = Materials::new(&scene);
        let bsdfs = [0, 2, 4].map(|material| materials.at(MaterialId(material), Vec2::ZERO));
        let mut points = ShadingPoints::default();
        for i in 0..500 {
            let (position, normal) = (owen_sobol_2d(i, 3).extend(0.0), uniform_sphere(owen_sobol_2d(i, 5)));
            let geometry = PointGeometry {
                position,
                spacing: 0.01,
                normal,
                coat: 0,
                is_chained: false,
                edges: u16::MAX,
            };
            points.geometry.push(geometry);
            let bsdf = bsdfs[usize::from(i % 5 == 0) + usize::from(i % 10 == 0)];
            points.surfaces.push(&PointSurface { bsdf, geometric_normal: normal, out: normal });
        }
        let tasks: Vec<ShadingTask> = (0..500).map(ShadingTask::all).collect();
        let patches = patches(&points, &tasks, 1, 1.0);
        let lobes = |task: &ShadingTask| points.surfaces.get(task.point as usize).bsdf;
        for patch in &patches {
            assert!(patch.iter().all(|task| lobes(task).same_lobes(&lobes(&patch[0]))));
        }
        let mut all: Vec<u32> = patches.iter().flatten().map(|task| task.point).collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..500));
        // 400, 50 and 50 points have equal lobes.
        assert_eq!(patches.len(), 25 + 4 + 4);
    }
}
