//! One exposure for all frames of a path, so that brightness does not jump.
//!
//! The result is the automatic exposure of small images at frames spread over the whole path, taken together. So it
//! does not depend on the frames that are rendered.

use crate::method::{path, render};
use crate::session::Session;
use base::film::{Exposure, Image};
use base::progress::Control;
use scene::Cameras;
use world::view::View;

/// Number of small images.
const FRAMES: usize = 8;
/// Longer side of the small images, in pixels.
const SIDE: u32 = 32;
/// Samples per pixel of the small images.
const SPP: u32 = 16;

/// Returns the stops by which the radiance of all frames of the session's path is scaled for display.
pub fn over_path(session: &Session, resolution: [u32; 2], control: &Control) -> f32 {
    let Cameras { path: cameras, .. } = &session.cameras;
    let longer = resolution[0].max(resolution[1]).max(1);
    let small =
        resolution.map(|side| (side as u64 * u64::from(SIDE)).div_ceil(u64::from(longer)).max(1) as u32);
    let last = cameras.len().saturating_sub(1);
    let mut frames: Vec<usize> = (0..FRAMES).map(|i| (i * last + (FRAMES - 1) / 2) / (FRAMES - 1)).collect();
    frames.dedup();
    let settings = path::Settings { spp: SPP, ..path::Settings::default() };
    let seen = frames.into_iter().filter_map(|frame| cameras.get(frame)).flat_map(|camera| {
        let view = View::whole(*camera, small);
        render(&session.world, &view, &settings, control).color.pixels
    });
    let pixels: Vec<_> = seen.collect();
    let together = Image { width: pixels.len() as u32, height: 1, pixels };
    Exposure::Auto.factor(&together).log2()
}
