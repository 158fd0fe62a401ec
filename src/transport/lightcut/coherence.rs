//! Groups of points coherent enough to share a cut.

use base::math::LANES;
use glam::Vec3;
use rayon::prelude::*;

/// Weight of the difference of unit normals in [`group_compact`], relative to that of positions over the scene's
/// diagonal.
const NORMAL_WEIGHT: f32 = 0.01;

/// Number of items up to which one thread forms compact groups.
const PARALLEL: usize = 4096;

/// Position and normal of a point on a surface.
#[derive(Clone, Copy, Debug)]
pub struct OrientedPoint {
    /// Position.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
}

/// Number of groups open at once in [`group_coherent`].
const OPEN: usize = 8;

/// Limit on the differences between points that are likely to have nearly equal cuts.
#[derive(Clone, Copy, Debug)]
pub struct CoherenceLimit {
    /// Maximum distance.
    max_distance: f32,
}

impl CoherenceLimit {
    /// Minimum cosine between the normals.
    const MIN_COSINE: f32 = 0.8;

    /// Maximum distance over the scene's diagonal.
    const MAX_DISTANCE: f32 = 0.02;

    /// Creates the limit for a scene of this `diagonal`.
    pub fn of(diagonal: f32) -> CoherenceLimit {
        CoherenceLimit { max_distance: CoherenceLimit::MAX_DISTANCE * diagonal }
    }

    /// True if two points are within the limit.
    #[inline]
    pub fn holds(self, a: OrientedPoint, b: OrientedPoint) -> bool {
        let max_sq = self.max_distance * self.max_distance;
        a.position.distance_squared(b.position) <= max_sq
            && a.normal.dot(b.normal) >= CoherenceLimit::MIN_COSINE
    }
}

/// First item of a group under construction, and the group's size.
struct Head<K> {
    place: OrientedPoint,
    kind: K,
    size: usize,
}

/// Divides a list, in which neighbours in space are near each other, into groups of at most `max_size` items. Each item
/// is coherent with the first item of its group, and has the same kind.
pub fn group_coherent<T: Copy, K: PartialEq>(
    limit: CoherenceLimit,
    items: impl IntoIterator<Item = T>,
    max_size: usize,
    place: impl Fn(&T) -> OrientedPoint,
    kind: impl Fn(&T) -> K,
) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    // Heads are next to each other in memory: one thread compares all items with them.
    let mut heads: Vec<Head<K>> = Vec::new();
    for item in items {
        let (place, kind) = (place(&item), kind(&item));
        let open = heads.len().saturating_sub(OPEN);
        let joins =
            |head: &Head<K>| head.size < max_size && head.kind == kind && limit.holds(head.place, place);
        match heads[open..].iter().rposition(joins) {
            Some(found) => {
                heads[open + found].size += 1;
                groups[open + found].push(item);
            }
            None => {
                heads.push(Head { place, kind, size: 1 });
                groups.push(vec![item]);
            }
        }
    }
    groups
}

/// Divides a list into full and compact groups of up to sixteen items. The list is halved across its largest extent in
/// position or normal, again and again.
pub fn group_compact<T: Copy + Send>(
    items: Vec<T>,
    diagonal: f32,
    place: impl Fn(&T) -> OrientedPoint,
) -> Vec<Vec<T>> {
    let mut placed: Vec<([f32; 6], T)> = Vec::with_capacity(items.len());
    placed.extend(items.into_iter().map(|item| {
        let OrientedPoint { position, normal } = place(&item);
        let normal = normal.to_array().map(|x| x * NORMAL_WEIGHT * diagonal);
        let [[x, y, z], [u, v, w]] = [position.to_array(), normal];
        ([x, y, z, u, v, w], item)
    }));
    halve(&mut placed)
}

/// Divides items, given with their coordinates, into compact groups.
fn halve<T: Copy + Send>(items: &mut [([f32; 6], T)]) -> Vec<Vec<T>> {
    if items.len() <= LANES {
        let all = || items.iter().map(|(_, item)| *item).collect();
        return (!items.is_empty()).then(all).into_iter().collect();
    }
    let mut bounds = [[f32::INFINITY, f32::NEG_INFINITY]; 6];
    for (at, _) in &*items {
        for ([low, high], x) in bounds.iter_mut().zip(at) {
            (*low, *high) = (low.min(*x), high.max(*x));
        }
    }
    let extents = bounds.map(|[low, high]| high - low);
    let widest = (0..6).max_by(|&a, &b| extents[a].total_cmp(&extents[b])).unwrap_or(0);
    let order = |a: &([f32; 6], T), b: &([f32; 6], T)| a.0[widest].total_cmp(&b.0[widest]);
    let count = items.len().div_ceil(LANES);
    let middle = items.len() * (count / 2) / count;
    if items.len() <= PARALLEL {
        items.sort_by(order);
        let (left, right) = items.split_at_mut(middle);
        let mut groups = halve(left);
        groups.append(&mut halve(right));
        return groups;
    }
    items.par_sort_by(order);
    let (left, right) = items.split_at_mut(middle);
    let (mut groups, mut others) = rayon::join(|| halve(left), || halve(right));
    groups.append(&mut others);
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;

    #[test]
    fn compact_groups_are_full_and_hold_every_item_once() {
        for count in [0u32, 1, 16, 17, 33, 500] {
            let place =
                |&i: &u32| OrientedPoint { position: owen_sobol_2d(i, 3).extend(0.0), normal: Vec3::Z };
            let groups = group_compact((0..count).collect(), 2f32.sqrt(), place);
            assert_eq!(groups.len(), (count as usize).div_ceil(LANES));
            let mut all = groups.concat();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..count));
            for group in groups.iter().filter(|_| count == 500) {
                let distances = group.iter().map(|i| place(i).position.distance(place(&group[0]).position));
                assert!(distances.fold(0.0, f32::max) < 0.5, "neighbours share a group");
            }
        }
    }

    #[test]
    fn sides_of_a_wall_are_apart() {
        let side = |i: u32| if i.is_multiple_of(2) { Vec3::X } else { -Vec3::X };
        let place = |&i: &u32| OrientedPoint { position: Vec3::Y * (i / 2) as f32 * 0.05, normal: side(i) };
        let groups = group_compact((0..32).collect(), 100.0, place);
        assert!(groups.iter().all(|group| group.iter().all(|&i| side(i) == side(group[0]))));
    }
}
