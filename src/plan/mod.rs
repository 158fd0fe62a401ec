//! Settings planned from what is wanted: a time, or an error.
//!
//! | | asked | planned | got |
//! |---|---|---|---|
//! | [`for_time`] | seconds of the whole run | from a few small renders of the same film and a model of cost, then on the picture itself | the wall clock |
//! | [`for_error`] | relative RMS error | by renders from cheap to dear held to traced paths | measured on the picture itself, settings raised until it is met |
//!
//! Both move along one [`Ladder`] of settings. What the user has typed is held.
//!
//! A time's settings depend on the machine and on what else it does: two runs may differ. An error's do not: the
//! same input gives the same settings and bits. Either way the settings chosen are told, and render the same
//! picture again when typed.

mod cost;
mod error;
mod ladder;
mod time;
mod tune;

use crate::film::Window;
use crate::view::View;

pub use error::{Asked, for_error};
pub use ladder::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE, options};
pub use time::{LATE, for_time};

/// The same view on a film `scale` times smaller along each side.
fn smaller(view: &View, scale: u32) -> View {
    let window = &view.window;
    let side = |n: u32| n.div_ceil(scale).max(1);
    let film = window.film.map(side);
    let offset = [0, 1].map(|k| (window.offset[k] / scale).min(film[k] - 1));
    let [width, height] =
        [(0, window.width), (1, window.height)].map(|(k, size)| side(size).min(film[k] - offset[k]));
    View { window: Window { film, offset, width, height }, ..*view }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;

    #[test]
    fn small_films_are_valid_whatever_the_crop() {
        let small = |window, scale| smaller(&View { camera: Camera::default(), window }, scale).window;
        let crop = Window { film: [97, 41], offset: [90, 3], width: 7, height: 38 };
        for window in [crop, Window::whole([1, 1]), Window::whole([1, 500]), Window::whole([512, 512])] {
            for scale in [1, 2, 4, 8, 1000] {
                assert!(small(window, scale).is_valid(), "{window:?} {scale}");
            }
            assert_eq!(small(window, 1), window);
        }
        assert_eq!(small(Window::whole([512, 256]), 8), Window::whole([64, 32]));
    }
}
