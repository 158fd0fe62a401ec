//! Surfaces that the views of a scene see together. Light that all views share is planned for them, and records are as
//! fine as their use by other views is worth.

use super::overlap::overlap;
use super::prepared::{MAX_SEEN, seen};
use base::progress::Control;
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
