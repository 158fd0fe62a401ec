//! Overlap of views: the mean number of views that see a surface.

use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Side of a cell in spacings of pixels: about the diameter of a record's footprint.
const SIDE: f32 = 16.0;

/// Levels of cells from a view's own level that count as seen alike: half and double the distance.
const LEVELS: i32 = 1;

/// A cell of space: binary logarithm of its side, and its place.
type Cell = (i32, [i64; 3]);

/// A visible point, and the distance to the point of the next pixel.
pub type SeenPoint = (Vec3, f32);

/// Returns the mean number of views that see the surface at a point of a view, with that view itself.
///
/// Views that see a surface at very different distances do not count, because they share few records.
pub fn overlap(views: &[Vec<SeenPoint>]) -> f32 {
    let mut seen_by: BTreeMap<Cell, u32> = BTreeMap::new();
    for view in views {
        let around = |point: &SeenPoint| {
            let level = level(point);
            (level - LEVELS..=level + LEVELS).map(|level| cell(point, level)).collect::<Vec<_>>()
        };
        let cells: BTreeSet<Cell> = view.iter().flat_map(around).collect();
        for cell in cells {
            *seen_by.entry(cell).or_default() += 1;
        }
    }
    let count = |point: &SeenPoint| u64::from(seen_by.get(&cell(point, level(point))).copied().unwrap_or(1));
    let (points, sum) = views.iter().flatten().fold((0u64, 0u64), |(n, sum), p| (n + 1, sum + count(p)));
    sum as f32 / points.max(1) as f32
}

fn level((_, spacing): &SeenPoint) -> i32 {
    (SIDE * spacing).max(f32::MIN_POSITIVE).log2().round() as i32
}

fn cell((position, _): &SeenPoint, level: i32) -> Cell {
    let scale = (-level as f32).exp2();
    (level, position.to_array().map(|x| (x * scale).floor() as i64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a square on the floor, seen with this spacing.
    fn square(x: f32, spacing: f32) -> Vec<SeenPoint> {
        let at = |i: usize| Vec3::new(x + (i % 32) as f32 / 8.0, 0.01, (i / 32) as f32 / 8.0);
        (0..1024).map(|i| (at(i), spacing)).collect()
    }

    #[test]
    fn views_of_one_place_overlap_and_others_do_not() {
        let spacing = 1.0 / 32.0;
        let near = |a: f32, b: f32| assert!((a - b).abs() < 0.1 * b, "{a} {b}");
        assert_eq!(overlap(&[]), 0.0);
        near(overlap(&[square(0.0, spacing)]), 1.0);
        near(overlap(&vec![square(0.0, spacing); 6]), 6.0);
        near(overlap(&[square(0.0, spacing), square(100.0, spacing)]), 1.0);
        near(overlap(&[square(0.0, spacing), square(2.0, spacing)]), 1.5);
        // Twice the distance counts, and eight times the distance does not.
        near(overlap(&[square(0.0, spacing), square(0.0, 2.0 * spacing)]), 2.0);
        near(overlap(&[square(0.0, spacing), square(0.0, 8.0 * spacing)]), 1.0);
    }
}
