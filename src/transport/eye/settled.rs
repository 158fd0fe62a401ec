//! Pixels whose light is known of the pictures before, in a walk-through: they need few samples of their own.

use super::adaptive::Luminances;
use base::film::Window;
use std::ops::Range;

/// Part of the samples of other pixels that settled ones have.
const PART: u32 = 4;

/// Number of frames after which samples come again.
const TURNS: u32 = 256;

/// The settled pixels of a window.
#[derive(Clone, Debug, Default)]
pub struct Settled {
    /// True of those, by pixel in rows; empty if there are none.
    pub pixels: Vec<bool>,
    /// Number of the frame: each has other samples, which complement those of the frames before.
    pub turn: u32,
}

impl Settled {
    /// True if a pixel of the window is settled.
    #[inline]
    pub fn contains(&self, pixel: usize) -> bool {
        self.pixels.get(pixel) == Some(&true)
    }

    /// Samples that settled pixels have where others begin with `spp`.
    pub fn samples(&self, spp: u32) -> Range<u32> {
        let few = spp.div_ceil(PART);
        let start = few.saturating_mul(self.turn % TURNS).min(u32::MAX - few);
        start..start + few
    }

    /// Takes the noise of few samples off the luminances of settled pixels, around which light varies little: each
    /// becomes the mean of those around.
    pub fn smooth(&self, window: &Window, luminances: &mut Luminances) {
        let noisy = luminances.values.clone();
        for pixel in window.film_pixels() {
            let is_settled = |at: [u32; 2]| window.index(at).is_some_and(|i| self.contains(i));
            if is_settled(pixel) {
                let around = Window { offset: pixel, width: 1, height: 1, ..*window }.grown(1).film_pixels();
                let values = around.filter(|at| is_settled(*at));
                let values = values.filter_map(|at| luminances.window.index(at)).map(|i| noisy[i]);
                let (n, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v));
                luminances.set(pixel, sum / n);
            }
        }
    }
}
