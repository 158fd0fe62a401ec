//! Groups of points coherent enough to share a cut.

use base::math::LANES;
use glam::Vec3;

/// Fewer points than this have cuts of their own.
pub const MIN_SHARED: usize = 4;

/// Limit on the differences between points that share a cut.
#[derive(Clone, Copy, Debug)]
pub struct CoherenceLimit {
    /// Minimum cosine between their normals.
    min_cosine: f32,
    /// Maximum distance, relative to the scene's diagonal.
    max_distance: f32,
    /// Number of groups open at once in [`group_coherent`].
    open: usize,
}

impl CoherenceLimit {
    /// Points likely to have nearly the same cut.
    pub const CLOSE: CoherenceLimit = CoherenceLimit { min_cosine: 0.8, max_distance: 0.02, open: 8 };
    /// Points whose common cut is larger than that of each, but not by as much as they are many.
    pub const REMOTE: CoherenceLimit = CoherenceLimit { min_cosine: 0.5, max_distance: 0.05, open: 64 };

    /// True if two points, each with its normal, are within the limit.
    #[inline]
    pub fn holds(self, diagonal: f32, (a, a_normal): (Vec3, Vec3), (b, b_normal): (Vec3, Vec3)) -> bool {
        let limit = self.max_distance * diagonal;
        a.distance_squared(b) <= limit * limit && a_normal.dot(b_normal) >= self.min_cosine
    }
}

/// Groups of at most `max_size` items that are each coherent with its first, from a list in which neighbours
/// in space are near each other; `same` excludes pairs that must not be grouped for other reasons.
pub fn group_coherent<T: Copy>(
    limit: CoherenceLimit,
    items: impl IntoIterator<Item = T>,
    max_size: usize,
    diagonal: f32,
    place: impl Fn(&T) -> (Vec3, Vec3),
    same: impl Fn(&T, &T) -> bool,
) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for item in items {
        let open = groups.len().saturating_sub(limit.open);
        let joins = |group: &&mut Vec<T>| {
            group.len() < max_size
                && same(&group[0], &item)
                && limit.holds(diagonal, place(&group[0]), place(&item))
        };
        match groups[open..].iter_mut().rev().find(joins) {
            Some(group) => group.push(item),
            None => groups.push(vec![item]),
        }
    }
    groups
}

/// Weight of the difference of unit normals in [`group_compact`], relative to that of positions over the scene's
/// diagonal.
const NORMAL_WEIGHT: f32 = 0.01;

/// Groups of up to sixteen items, as full and compact as can be: the list is halved across its largest extent in
/// position or normal, again and again.
pub fn group_compact<T: Copy>(
    mut items: Vec<T>,
    diagonal: f32,
    place: impl Fn(&T) -> (Vec3, Vec3),
) -> Vec<Vec<T>> {
    let key = |item: &T, axis: usize| {
        let (position, normal) = place(item);
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
            let place = |&i: &u32| (owen_sobol_2d(i, 3).extend(0.0), Vec3::Z);
            let groups = group_compact((0..count).collect(), 2f32.sqrt(), place);
            assert_eq!(groups.len(), (count as usize).div_ceil(LANES));
            let mut all = groups.concat();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..count));
            for group in groups.iter().filter(|_| count == 500) {
                let distances = group.iter().map(|i| place(i).0.distance(place(&group[0]).0));
                assert!(distances.fold(0.0, f32::max) < 0.5, "neighbours share a group");
            }
        }
    }

    #[test]
    fn sides_of_a_wall_are_apart() {
        let side = |i: u32| if i.is_multiple_of(2) { Vec3::X } else { -Vec3::X };
        let groups = group_compact((0..32).collect(), 100.0, |&i| (Vec3::Y * (i / 2) as f32 * 0.05, side(i)));
        assert!(groups.iter().all(|group| group.iter().all(|&i| side(i) == side(group[0]))));
    }
}
