//! Which points share a cut.

use glam::Vec3;

/// Fewer points than this have cuts of their own.
pub const MIN_SHARED: usize = 4;

/// What points have in common that share a cut.
#[derive(Clone, Copy, Debug)]
pub struct CoherenceLimit {
    /// Least cosine between their normals.
    cosine: f32,
    /// Largest distance, relative to the scene's diagonal.
    distance: f32,
    /// How many groups are open at once in [`group_coherent`].
    open: usize,
}

impl CoherenceLimit {
    /// They are likely to have nearly the same cut.
    pub const CLOSE: CoherenceLimit = CoherenceLimit { cosine: 0.8, distance: 0.02, open: 8 };
    /// Their cut is larger than that of each, but not by as much as they are many.
    pub const REMOTE: CoherenceLimit = CoherenceLimit { cosine: 0.5, distance: 0.05, open: 64 };

    /// Whether it holds between two points, each with its normal.
    #[inline]
    pub fn holds(self, diagonal: f32, (a, a_normal): (Vec3, Vec3), (b, b_normal): (Vec3, Vec3)) -> bool {
        let limit = self.distance * diagonal;
        a.distance_squared(b) <= limit * limit && a_normal.dot(b_normal) >= self.cosine
    }
}

/// Groups of at most `most` items that are alike with their first, from a list in which neighbours in space are
/// near each other; `same` excludes what must not be grouped for other reasons.
pub fn group_coherent<T: Copy>(
    likeness: CoherenceLimit,
    items: impl IntoIterator<Item = T>,
    most: usize,
    diagonal: f32,
    place: impl Fn(&T) -> (Vec3, Vec3),
    same: impl Fn(&T, &T) -> bool,
) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for item in items {
        let open = groups.len().saturating_sub(likeness.open);
        let joins = |group: &&mut Vec<T>| {
            group.len() < most
                && same(&group[0], &item)
                && likeness.holds(diagonal, place(&group[0]), place(&item))
        };
        match groups[open..].iter_mut().rev().find(joins) {
            Some(group) => group.push(item),
            None => groups.push(vec![item]),
        }
    }
    groups
}
