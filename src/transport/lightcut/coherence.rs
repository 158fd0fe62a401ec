//! Groups of points coherent enough to share a cut.

use base::math::LANES;
use glam::Vec3;

/// Minimum number of points that share a cut.
pub const MIN_SHARED: usize = 4;

/// Weight of the difference of unit normals in [`group_compact`], relative to that of positions over the scene's
/// diagonal.
const NORMAL_WEIGHT: f32 = 0.01;

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

/// Divides a list, in which neighbours in space are near each other, into groups of at most `max_size` items. Each item
/// is coherent with the first item of its group, and `same` holds for the pair.
pub fn group_coherent<T: Copy>(
    limit: CoherenceLimit,
    items: impl IntoIterator<Item = T>,
    max_size: usize,
    place: impl Fn(&T) -> OrientedPoint,
    same: impl Fn(&T, &T) -> bool,
) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for item in items {
        let open = groups.len().saturating_sub(OPEN);
        let joins = |group: &&mut Vec<T>| {
            group.len() < max_size && same(&group[0], &item) && limit.holds(place(&group[0]), place(&item))
        };
        match groups[open..].iter_mut().rev().find(joins) {
            Some(group) => group.push(item),
            None => groups.push(vec![item]),
        }
    }
    groups
}

/// Divides a list into full and compact groups of up to sixteen items. The list is halved across its largest extent in
/// position or normal, again and again.
pub fn group_compact<T: Copy>(
    mut items: Vec<T>,
    diagonal: f32,
    place: impl Fn(&T) -> OrientedPoint,
) -> Vec<Vec<T>> {
    let key = |item: &T, axis: usize| {
        let OrientedPoint { position, normal } = place(item);
        if axis < 3 { position[axis] } else { normal[axis - 3] * NORMAL_WEIGHT * diagonal }
    };
    let mut groups = Vec::new();
    let mut parts = vec![&mut items[..]];
    while let Some(part) = parts.pop() {
        if part.len() <= LANES {
            groups.extend((!part.is_empty()).then(|| part.to_vec()));
            continue;
        }
        let extent = |axis: usize| {
            let values = || part.iter().map(|item| key(item, axis));
            values().fold(f32::NEG_INFINITY, f32::max) - values().fold(f32::INFINITY, f32::min)
        };
        let extents: [f32; 6] = std::array::from_fn(extent);
        let widest = (0..6).max_by(|&a, &b| extents[a].total_cmp(&extents[b])).unwrap_or(0);
        part.sort_by(|a, b| key(a, widest).total_cmp(&key(b, widest)));
        let count = part.len().div_ceil(LANES);
        let (left, right) = part.split_at_mut(part.len() * (count / 2) / count);
        parts.extend([right, left]);
    }
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
