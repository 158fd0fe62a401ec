//! Sharpening, the last step of pixel filters with negative lobes.
//!
//! See `scene::PixelFilter`. Along each axis a sharpened pixel is (1 + 2a) times its value minus a times each
//! neighbour. Beyond the edge of the window, edge pixels are repeated. Radiance may become negative near bright lights.

use super::Image;
use crate::math::Rgb;
use rayon::prelude::*;

/// Returns the weights of the previous pixel, of pixel `i` of `n`, and of the next pixel.
pub fn weights(a: f32, i: u32, n: u32) -> [f32; 3] {
    let before = if i == 0 { 0.0 } else { a };
    let after = if i + 1 == n { 0.0 } else { a };
    [-before, 1.0 + before + after, -after]
}

impl Image {
    /// Returns the sharpened image.
    pub fn sharpened(&self, a: f32) -> Image {
        self.combined(|i, n| weights(a, i, n))
    }

    /// Returns the variance of the sharpened image's pixels, from the variance of independent pixels.
    pub fn sharpened_variance(&self, a: f32) -> Image {
        self.combined(|i, n| weights(a, i, n).map(|weight| weight * weight))
    }

    /// Returns weighted sums over each pixel and its neighbours; `weights` gives the weights at place `i` of `n` along
    /// an axis.
    fn combined(&self, weights: impl Fn(u32, u32) -> [f32; 3] + Sync) -> Image {
        let Image { width, height, ref pixels } = *self;
        let row = |y: u32| &pixels[y as usize * width as usize..][..width as usize];
        let combine = |place: usize| {
            let (x, y) = (place as u32 % width, place as u32 / width);
            let across = weights(x, width);
            let along = |y: u32| -> Rgb {
                let row = row(y);
                let [before, own, after] = across;
                row[x.saturating_sub(1) as usize] * before
                    + row[x as usize] * own
                    + row[(x + 1).min(width - 1) as usize] * after
            };
            let [before, own, after] = weights(y, height);
            along(y.saturating_sub(1)) * before + along(y) * own + along((y + 1).min(height - 1)) * after
        };
        let pixels = (0..pixels.len()).into_par_iter().map(combine).collect();
        Image { width, height, pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_pictures_stay_and_edges_get_steeper() {
        for [width, height] in [[1, 1], [1, 5], [7, 1], [5, 4]] {
            let even = Image::new(width, height).map(|_| Rgb::new(1.0, 2.0, 4.0));
            for (sharp, even) in even.sharpened(0.2).pixels.iter().zip(&even.pixels) {
                assert!((*sharp - *even).abs().max_element() < 1e-5, "{sharp}");
            }
        }
        let mut edge = Image::new(6, 3);
        for (i, pixel) in edge.pixels.iter_mut().enumerate() {
            *pixel = Rgb::splat(if i % 6 < 3 { 1.0 } else { 2.0 });
        }
        let sharp = edge.sharpened(0.1);
        let expected = [1.0, 1.0, 0.9, 2.1, 2.0, 2.0];
        for (pixel, expected) in sharp.pixels.iter().zip(expected.iter().cycle()) {
            assert!((pixel.x - expected).abs() < 1e-6, "{pixel} {expected}");
        }
    }

    #[test]
    fn variance_is_that_of_the_weighted_sum() {
        let (a, n) = (0.15, 4);
        let even = Image::new(n, n).map(|_| Rgb::ONE);
        let variance = even.sharpened_variance(a);
        for (place, found) in variance.pixels.iter().enumerate() {
            // The response to a single pixel is its weight.
            let squares: f32 = (0..16)
                .map(|single| {
                    let mut impulse = Image::new(n, n);
                    impulse.pixels[single] = Rgb::ONE;
                    impulse.sharpened(a).pixels[place].x.powi(2)
                })
                .sum();
            assert!((found.x - squares).abs() < 1e-5, "{place}: {found} {squares}");
        }
    }
}
