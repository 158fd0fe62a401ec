//! One exposure for all frames of a path, so that brightness does not jump: the automatic exposure of small pictures at
//! frames spread over the whole path, put together. Any part of the path has the same.

use crate::method::{path, render};
use crate::session::Session;
use base::film::{Exposure, Image};
use base::progress::Control;
use scene::Cameras;
use world::view::View;

/// Number of frames looked at.
const FRAMES: usize = 8;
/// Longer side of the pictures of those, in pixels.
const SIDE: u32 = 32;
/// Samples a pixel of these.
const SPP: u32 = 16;

/// Stops by which the radiance of all frames of the session's path is to be scaled for display.
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
