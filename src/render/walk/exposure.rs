//! One exposure for all frames of a path or all views of a list, so that brightness does not jump.
//!
//! The result is the automatic exposure of small images at frames spread over the whole path or list, taken
//! together. So it does not depend on the frames that are rendered.

use crate::method::{path, render};
use crate::session::Session;
use base::film::Image;
use base::film::tone::auto_factor;
use base::math::Rgb;
use base::progress::Control;
use scene::{Camera, Cameras};
use world::view::View;

/// Number of small images of a path.
const FRAMES: usize = 8;
/// Maximum number of small images of a list of views, which differ more than the frames of a path.
const VIEWS: usize = 64;
/// Longer side of the small images, in pixels.
const SIDE: u32 = 32;
/// Samples per pixel of the small images.
const SPP: u32 = 16;

/// Returns the stops by which the radiance of all frames of the session's path is scaled for display.
pub fn over_path(session: &Session, resolution: [u32; 2], control: &Control) -> f32 {
    let Cameras { path: cameras, .. } = &session.cameras;
    let small = View::whole(Camera::default(), small(resolution));
    let chosen = spread(cameras.len(), FRAMES).filter_map(|frame| cameras.get(frame));
    over(session, chosen.map(|camera| View { camera: *camera, ..small }), control)
}

/// Returns the stops by which the radiance of all `views` is scaled for display.
pub fn over_views(session: &Session, views: &[View], control: &Control) -> f32 {
    let chosen = spread(views.len(), VIEWS).filter_map(|i| views.get(i));
    over(session, chosen.map(|view| View::whole(view.camera, small(view.window.film))), control)
}

/// Returns at most `most` of `count` indices, evenly spread from the first to the last.
pub(super) fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let last = count.saturating_sub(1);
    let mut chosen: Vec<usize> = (0..most).map(|i| (i * last + (most - 1) / 2) / (most - 1)).collect();
    chosen.dedup();
    chosen.into_iter()
}

/// Returns the common exposure of small images.
fn over(session: &Session, small: impl Iterator<Item = View>, control: &Control) -> f32 {
    let settings = path::Settings { spp: SPP, ..path::Settings::default() };
    let seen = small.flat_map(|view| render(&session.world, &view, &settings, control).color.pixels);
    // Black pixels show a hidden background, or little of a surface.
    let hides = session.world.scene.hides_background;
    let pixels: Vec<Rgb> = seen.filter(|pixel| !hides || *pixel != Rgb::ZERO).collect();
    let together = Image { width: pixels.len() as u32, height: 1, pixels };
    auto_factor(&together).log2()
}

/// Returns the size of a small film of the same shape.
fn small(film: [u32; 2]) -> [u32; 2] {
    let longer = film[0].max(film[1]).max(1);
    film.map(|side| (u64::from(side) * u64::from(SIDE)).div_ceil(u64::from(longer)).max(1) as u32)
}
