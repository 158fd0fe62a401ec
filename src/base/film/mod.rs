//! The film: images in memory, EXR and PNG files, tone mapping and error metrics.
//!
//! [`Film`] holds the images and attributes of a frame's file. [`write_exr`] and [`write_png`] replace a file
//! completely or not at all. [`metrics`] measures the difference of two images, and [`heatmap`] shows it.

mod agx;
pub mod atomic;
mod error;
mod exr_edit;
mod exr_merge;
mod exr_order;
mod exr_read;
#[cfg(test)]
mod exr_tests;
mod exr_write;
pub mod false_colour;
mod filmic;
pub mod heatmap;
mod lattice;
mod layer;
mod layers;
mod look;
pub mod metrics;
mod png;
pub mod sharpen;
pub mod tone;
mod tone_curve;
mod window;

pub use error::ImageError;
pub use exr_merge::Weight;
pub use exr_read::{ExrFile, read_exr};
pub use exr_write::write_exr;
pub use layer::{ALPHA, BACKGROUND, CRYPTO, Layer, NO_BACKGROUND, Pixels, Preview, SAMPLES};
pub use layers::{CameraMatrices, Fact, Film, Metadata};
pub use look::{Look, Tone};
pub use png::{write_grey16, write_png, write_srgb8};
pub use tone::{Exposure, Shown, display, srgb_slope};
pub use tone_curve::ToneCurve;
pub use window::Window;

use crate::math::{Rgb, luminance};

/// An image, by default of linear colours; row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T = Rgb> {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` values.
    pub pixels: Vec<T>,
}

impl<T> Image<T> {
    /// Returns an image of other values.
    pub fn map<U>(&self, value: impl FnMut(&T) -> U) -> Image<U> {
        Image { width: self.width, height: self.height, pixels: self.pixels.iter().map(value).collect() }
    }

    /// Returns width and height, and the number of values.
    fn size(&self) -> ([u32; 2], usize) {
        ([self.width, self.height], self.pixels.len())
    }
}

/// Bytes per pixel while an image is rendered with its variance, watched, and written.
const PIXEL_BYTES: u64 = 84;

impl Image {
    /// Returns the approximate memory in bytes for rendering `window` and writing its files, with any method.
    pub fn expected_bytes(window: &Window) -> u64 {
        window.pixel_count().saturating_mul(PIXEL_BYTES)
    }

    /// Creates a black image.
    pub fn new(width: u32, height: u32) -> Image {
        Image { width, height, pixels: vec![Rgb::ZERO; width as usize * height as usize] }
    }

    /// Returns the sum of the pixels' luminances.
    pub fn luminance(&self) -> f64 {
        self.pixels.iter().map(|pixel| f64::from(luminance(*pixel))).sum()
    }

    /// True if all pixels are black.
    pub fn is_black(&self) -> bool {
        self.pixels.iter().all(|pixel| *pixel == Rgb::ZERO)
    }

    /// Mends an image from elsewhere: infinite channels become [`BRIGHTEST`], NaN and negative infinity 0.
    ///
    /// The result is the number of such pixels, and column and row of the first; `None` if there is none.
    pub fn mend_nonfinite(&mut self) -> Option<(usize, [u32; 2])> {
        let is_bad = |pixel: &Rgb| !pixel.is_finite();
        let first = self.pixels.iter().position(is_bad)? as u32;
        let count = self.pixels.iter().filter(|pixel| is_bad(pixel)).count();
        for channel in self.pixels.iter_mut().flat_map(|pixel| pixel.as_mut()) {
            *channel = mended_value(*channel);
        }
        Some((count, [first % self.width.max(1), first / self.width.max(1)]))
    }

    /// Replaces every non-finite channel by 0; returns their number.
    pub fn remove_nonfinite(&mut self) -> u64 {
        remove_nonfinite(self.pixels.iter_mut().flat_map(|pixel| pixel.as_mut()))
    }
}

/// Value of an infinite channel of an image from elsewhere: the largest half float.
const BRIGHTEST: f32 = 65504.0;

/// Returns [`BRIGHTEST`] for infinity, and 0 for other numbers that are not finite.
fn mended_value(value: f32) -> f32 {
    match value {
        value if value.is_finite() => value,
        f32::INFINITY => BRIGHTEST,
        _ => 0.0,
    }
}

/// Replaces every non-finite number by 0; returns their number.
fn remove_nonfinite<'a>(numbers: impl Iterator<Item = &'a mut f32>) -> u64 {
    let bad = numbers.filter(|number| !number.is_finite());
    bad.map(|number| *number = 0.0).count() as u64
}
