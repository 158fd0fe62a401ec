//! 8-bit sRGB PNG files for display.

use super::look::Look;
use super::{Image, ImageError, atomic};
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder, ImageError as EncodeError};
use std::io;
use std::path::Path;

/// Writes the display values of `image` to `path`, completely or not at all.
///
/// # Errors
/// If writing fails.
pub fn write_png(path: &Path, image: &Image, look: Look) -> Result<(), ImageError> {
    write_srgb8(path, [image.width, image.height], &look.to_bytes(image))
}

/// Writes display values, row-major, three bytes per pixel, to `path`, completely or not at all.
///
/// # Errors
/// If writing fails.
pub fn write_srgb8(path: &Path, size: [u32; 2], bytes: &[u8]) -> Result<(), ImageError> {
    atomic::write_atomically(path, |file| {
        PngEncoder::new(file).write_image(bytes, size[0], size[1], ExtendedColorType::Rgb8).map_err(|error| {
            match error {
                EncodeError::IoError(error) => error,
                other => io::Error::other(other.to_string()),
            }
        })
    })
    .map_err(|error| ImageError::Write { path: path.to_owned(), error })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::ToneCurve;
    use crate::math::Rgb;

    #[test]
    fn png_holds_the_exposed_srgb_values() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut image = Image::new(2, 1);
        image.pixels = vec![Rgb::new(0.25, 0.0, f32::NAN), Rgb::new(0.5, 2.0, -1.0)];
        write_png(&path, &image, Look { factor: 2.0, curve: ToneCurve::Standard }).unwrap();
        let read = ::image::open(&path).unwrap().into_rgb8();
        assert_eq!(read.dimensions(), (2, 1));
        // 0.5 in sRGB is 0.7354, 188 of 255.
        assert_eq!(read.into_raw(), [188, 0, 0, 255, 255, 0]);
    }
}
