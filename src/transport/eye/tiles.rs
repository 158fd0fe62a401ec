//! Pixels of a window, examined in parallel square by square.

use base::film::Image;
use base::parallel::ShortRuns;
use base::progress::Control;
use rayon::prelude::*;
use world::view::View;

/// Pixels along the edge of the square that one task examines.
const TILE: u32 = 32;

/// Maximum number of squares that are examined before their pixels are joined.
const TILES: usize = 256;

/// Looks through the pixels of a view's window; `look` returns those from a first to a last film pixel, by rows.
pub(super) fn by_tiles<T: Clone + Default + Send>(
    view: &View,
    control: &Control,
    look: impl Fn([u32; 2], [u32; 2]) -> Vec<T> + Sync,
) -> Image<T> {
    let window = &view.window;
    let mut pixels = vec![T::default(); window.pixel_count() as usize];
    let numbers: Vec<usize> = (0..window.tile_count(TILE)).collect();
    // Blocks of tiles bound the memory that pixels take twice.
    for numbers in numbers.chunks(TILES) {
        let look_at = |index: &usize| {
            if control.is_cancelled() {
                return Vec::new();
            }
            let mut tile = window.tile(*index, TILE).map(|at| window.film_pixel(at));
            let Some(first) = tile.next() else { return Vec::new() };
            look(first, tile.last().unwrap_or(first))
        };
        let tiles: Vec<Vec<T>> = numbers.par_iter().one_by_one().map(look_at).collect();
        for (number, tile) in numbers.iter().zip(tiles) {
            for (pixel, [x, y]) in tile.into_iter().zip(window.tile(*number, TILE)) {
                pixels[(y * window.width + x) as usize] = pixel;
            }
        }
    }
    Image { width: window.width, height: window.height, pixels }
}

/// Lists the film pixels from a first to a last one, by rows.
pub(super) fn pixels_between(first: [u32; 2], last: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (first[1]..=last[1]).flat_map(move |y| (first[0]..=last[0]).map(move |x| [x, y]))
}
