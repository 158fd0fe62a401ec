//! Checks of cameras.

use super::reach::{IN_REACH, MAX_COORDINATE, is_within_reach};
use crate::draft::DraftCamera;
use crate::error::{Location, SceneError};
use crate::local::LocalCoordinates;
use scene::{PixelFilter, Projection};

/// Maximum width of a pixel filter, in pixels.
const MAX_FILTER: f32 = 1e3;

/// Rejects cameras with rays that f32 cannot represent.
///
/// `place` is the location of the main file.
pub(crate) fn check_camera(
    camera: &DraftCamera,
    coordinates: &LocalCoordinates,
    place: &Location,
) -> Result<(), SceneError> {
    if !is_within_reach(camera.origin, coordinates) {
        return Err(place.wrong(format!("a camera stands at {}", camera.origin), IN_REACH));
    }
    let camera = coordinates.local_camera(camera);
    let lens = match camera.projection {
        Projection::Lens { radius, distance } => [radius, distance],
        Projection::Pinhole | Projection::Parallel => [1.0; 2],
    };
    let is_length = |length: f32| length > 0.0 && length <= MAX_COORDINATE as f32;
    let is_film = is_length(camera.pixel_height) && camera.shift.iter().all(|shift| shift.is_finite());
    if !is_film
        || !is_length(camera.tan_half_x)
        || !lens.into_iter().all(is_length)
        || camera.near > MAX_COORDINATE as f32
    {
        let what = "the size of a camera's image, lens, focus or near plane is invalid";
        return Err(place.wrong(what, "give numbers above 0, up to 1e18 times the scene's size"));
    }
    let (PixelFilter::Tent { radius: width } | PixelFilter::Gaussian { deviation: width }) = camera.filter
    else {
        return Ok(());
    };
    match width > 0.0 && width <= MAX_FILTER {
        true => Ok(()),
        false => {
            Err(place
                .wrong(format!("the film's filter is {width} pixels wide"), "give more than 0, up to 1000"))
        }
    }
}
