//! Comparison image: test, reference and the error in magma colours, next to each other.

use super::{Image, metrics, tone};

/// A display image: 8-bit sRGB, row-major, three bytes per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `3 * width * height` values.
    pub bytes: Vec<u8>,
}

/// Lays out `test`, `reference` and `error` (one value per pixel, 0 to 1, larger ones clipped).
///
/// The three are side by side, or one above the other if they are more than twice as wide as high.
///
/// All three must have one size.
pub fn heatmap(test: &Image, reference: &Image, error: &[f32], exposure_factor: f32) -> Panel {
    let shown =
        [tone::to_srgb8(test, exposure_factor), tone::to_srgb8(reference, exposure_factor), colours(error)];
    let (width, height) = (reference.width, reference.height);
    if width > 2 * height {
        return Panel { width, height: 3 * height, bytes: shown.concat() };
    }
    let row = 3 * width as usize;
    let mut bytes = Vec::with_capacity(3 * row * height as usize);
    for y in 0..height as usize {
        shown.iter().for_each(|panel| bytes.extend_from_slice(&panel[y * row..(y + 1) * row]));
    }
    Panel { width: 3 * width, height, bytes }
}

/// Maps errors from 0 to 1 (larger ones clipped) to magma colours: three bytes per pixel.
pub fn colours(error: &[f32]) -> Vec<u8> {
    let lut = metrics::magma();
    // `as` saturates and turns NaN into 0, so the index is always within the 256 colours.
    error.iter().flat_map(|&e| lut[((e * 255.0 + 0.5) as usize).min(lut.len() - 1)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;

    #[test]
    fn narrow_pictures_stand_side_by_side_and_wide_ones_above_each_other() {
        for (width, height, expected) in [(2, 3, (6, 3)), (9, 2, (9, 6))] {
            let mut test = Image::new(width, height);
            test.pixels.fill(Rgb::ONE);
            let reference = Image::new(width, height);
            let mut error = vec![0.0; (width * height) as usize];
            *error.last_mut().unwrap() = f32::INFINITY;
            let panel = heatmap(&test, &reference, &error, 1.0);
            assert_eq!((panel.width, panel.height), expected);
            assert_eq!(panel.bytes.len(), (9 * width * height) as usize);
            assert_eq!(panel.bytes[..3], [255; 3]);
            assert_eq!(panel.bytes[panel.bytes.len() - 3..], metrics::magma()[255]);
            assert_eq!(panel.bytes.iter().filter(|&&b| b == 255).count() as u32, 3 * width * height);
        }
    }
}
