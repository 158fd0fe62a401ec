//! PNG files: 8-bit sRGB for display, and numbers of 16 bits.

use super::look::Look;
use super::tone::Shown;
use super::{ImageError, atomic};
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder, ImageError as EncodeError};
use std::io;
use std::path::Path;

/// Writes the display values of `image` to `path`, completely or not at all. A transparent background becomes the alpha
/// channel.
///
/// # Errors
/// If writing fails.
pub fn write_png<'a>(path: &Path, image: impl Into<Shown<'a>>, look: Look) -> Result<(), ImageError> {
    let image = image.into();
    let kind = if image.alpha.is_some() { ExtendedColorType::Rgba8 } else { ExtendedColorType::Rgb8 };
    write(path, [image.color.width, image.color.height], &look.to_bytes(image), kind)
}

/// Writes display values, row-major, three bytes per pixel, to `path`, completely or not at all.
///
/// # Errors
/// If writing fails.
pub fn write_srgb8(path: &Path, size: [u32; 2], bytes: &[u8]) -> Result<(), ImageError> {
    write(path, size, bytes, ExtendedColorType::Rgb8)
}

/// Writes numbers, row-major, to `path`, completely or not at all.
///
/// # Errors
/// If writing fails.
pub fn write_grey16(path: &Path, size: [u32; 2], numbers: &[u16]) -> Result<(), ImageError> {
    // The encoder takes the bytes of this machine's numbers.
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
    write(path, size, &bytes, ExtendedColorType::L16)
}

fn write(path: &Path, size: [u32; 2], bytes: &[u8], kind: ExtendedColorType) -> Result<(), ImageError> {
    atomic::write_atomically(path, |file| {
        PngEncoder::new(file).write_image(bytes, size[0], size[1], kind).map_err(|error| match error {
            EncodeError::IoError(error) => error,
            other => io::Error::other(other.to_string()),
        })
    })
    .map_err(|error| ImageError::Write { path: path.to_owned(), error })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Image, ToneCurve};
    use crate::math::Rgb;

    #[test]
    fn png_holds_the_exposed_srgb_values() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut image = Image::new(2, 1);
        image.pixels = vec![Rgb::new(0.25, 0.0, f32::NAN), Rgb::new(0.5, 2.0, -1.0)];
        let look = Look { factor: 2.0, curve: ToneCurve::Standard, automatic: None };
        write_png(&path, &image, look).unwrap();
        let read = ::image::open(&path).unwrap().into_rgb8();
        assert_eq!(read.dimensions(), (2, 1));
        // 0.5 in sRGB is 0.7354, 188 of 255.
        assert_eq!(read.into_raw(), [188, 0, 0, 255, 255, 0]);
        write_grey16(&path, [2, 1], &[258, 65535]).unwrap();
        assert_eq!(::image::open(&path).unwrap().into_luma16().into_raw(), [258, 65535]);
        // Half of the first pixel is covered, and nothing of the second.
        let alpha = Image { width: 2, height: 1, pixels: vec![0.5, 0.0] };
        image.pixels = vec![Rgb::new(0.125, 0.0, 0.0625), Rgb::ONE];
        write_png(&path, Shown { color: &image, alpha: Some(&alpha) }, look).unwrap();
        let read = ::image::open(&path).unwrap();
        assert_eq!(read.color(), ::image::ColorType::Rgba8);
        assert_eq!(read.into_rgba8().into_raw(), [188, 0, 137, 128, 0, 0, 0, 0]);
    }
}
