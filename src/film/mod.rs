//! The film: images in memory, EXR and PNG files, tone mapping and error metrics.
//!
//! [`Film`] holds the images and attributes of a frame's file; [`write_exr`] and [`write_png`] replace a file
//! whole or not at all; [`metrics`] measures the difference of two pictures, and [`heatmap`] shows it.

pub mod atomic;
mod error;
mod exr_read;
#[cfg(test)]
mod exr_tests;
mod exr_write;
pub mod false_colour;
pub mod heatmap;
mod layers;
pub mod metrics;
mod png;
pub mod tone;
mod window;

pub use error::ImageError;
pub use exr_read::{ExrFile, read_exr};
pub use exr_write::write_exr;
pub use layers::{Film, Metadata, Value};
pub use png::{write_png, write_srgb8};
pub use tone::Exposure;
pub use window::Window;

use crate::math::Rgb;

/// A colour image, row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` linear colours.
    pub pixels: Vec<Rgb>,
}

impl Image {
    /// A black image.
    pub fn new(width: u32, height: u32) -> Image {
        Image { width, height, pixels: vec![Rgb::ZERO; width as usize * height as usize] }
    }

    /// Replaces every channel that is not finite by 0 and returns their number.
    pub fn remove_nonfinite(&mut self) -> u64 {
        let channels = self.pixels.iter_mut().flat_map(|pixel| pixel.as_mut());
        let bad = channels.filter(|channel| !channel.is_finite());
        bad.map(|channel| *channel = 0.0).count() as u64
    }
}
