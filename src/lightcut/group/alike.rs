//! Which points share a cut.

use glam::Vec3;

/// Fewer points than this have cuts of their own.
pub const LEAST_SHARED: usize = 4;
/// Points share a cut if the cosine between their normals is at least this ...
const LEAST_COSINE: f32 = 0.8;
/// ... and their distance at most this fraction of the scene's diagonal.
const LARGEST_DISTANCE: f32 = 0.02;
/// How many groups are open at once in [`group_alike`].
const OPEN: usize = 8;

/// Whether two points, each with its normal, are likely to have nearly the same cut.
#[inline]
pub fn alike(diagonal: f32, (a, a_normal): (Vec3, Vec3), (b, b_normal): (Vec3, Vec3)) -> bool {
    let limit = LARGEST_DISTANCE * diagonal;
    a.distance_squared(b) <= limit * limit && a_normal.dot(b_normal) >= LEAST_COSINE
}

/// Groups of at most `most` items that are pairwise alike with their first, from a list in which neighbours in space are
/// near each other; `same` excludes what must not be grouped for other reasons.
pub fn group_alike<T: Copy>(
    items: impl IntoIterator<Item = T>,
    most: usize,
    diagonal: f32,
    place: impl Fn(&T) -> (Vec3, Vec3),
    same: impl Fn(&T, &T) -> bool,
) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for item in items {
        let open = groups.len().saturating_sub(OPEN);
        let joins = |group: &&mut Vec<T>| {
            group.len() < most && same(&group[0], &item) && alike(diagonal, place(&group[0]), place(&item))
        };
        match groups[open..].iter_mut().rev().find(joins) {
            Some(group) => group.push(item),
            None => groups.push(vec![item]),
        }
    }
    groups
}
