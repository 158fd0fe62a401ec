//! Surfaces that the views of a scene see together. Light that all views share is planned for them.

use super::prepared::{MAX_SEEN, seen};
use base::progress::Control;
use transport::eye::{EyePass, EyeSettings};
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
}

impl Outlook {
    /// Finds the surfaces that are seen in `views`, through mirrors and glass, too.
    pub fn new(world: &World, views: &[View], control: &Control) -> Outlook {
        if !world.emitters.have_far() || views.is_empty() {
            return Outlook::default();
        }
        let settings = EyeSettings { spp: 1, seed: 0, max_depth: world.scene.path_limit(None) };
        let count = views.len().min(VIEWS);
        let look = |i: usize| {
            let View { camera, window } = views[i * views.len() / count];
            let view = View::whole(camera, small(window.film));
            seen(world, &EyePass::trace(world, &view, settings, control), MAX_SEEN / count)
        };
        Outlook { points: (0..count).flat_map(look).collect() }
    }
}

/// Returns the size of a small film of the same shape.
fn small(film: [u32; 2]) -> [u32; 2] {
    let longer = u64::from(film[0].max(film[1]).max(1));
    film.map(|side| (u64::from(side) * u64::from(SIDE.min(longer as u32))).div_ceil(longer).max(1) as u32)
}
