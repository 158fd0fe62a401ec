//! Small films, for renders that are faster than the one planned.

use base::film::Window;
use world::view::View;

/// Returns the view on a film `scale` times smaller along each side.
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
