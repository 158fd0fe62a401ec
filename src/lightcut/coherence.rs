//! Groups of points coherent enough to share a cut.

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
