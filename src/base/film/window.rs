//! The rendered part of the film.

use crate::sampling::owen_sobol_2d;

/// A rectangle of pixels of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Width and height of the whole film in pixels.
    pub film: [u32; 2],
    /// First column and row of the rectangle.
    pub offset: [u32; 2],
    /// Columns rendered.
    pub width: u32,
    /// Rows rendered.
    pub height: u32,
}

impl Window {
    /// Returns the whole film.
    pub fn whole(film: [u32; 2]) -> Window {
        Window { film, offset: [0, 0], width: film[0], height: film[1] }
    }

    /// Returns `count` squares of `length` pixels (less on smaller films), spread evenly over a film.
    pub fn spread(film: [u32; 2], length: u32, count: u32, seed: u32) -> impl Iterator<Item = Window> {
        let [width, height] = film.map(|pixels| pixels.min(length));
        (0..count).map(move |i| {
            let at = owen_sobol_2d(i, seed);
            let offset = |at: f32, film: u32, length: u32| (at * (film - length + 1) as f32) as u32;
            Window {
                film,
                offset: [offset(at.x, film[0], width), offset(at.y, film[1], height)],
                width,
                height,
            }
        })
    }

    /// Returns a film pixel by its number in a sequence that spreads evenly over the film.
    pub fn spread_pixel(&self, number: u32, seed: u32) -> [u32; 2] {
        let at = owen_sobol_2d(number, seed);
        [0, 1].map(|axis| ((at[axis] * self.film[axis] as f32) as u32).min(self.film[axis] - 1))
    }

    /// Returns the number of rendered pixels.
    pub fn pixel_count(&self) -> u64 {
        self.width as u64 * self.height as u64
    }

    /// Returns the number of pixels of the whole film.
    pub fn film_pixel_count(&self) -> u64 {
        self.film.map(u64::from).iter().product()
    }

    /// True if the rectangle lies on the film and has at least one pixel.
    pub fn is_valid(&self) -> bool {
        let end = |offset: u32, length: u32| offset as u64 + length as u64;
        self.pixel_count() > 0
            && end(self.offset[0], self.width) <= self.film[0] as u64
            && end(self.offset[1], self.height) <= self.film[1] as u64
    }

    /// Returns the number of square tiles of `size` pixels that cover the window.
    pub fn tile_count(&self, size: u32) -> usize {
        self.width.div_ceil(size) as usize * self.height.div_ceil(size) as usize
    }

    /// Returns the pixels of tile `index` row by row, relative to the window. Tiles are numbered row by row.
    pub fn tile(&self, index: usize, size: u32) -> impl Iterator<Item = [u32; 2]> + use<> {
        let across = self.width.div_ceil(size).max(1) as usize;
        let (left, top) = ((index % across) as u32 * size, (index / across) as u32 * size);
        let (right, bottom) = ((left + size).min(self.width), (top + size).min(self.height));
        (top..bottom).flat_map(move |y| (left..right).map(move |x| [x, y]))
    }

    /// Returns the corners, by rows, of the squares of `size` pixels of the film that have pixels in the window.
    pub fn film_squares(&self, size: u32) -> impl Iterator<Item = [u32; 2]> + use<> {
        let corners = |offset: u32, length: u32| {
            (offset / size..(offset + length).div_ceil(size)).map(move |i| i * size)
        };
        let (across, down) = (corners(self.offset[0], self.width), corners(self.offset[1], self.height));
        down.flat_map(move |y| across.clone().map(move |x| [x, y]))
    }

    /// True if a film pixel exists.
    pub fn on_film(&self, [x, y]: [u32; 2]) -> bool {
        x < self.film[0] && y < self.film[1]
    }

    /// Returns the index of a film pixel in the rows of the window, if it is inside.
    #[inline]
    pub fn index(&self, [x, y]: [u32; 2]) -> Option<usize> {
        let (dx, dy) = (x.wrapping_sub(self.offset[0]), y.wrapping_sub(self.offset[1]));
        (dx < self.width && dy < self.height).then(|| dy as usize * self.width as usize + dx as usize)
    }

    /// Returns the window with a margin of pixels, clipped to the film.
    pub fn grown(&self, by: u32) -> Window {
        let start = self.offset.map(|offset| offset.saturating_sub(by));
        let end = |i: usize, length: u32| (self.offset[i] + length).saturating_add(by).min(self.film[i]);
        let (width, height) = (end(0, self.width) - start[0], end(1, self.height) - start[1]);
        Window { offset: start, width, height, ..*self }
    }

    /// Returns the film pixels of the window, by rows.
    pub fn film_pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let Window { offset: [left, top], width, height, .. } = *self;
        (top..top + height).flat_map(move |y| (left..left + width).map(move |x| [x, y]))
    }

    /// Returns the film coordinates of a pixel of the window.
    #[inline]
    pub fn film_pixel(&self, [x, y]: [u32; 2]) -> [u32; 2] {
        [x + self.offset[0], y + self.offset[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_the_window_once() {
        for [width, height] in [[1, 1], [16, 16], [17, 5], [33, 48], [1, 100]] {
            let window = Window { width, height, ..Window::whole([100, 100]) };
            let mut pixels: Vec<[u32; 2]> =
                (0..window.tile_count(16)).flat_map(|i| window.tile(i, 16)).collect();
            pixels.sort();
            let expected: Vec<[u32; 2]> = (0..width).flat_map(|x| (0..height).map(move |y| [x, y])).collect();
            assert_eq!(pixels, expected);
        }
    }

    #[test]
    fn a_grown_window_ends_at_the_film() {
        let window = Window { film: [9, 5], offset: [1, 2], width: 3, height: 3 };
        let grown = window.grown(2);
        assert_eq!(grown, Window { film: [9, 5], offset: [0, 0], width: 6, height: 5 });
        assert_eq!(grown.film_pixels().count(), 30);
        assert!(grown.film_pixels().enumerate().all(|(i, pixel)| grown.index(pixel) == Some(i)));
    }

    #[test]
    fn squares_of_the_film_cover_the_window_once() {
        for (offset, [width, height]) in [([0, 0], [5, 3]), ([3, 7], [1, 1]), ([15, 16], [17, 33])] {
            let window = Window { offset, width, height, film: [100, 100] };
            let mut indices = Vec::new();
            for [left, top] in window.film_squares(8) {
                assert!(left % 8 == 0 && top % 8 == 0);
                let before = indices.len();
                let pixels = (top..top + 8).flat_map(|y| (left..left + 8).map(move |x| [x, y]));
                indices.extend(pixels.filter_map(|pixel| window.index(pixel)));
                assert!(indices.len() > before, "a square outside the window");
            }
            indices.sort();
            assert!(indices.into_iter().eq(0..window.pixel_count() as usize));
        }
    }
}
