//! Choice of the pixels that get more samples than others: pixels in high-contrast surroundings.
//!
//! A denoiser removes the noise of smooth light, but hardly the noise of coverage. Most of the squared error of a
//! denoised image lies in few pixels, at edges against bright objects. The standard deviation of a pixel's samples is
//! close to that of the means around it, and the optimal number of samples is proportional to it (Neyman allocation).
//!
//! Deviations: a pixel's own samples do not affect their number. It depends on the eight neighbours and on a pilot
//! with a seed of its own, so that the pixel's mean is unbiased. An edge within a single pixel is missed. The pilot
//! covers the whole film, so that the pixels of a crop are chosen as in the full image. Sample counts are two or four
//! times the others', for which samples are best stratified.
//!
//! Units: contrasts are relative to the mean of the surroundings. Luminances are those of known light, which includes
//! the edges of direct light.

use base::film::tone::auto_factor;
use base::film::{Image, Window};
use base::math::Rgb;

/// Pixels along the edge of a square of the pilot.
const SQUARE: u32 = 4;

/// Maximum number of the pilot's squares.
const MAX_SQUARES: u32 = 256;

/// Number of film pixels per square of the pilot.
const PIXELS_PER_SQUARE: u64 = 128;

/// Luminance in the displayed image that counts as dark. It is added to the mean that contrasts are relative to.
const DARK: f32 = 0.08;

/// Minimum contrast for more samples: about that of direct light's own noise at sixteen samples.
const MIN_CONTRAST: f32 = 0.05;

/// Luminances of the pixels of a window.
pub struct Luminances {
    /// Window.
    pub window: Window,
    /// Luminance per pixel, in rows.
    pub values: Vec<f32>,
}

/// Rule by which pixels are chosen.
#[derive(Clone, Copy, Debug)]
pub struct AdaptiveRule {
    /// Luminance that counts as dark.
    pub dark: f32,
    /// Minimum contrast around a pixel that gets more samples.
    threshold: f32,
}

impl Luminances {
    /// Sets the luminance of a film pixel, if it is in the window.
    pub fn set(&mut self, pixel: [u32; 2], luminance: f32) {
        if let Some(i) = self.window.index(pixel) {
            self.values[i] = luminance;
        }
    }

    /// Returns the contrast around a film pixel: the standard deviation over the sum of mean and `dark`.
    fn contrast_around(&self, [x, y]: [u32; 2], dark: f32) -> f32 {
        let near = |x: u32| [x.wrapping_sub(1), x, x.wrapping_add(1)];
        let around = near(y).into_iter().flat_map(|y| near(x).map(|x| [x, y])).filter(|at| *at != [x, y]);
        // Squares of bright light exceed 32 bits.
        let values = around.filter_map(|at| self.window.index(at)).map(|i| f64::from(self.values[i]));
        let (n, sum, squares) =
            values.fold((0.0, 0.0, 0.0), |(n, sum, squares), v| (n + 1.0, sum + v, squares + v * v));
        let mean = sum / n;
        ((squares / n - mean * mean).max(0.0).sqrt() / (mean + f64::from(dark))) as f32
    }
}

/// Returns the squares of a film that the pilot samples. They do not depend on the crop.
pub fn pilot(film: [u32; 2]) -> Vec<Window> {
    let pixels = u64::from(film[0]) * u64::from(film[1]);
    let squares = (pixels / PIXELS_PER_SQUARE).clamp(1, MAX_SQUARES.into()) as u32;
    Window::spread(film, SQUARE, squares, 0).collect()
}

impl AdaptiveRule {
    /// Returns the rule that, on the pilot, takes at most `share` more samples than the same number for all pixels.
    pub fn new(pilot: &[Luminances], share: f32) -> AdaptiveRule {
        let grey = |square: &Luminances| square.values.iter().map(|v| Rgb::splat(*v)).collect::<Vec<_>>();
        let pixels: Vec<Rgb> = pilot.iter().flat_map(grey).collect();
        let dark = DARK / auto_factor(&Image { width: pixels.len() as u32, height: 1, pixels });
        let inner = |square: &Luminances| {
            let Window { offset: [left, top], width, height, .. } = square.window;
            let inside = |start: u32, length: u32| {
                let edge = (length - 1).min(2) / 2;
                start + edge..start + length - edge
            };
            let at = inside(top, height).flat_map(|y| inside(left, width).map(move |x| [x, y]));
            at.map(|at| square.contrast_around(at, dark)).collect::<Vec<_>>()
        };
        let contrasts: Vec<f32> = pilot.iter().flat_map(inner).collect();
        let taken = |threshold: f32| {
            contrasts.iter().map(|c| f64::from(more(*c / threshold))).sum::<f64>() / contrasts.len() as f64
        };
        let mut threshold = MIN_CONTRAST;
        while taken(threshold) > f64::from(share) {
            threshold *= 1.01;
        }
        AdaptiveRule { dark, threshold }
    }

    /// Returns the number of samples of a film pixel beyond its first, as a multiple of these: 0, 1 or 3.
    pub fn more(&self, near: &Luminances, pixel: [u32; 2]) -> u32 {
        more(near.contrast_around(pixel, self.dark) / self.threshold)
    }
}

/// Nonzero multiples that [`AdaptiveRule::more`] returns.
pub const MULTIPLES: [u32; 2] = [1, 3];

fn more(contrast: f32) -> u32 {
    match contrast {
        c if c >= 2.0 => 3,
        c if c >= 1.0 => 1,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;

    /// The film's luminances in a window.
    fn seen(window: Window, luminance: impl Fn([u32; 2]) -> f32) -> Luminances {
        Luminances { values: window.film_pixels().map(luminance).collect(), window }
    }

    /// Returns the extra samples of the pixels of a film of 256 by 192, as multiples of the first, in rows.
    fn multiples(luminance: impl Fn([u32; 2]) -> f32, share: f32) -> Vec<u32> {
        let film = [256, 192];
        let squares: Vec<Luminances> =
            pilot(film).into_iter().map(|square| seen(square, &luminance)).collect();
        let choice = AdaptiveRule::new(&squares, share);
        let whole = seen(Window::whole(film), &luminance);
        whole.window.film_pixels().map(|pixel| choice.more(&whole, pixel)).collect()
    }

    fn mean(multiples: &[u32]) -> f32 {
        multiples.iter().sum::<u32>() as f32 / multiples.len() as f32
    }

    /// Even noise of 3 % about 1.
    fn noise([x, y]: [u32; 2]) -> f32 {
        let at = owen_sobol_2d(x + 256 * y, 7).x;
        1.0 + 0.03 * 12f32.sqrt() * (at - 0.5)
    }

    #[test]
    fn a_plain_picture_needs_no_more_samples() {
        assert_eq!(multiples(|_| 0.0, 0.2), vec![0; 256 * 192]);
        assert_eq!(multiples(noise, 0.2), vec![0; 256 * 192]);
        // Darkness counts as uniform: a thousandth of the image's exposure.
        let dark_stripes = |[x, _]: [u32; 2]| match x {
            0..200 => 1e-3 * (x % 2) as f32,
            _ => 1.0,
        };
        assert!(multiples(dark_stripes, 0.2).chunks(256).all(|row| row[..199].iter().all(|more| *more == 0)));
    }

    #[test]
    fn samples_go_to_both_sides_of_an_edge_and_to_nothing_else() {
        let found = multiples(|at| if at[0] < 100 { 0.5 * noise(at) } else { 2.0 * noise(at) }, 1.0);
        for row in found.chunks(256) {
            assert!(row.iter().enumerate().all(|(x, more)| (*more > 0) == (x == 99 || x == 100)), "{row:?}");
        }
    }

    #[test]
    fn the_share_is_kept_about_and_goes_where_contrast_is_greatest() {
        // Contrast grows from left to right.
        let stripes = |[x, y]: [u32; 2]| 1.0 + x as f32 / 256.0 * (y / 2 % 2) as f32;
        for share in [0.1, 0.2, 0.5] {
            let found = multiples(stripes, share);
            let taken = mean(&found);
            assert!((0.7 * share..1.3 * share).contains(&taken), "{share} {taken}");
            let row = &found[256 * 50..256 * 51];
            assert!(row[..255].is_sorted() && row[254] == 1 || row[254] == 3, "{row:?}");
        }
    }

    #[test]
    fn the_choice_does_not_depend_on_the_scale_of_light() {
        for scale in [1e-15, 1.0, 3e19, 1e25] {
            // Contrast grows from left to right.
            let stripes = |[x, y]: [u32; 2]| scale * (1.0 + x as f32 / 256.0 * (y / 2 % 2) as f32);
            let taken = mean(&multiples(stripes, 0.2));
            assert!((0.14..0.26).contains(&taken), "{scale}: {taken}");
        }
    }

    #[test]
    fn a_pixel_has_no_say_in_its_own_samples() {
        let lone = |at: [u32; 2]| if at == [80, 80] { 50.0 } else { 1.0 };
        let film = [256, 192];
        let squares: Vec<Luminances> = pilot(film).into_iter().map(|square| seen(square, |_| 1.0)).collect();
        let (choice, whole) = (AdaptiveRule::new(&squares, 0.2), seen(Window::whole(film), lone));
        let found: Vec<[u32; 2]> =
            whole.window.film_pixels().filter(|pixel| choice.more(&whole, *pixel) > 0).collect();
        let near = |x: u32| x.abs_diff(80) <= 1;
        assert!(found.len() == 8 && found.iter().all(|[x, y]| near(*x) && near(*y) && [*x, *y] != [80, 80]));
    }

    #[test]
    fn films_of_any_size_have_a_pilot() {
        for film in [[1, 1], [2, 1], [1, 300], [3, 3], [5, 4], [4000, 3000]] {
            let squares = pilot(film);
            assert!(squares.iter().all(Window::is_valid) && squares.len() <= MAX_SQUARES as usize);
            let squares: Vec<Luminances> = squares.into_iter().map(|square| seen(square, |_| 1.0)).collect();
            let choice = AdaptiveRule::new(&squares, 0.2);
            assert!(choice.threshold == MIN_CONTRAST && choice.dark > 0.0, "{choice:?}");
            let corner = Window { film, offset: [0, 0], width: film[0].min(5), height: film[1].min(5) };
            let corner = seen(corner, |[x, _]| x as f32);
            assert!(corner.window.film_pixels().all(|pixel| choice.more(&corner, pixel) <= 3));
        }
    }
}
