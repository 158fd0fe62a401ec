//! Settled pixels of a walk-through: their light is known from earlier images, so that they need fewer samples.

use super::adaptive::Luminances;
use base::film::Window;
use std::ops::Range;

/// Divisor of the sample count in settled pixels.
const SAMPLE_DIVISOR: u32 = 4;

/// Number of frames after which sample numbers repeat.
const PERIOD: u32 = 256;

/// Settled pixels of a window.
#[derive(Clone, Debug, Default)]
pub struct Settled {
    /// True for settled pixels, in rows; empty if there are none.
    pub pixels: Vec<bool>,
    /// Number of the frame. Each frame takes other samples, which complement those of earlier frames.
    pub turn: u32,
}

impl Settled {
    /// Returns true if a pixel of the window is settled.
    #[inline]
    pub fn contains(&self, pixel: usize) -> bool {
        self.pixels.get(pixel) == Some(&true)
    }

    /// Returns the sample numbers of settled pixels; other pixels begin with `spp` samples.
    pub fn samples(&self, spp: u32) -> Range<u32> {
        let few = spp.div_ceil(SAMPLE_DIVISOR);
        let start = few.saturating_mul(self.turn % PERIOD).min(u32::MAX - few);
        start..start + few
    }

    /// Removes the noise of low sample counts from the luminances of settled pixels. Each becomes the mean of the
    /// settled pixels around it, where light varies little.
    pub fn smooth(&self, window: &Window, luminances: &mut Luminances) {
        if self.pixels.is_empty() {
            return;
        }
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
