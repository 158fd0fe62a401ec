//! Surfaces that the views of a scene see together. Light that all views share is planned for them, and records are as
//! fine as their use by other views is worth: as the mean number of views that see a surface.

use super::prepared::{MAX_SEEN, seen};
use base::progress::Control;
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use transport::eye::{EyePass, EyeSettings, PointGeometry};
use world::view::View;
use world::{SurfacePoint, World};

/// Maximum number of views that are looked at, spread over the list.
const VIEWS: usize = 256;

/// Longer side of the images that find the surfaces, in pixels.
const SIDE: u32 = 64;

/// Surfaces that the views of a scene see together.
#[derive(Clone, Debug, Default)]
pub struct Outlook {
    /// Visible surface points, spread over all views; empty if no light depends on them.
    pub points: Vec<SurfacePoint>,
    /// Mean number of views, among those that share records, that see a surface at similar distances.
    pub overlap: f32,
    /// Number of views.
    views: usize,
}

impl Outlook {
    /// Finds the surfaces that are seen in `views`, through mirrors and glass, too.
    pub fn new(world: &World, views: &[View], control: &Control) -> Outlook {
        let settings = EyeSettings { spp: 1, seed: 0, max_depth: world.scene.path_limit(None) };
        let count = views.len().min(VIEWS);
        let (mut points, mut shown) = (Vec::new(), Vec::new());
        for i in 0..count {
            let View { camera, window } = views[i * views.len() / count];
            let view = View::whole(camera, small(window.film));
            let eye = EyePass::trace(world, &view, settings, control);
            points.extend(seen(world, &eye, MAX_SEEN / count));
            let finer = view.window.film[0] as f32 / window.film[0] as f32;
            let place = |point: &PointGeometry| (point.position, point.spacing * finer);
            shown.push(eye.points.geometry.iter().map(place).collect());
        }
        // Views that are not looked at overlap as much as the others.
        let others = views.len().saturating_sub(1) as f32 / count.saturating_sub(1).max(1) as f32;
        let overlap = 1.0 + (overlap(&shown) - 1.0).max(0.0) * others;
        Outlook { points, overlap, views: views.len() }
    }

    /// Returns the outlook of chunks of `count` views, which alone share records.
    pub fn in_chunks(self, count: usize) -> Outlook {
        let [others, all] = [count.min(self.views), self.views].map(|n| n.saturating_sub(1) as f32);
        Outlook { overlap: 1.0 + (self.overlap - 1.0) * others / all.max(1.0), ..self }
    }
}

/// Returns the size of a small film of the same shape.
fn small(film: [u32; 2]) -> [u32; 2] {
    let longer = u64::from(film[0].max(film[1]).max(1));
    film.map(|side| (u64::from(side) * u64::from(SIDE.min(longer as u32))).div_ceil(longer).max(1) as u32)
}

/// Side of a cell in spacings of pixels: about the diameter of a record's footprint.
const CELL_SIDE: f32 = 16.0;

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
    (CELL_SIDE * spacing).max(f32::MIN_POSITIVE).log2().round() as i32
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
