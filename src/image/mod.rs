//! The film: images in memory, EXR and PNG files, tone mapping and error metrics.

use crate::math::Rgb;

/// The part of a film that is rendered, in pixels from the top-left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
}

impl Window {
    /// All of a film of this resolution.
    pub fn full(resolution: [u32; 2]) -> Window {
        Window { x: 0, y: 0, width: resolution[0], height: resolution[1] }
    }

    /// How many pixels it has.
    pub fn pixel_count(&self) -> u64 {
        self.width as u64 * self.height as u64
    }

    /// Whether it lies inside a film of this resolution and has at least one pixel.
    pub fn fits(&self, resolution: [u32; 2]) -> bool {
        let end = |start: u32, length: u32| start as u64 + length as u64;
        self.pixel_count() > 0
            && end(self.x, self.width) <= resolution[0] as u64
            && end(self.y, self.height) <= resolution[1] as u64
    }
}

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
}
