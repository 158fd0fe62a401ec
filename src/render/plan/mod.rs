//! Settings planned for a goal: a time, or an error.
//!
//! | | goal | plan | result |
//! |---|---|---|---|
//! | [`for_time`] | seconds of the run | by small renders and a model of cost, then on the picture | the wall clock |
//! | [`for_error`] | relative RMS error | by renders of rising cost compared with paths | measured on the picture |
//!
//! Both move along one [`Ladder`] of settings. Settings given by the user are pinned. For an error, settings
//! are raised until the picture meets it.
//!
//! Where the user leaves the method open, a [`Chooser`] takes the cache or denoised paths first.
//!
//! A time's settings depend on the machine and on its other load: two runs may differ. An error's do not: the
//! same input gives the same settings and bits. Either way the chosen settings are reported, and give the
//! same picture again when typed.

mod choice;
mod cost;
mod error;
mod ladder;
mod pilot;
mod time;
mod tune;
mod work;

use base::film::Window;
use world::view::View;

pub use choice::{Choice, Chooser, Reason};
pub use error::{Asked, for_error};
pub use ladder::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE, options};
pub use time::{LATE, for_time};
pub use work::Work;

/// The same view on a film `scale` times smaller along each side.
pub fn smaller(view: &View, scale: u32) -> View {
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
    use scene::Camera;

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
