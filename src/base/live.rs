//! The image that a method has so far, for watchers in other threads.
//!
//! A method shows the pixels of finished tiles, if someone watches (see [`Control::live`]). Watchers read copies, so
//! that nothing here influences the image.
//!
//! [`Control::live`]: crate::progress::Control::live

use crate::film::Image;
use crate::math::Rgb;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Value of a pixel that the method has not shown.
const UNKNOWN: Rgb = Rgb::NAN;

/// An image in the making.
#[derive(Debug)]
pub struct LiveImage {
    /// Width and height in pixels.
    size: [u32; 2],
    state: Mutex<LiveState>,
}

#[derive(Debug, Default)]
struct LiveState {
    /// Radiance by pixel, [`UNKNOWN`] where there is none; empty before the first pixel.
    pixels: Vec<Rgb>,
    /// Number of changes.
    changes: u64,
}

/// A copy of an image in the making.
#[derive(Clone, Debug)]
pub struct LiveCopy {
    /// The image; pixels that the method has not shown are black.
    pub image: Image,
    /// The pixels that the method has shown, in one row, for automatic exposure.
    pub known: Image,
}

impl LiveImage {
    /// Creates an image of this width and height without a known pixel.
    pub fn new(size: [u32; 2]) -> LiveImage {
        LiveImage { size, state: Mutex::default() }
    }

    /// Returns width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Sets pixels, each given by its index in the rows.
    pub fn set(&self, pixels: impl IntoIterator<Item = (usize, Rgb)>) {
        self.change(|own| {
            for (at, radiance) in pixels {
                if let Some(pixel) = own.get_mut(at) {
                    *pixel = radiance;
                }
            }
        });
    }

    /// Adds radiance to known pixels, each given by its index in the rows.
    pub fn add(&self, pixels: impl IntoIterator<Item = (usize, Rgb)>) {
        self.change(|own| {
            for (at, radiance) in pixels {
                if let Some(pixel) = own.get_mut(at) {
                    *pixel += radiance;
                }
            }
        });
    }

    /// Sets all pixels, if the image has the size of this one.
    pub fn show(&self, image: &Image) {
        if [image.width, image.height] == self.size {
            self.change(|own| own.copy_from_slice(&image.pixels));
        }
    }

    fn change(&self, change: impl FnOnce(&mut [Rgb])) {
        let mut state = self.lock();
        if state.pixels.is_empty() {
            state.pixels = vec![UNKNOWN; self.size.iter().map(|side| *side as usize).product()];
        }
        change(&mut state.pixels);
        state.changes += 1;
    }

    /// Returns the number of changes so far.
    pub fn changes(&self) -> u64 {
        self.lock().changes
    }

    /// Returns a copy; `None` if no pixel is known.
    pub fn copy(&self) -> Option<LiveCopy> {
        let mut pixels = self.lock().pixels.clone();
        let is_known = |pixel: &Rgb| pixel.is_finite();
        let known: Vec<Rgb> = pixels.iter().copied().filter(is_known).collect();
        if known.is_empty() {
            return None;
        }
        pixels.iter_mut().filter(|pixel| !is_known(pixel)).for_each(|pixel| *pixel = Rgb::ZERO);
        let [width, height] = self.size;
        // A film has at most 2^32 pixels.
        let count = u32::try_from(known.len()).unwrap_or(u32::MAX);
        let known = Image { width: count, height: 1, pixels: known };
        Some(LiveCopy { image: Image { width, height, pixels }, known })
    }

    fn lock(&self) -> MutexGuard<'_, LiveState> {
        // The data is plain, so a panic in another thread cannot have left it inconsistent.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::tone::auto_factor;

    fn image(width: u32, values: &[f32]) -> Image {
        Image { width, height: 1, pixels: values.iter().map(|value| Rgb::splat(*value)).collect() }
    }

    #[test]
    fn copies_have_what_is_known_and_black_elsewhere() {
        let live = LiveImage::new([3, 1]);
        assert!(live.copy().is_none() && live.changes() == 0);
        live.add([(0, Rgb::ONE)]);
        assert!(live.copy().is_none(), "nothing is added to an unknown pixel");
        live.set([(1, Rgb::splat(2.0)), (7, Rgb::ONE)]);
        live.add([(1, Rgb::ONE), (2, Rgb::ONE)]);
        let LiveCopy { image: shown, known } = live.copy().unwrap();
        assert_eq!((shown, known.clone()), (image(3, &[0.0, 3.0, 0.0]), image(1, &[3.0])));
        // Unknown pixels do not count for the exposure.
        assert!((auto_factor(&known) * 3.0 - 0.8).abs() < 1e-6);
        live.show(&image(2, &[5.0, 5.0]));
        assert_eq!(live.copy().unwrap().known.width, 1, "the size is another");
        live.show(&image(3, &[5.0, 6.0, f32::INFINITY]));
        assert_eq!(live.copy().unwrap().image, image(3, &[5.0, 6.0, 0.0]));
        assert_eq!(live.changes(), 4);
    }
}
