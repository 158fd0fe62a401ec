//! Decoding of image files to linear colour: PNG, JPEG, WebP, BMP and TGA with the crate `image`, Radiance HDR, and
//! OpenEXR.
//!
//! Images of 8 or 16 bits are sRGB unless read raw. Floating-point images are linear. Alpha is dropped, as in Mitsuba.

use super::budget::lacking;
use super::colour_profile::{self, Conversion, srgb_to_linear};
use super::error::{Location, SceneError};
use base::exr_file::{ExrPicture, ExrSource, read_picture};
use base::math::Rgb;
use image::{DynamicImage, ImageDecoder};
use scene::Texels;
use std::io::Cursor;
use std::path::Path;

/// Maximum number of pixels: 16384 by 16384.
const MAX_PIXELS: usize = 1 << 28;
/// Number of pixels up to which a file may be of any length.
const MAX_SMALL: usize = 1 << 24;
/// Maximum number of pixels per byte of larger images. Only files of one colour reach it.
const MAX_PIXELS_PER_BYTE: usize = 1 << 13;
/// Maximum bytes per decoded pixel: four channels of 32 bits.
const MAX_PIXEL_BYTES: u64 = 16;

/// Estimated bytes per pixel while an image of 8 bits per channel is decoded and stored.
const SHORT_PIXEL_BYTES: u64 = 12;
/// Estimated bytes per pixel while a deeper image is decoded and stored.
const LONG_PIXEL_BYTES: u64 = 36;

/// Maximum length of a line in the head of a Radiance HDR file, in bytes.
const MAX_HEAD: usize = 1 << 16;

/// Messages of decoders at the end of a file that is cut off.
const CUT_OFF: [&str; 4] =
    ["failed to fill whole buffer", "unexpected end of file", "EOF in header", "unexpected EOF"];

/// Remedy for an image that does not fit into memory.
pub(super) const SMALLER: &str = "make it smaller, or give more memory";

/// A decoded image, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedImage {
    pub width: usize,
    pub height: usize,
    pub texels: Texels,
}

/// Channels of an image to decode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Channel {
    /// Linear colour.
    Colour,
    /// All channels, without decoding from sRGB.
    Data,
    /// One channel, without decoding from sRGB, as a grey of 8 bits. 0 to 3 stand for red, green, blue and alpha; a
    /// missing channel is 1.
    One(usize),
    /// Alpha as a grey, or all channels without decoding from sRGB where the image has no alpha.
    AlphaOrData,
    /// 1 if alpha is at least the value, else 0.
    AlphaFrom(f32),
}

/// Reason for rejecting an image.
enum Refusal {
    /// The bytes are no image.
    Undecodable(String),
    /// The image does not fit into memory.
    TooLarge(String),
}

impl<E: std::fmt::Display> From<E> for Refusal {
    fn from(error: E) -> Refusal {
        let what = error.to_string();
        Refusal::Undecodable(match CUT_OFF.iter().any(|end| what.contains(end)) {
            true => "the file ends too early; copy or export it again".to_owned(),
            false => what,
        })
    }
}

/// Decodes channels of an image; `path` tells the format of files without a signature.
pub fn decode(
    bytes: &[u8],
    channel: Channel,
    path: &Path,
    place: &Location,
) -> Result<DecodedImage, SceneError> {
    let image = if bytes.starts_with(&[0x76, 0x2F, 0x31, 0x01]) {
        decode_exr(bytes, channel)
    } else {
        let conversion =
            if channel == Channel::Colour { colour_profile::to_srgb(bytes, place) } else { None };
        decode_common(bytes, channel, path, conversion)
    };
    let image = image.and_then(|p| match p.texels.is_empty() {
        true => Err("it has no pixels".into()),
        false => Ok(p),
    });
    image.map_err(|refusal| match refusal {
        Refusal::Undecodable(what) => SceneError::Image { place: place.clone(), path: path.to_owned(), what },
        Refusal::TooLarge(what) => place.wrong(format!("{}: {what}", path.display()), SMALLER),
    })
}

/// Decodes the picture of an OpenEXR file; see [`base::exr_file::read_picture`]. Its alpha is never read.
fn decode_exr(bytes: &[u8], channel: Channel) -> Result<DecodedImage, Refusal> {
    let mut source = ExrSource::open(Cursor::new(bytes))?;
    let check = |[width, height]: [usize; 2], of_file: u64| {
        check_size(width, height, of_file + LONG_PIXEL_BYTES, bytes)
    };
    let ExrPicture { size: [width, height], mut pixels } =
        read_picture(&mut source, channel != Channel::Colour, check)?;
    if let Channel::One(channel @ 0..=2) = channel {
        pixels.iter_mut().for_each(|pixel| *pixel = Rgb::splat(pixel[channel]));
    }
    Ok(DecodedImage { width, height, texels: Texels::new(width, &pixels) })
}

/// Rejects sizes that no image has, that the file is too short for, or that do not fit into memory.
///
/// This happens before anything of that size is allocated.
fn check_size(width: usize, height: usize, pixel_bytes: u64, bytes: &[u8]) -> Result<(), Refusal> {
    let most = bytes.len().saturating_mul(MAX_PIXELS_PER_BYTE).clamp(MAX_SMALL, MAX_PIXELS);
    let Some(pixels) = width.checked_mul(height).filter(|pixels| *pixels <= most) else {
        let length = bytes.len();
        return Err(
            format!("{width} x {height} pixels are more than a file of {length} bytes may have").into()
        );
    };
    match lacking(pixels as u64 * pixel_bytes) {
        Some(lack) => Err(Refusal::TooLarge(format!("its {width} x {height} pixels take {lack}"))),
        None => Ok(()),
    }
}

fn decode_common(
    bytes: &[u8],
    channel: Channel,
    path: &Path,
    conversion: Option<Conversion>,
) -> Result<DecodedImage, Refusal> {
    let usual = usual_radiance(bytes);
    let bytes = usual.as_deref().unwrap_or(bytes);
    let mut reader = image::ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    if reader.format().is_none() {
        // TGA has no signature.
        let format = image::ImageFormat::from_path(path)?;
        reader.set_format(format);
    }
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(MAX_PIXELS as u64 * MAX_PIXEL_BYTES);
    reader.limits(limits.clone());
    let mut decoder = reader.into_decoder()?;
    decoder.set_limits(limits)?;
    let (width, height) = decoder.dimensions();
    let is_short = conversion.is_none()
        && decoder.color_type().bytes_per_pixel() == decoder.color_type().channel_count();
    let pixel_bytes = if is_short { SHORT_PIXEL_BYTES } else { LONG_PIXEL_BYTES };
    check_size(width as usize, height as usize, pixel_bytes, bytes)?;
    let image = DynamicImage::from_decoder(decoder)?;
    let image = conversion.and_then(|conversion| conversion.apply(&image)).unwrap_or(image);
    let (width, height) = (image.width() as usize, image.height() as usize);
    let grey = |code: &dyn Fn(&[u8; 4]) -> u8| {
        let codes: Vec<[u8; 4]> = image.to_rgba8().pixels().map(|p| [code(&p.0); 4]).collect();
        let texels = Texels::coded(width, &codes, std::array::from_fn(|code| code as f32 / 255.0));
        Ok(DecodedImage { width, height, texels })
    };
    let raw = match channel {
        Channel::Colour => false,
        Channel::AlphaOrData if image.color().has_alpha() => return grey(&|rgba| rgba[3]),
        Channel::Data | Channel::AlphaOrData => true,
        Channel::One(channel) => return grey(&|rgba| rgba[channel]),
        Channel::AlphaFrom(cutoff) => {
            return grey(&|rgba| if f32::from(rgba[3]) >= 255.0 * cutoff { 255 } else { 0 });
        }
    };
    use DynamicImage as D;
    let plain = |texels: Vec<Rgb>| Texels::new(width, &texels);
    let texels = match image {
        D::ImageRgb32F(_) | D::ImageRgba32F(_) => {
            plain(image.into_rgb32f().pixels().map(|p| Rgb::from(p.0)).collect())
        }
        D::ImageRgb16(_) | D::ImageRgba16(_) | D::ImageLuma16(_) | D::ImageLumaA16(_) => {
            let decode = |v: u16| linear(f32::from(v) / 65535.0, raw);
            plain(image.into_rgb16().pixels().map(|p| Rgb::from(p.0.map(decode))).collect())
        }
        _ => {
            let codes: Vec<[u8; 4]> =
                image.into_rgb8().pixels().map(|p| [p.0[0], p.0[1], p.0[2], 0]).collect();
            Texels::coded(width, &codes, std::array::from_fn(|code| linear(code as f32 / 255.0, raw)))
        }
    };
    Ok(DecodedImage { width, height, texels })
}

/// Returns a Radiance HDR file with the signature and the line ends that the decoder reads; `None` if it has them.
///
/// Mitsuba writes another signature. Some programs end the lines of the head with a carriage return, too.
fn usual_radiance(bytes: &[u8]) -> Option<Vec<u8>> {
    bytes.strip_prefix(b"#?")?;
    // The line behind the first empty one is the last.
    let (mut rest, mut usual, mut ends) = (bytes, Vec::new(), false);
    while let Some(at) = rest.iter().take(MAX_HEAD).position(|byte| *byte == b'\n') {
        let line = rest[..at].strip_suffix(b"\r").unwrap_or(&rest[..at]);
        usual.extend_from_slice(if line == b"#?RGBE" { b"#?RADIANCE" } else { line });
        usual.push(b'\n');
        rest = &rest[at + 1..];
        if ends {
            break;
        }
        ends = line.is_empty();
    }
    (usual.len() + rest.len() != bytes.len()).then(|| [&usual[..], rest].concat())
}

fn linear(encoded: f32, raw: bool) -> f32 {
    if raw { encoded } else { srgb_to_linear(encoded) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn decode_file(bytes: &[u8], raw: bool, name: &str) -> Result<DecodedImage, SceneError> {
        let channel = if raw { Channel::Data } else { Channel::Colour };
        decode(bytes, channel, Path::new(name), &Location::file(Path::new("s.toml")))
    }

    fn corpus(name: &str) -> Vec<u8> {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenes/valid");
        std::fs::read(folder.join(name)).unwrap()
    }

    #[test]
    fn integer_pictures_are_srgb_unless_raw() {
        let png = corpus("tile.png");
        let decoded = decode_file(&png, false, "t.png").unwrap();
        assert_eq!((decoded.width, decoded.height), (2, 2));
        // 200 and 60 of 255, by the standard's formula in f64.
        assert!(
            (decoded.texels.get(0, 0) - Rgb::new(0.577580, 0.0451862, 0.0212190)).length() < 1e-6,
            "{}",
            decoded.texels.get(0, 0)
        );
        let raw = decode_file(&png, true, "t.png").unwrap();
        assert_eq!(raw.texels.get(0, 0), Rgb::new(200.0, 60.0, 40.0) / 255.0);
    }

    #[test]
    fn floating_point_pictures_are_linear_with_the_top_row_first() {
        let sky = decode_file(&corpus("sky.exr"), false, "sky.exr").unwrap();
        assert_eq!((sky.width, sky.height), (4, 3));
        assert_eq!(sky.texels.get(1, 0), Rgb::new(0.5, 1.0, 2.0));
        assert_eq!(sky.texels.get(0, 2), Rgb::new(2.0, 1.0, 4.0));
    }

    #[test]
    fn the_picture_of_an_exr_is_its_colour_without_layer_and_not_the_first_layer() {
        use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
        let channel = |(name, value): (&str, f32)| AnyChannel::new(name, FlatSamples::F32(vec![value; 6]));
        let named = [("R", 0.5), ("G", 1.0), ("B", 2.0), ("A", 1.0), ("Albedo.R", 0.9), ("Albedo.G", 0.1)];
        let layers = [("Albedo.B", 0.05), ("Ns.X", 0.0), ("Ns.Y", 1.0), ("Ns.Z", 0.0)];
        let list = named.into_iter().chain(layers).map(channel).collect();
        let image = Image::from_channels((3, 2), AnyChannels::sort(list));
        let mut bytes = Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).unwrap();
        let decoded = decode_file(bytes.get_ref(), false, "gbuffer.exr").unwrap();
        assert_eq!((decoded.width, decoded.height), (3, 2));
        assert!(decoded.texels.iter().all(|texel| texel == Rgb::new(0.5, 1.0, 2.0)));
        // Layers alone are no picture, and the message names them.
        let list = layers.into_iter().map(channel).collect();
        let image = Image::from_channels((3, 2), AnyChannels::sort(list));
        let mut bytes = Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).unwrap();
        let message = decode_file(bytes.get_ref(), false, "layers.exr").unwrap_err().to_string();
        assert!(message.contains("layers.exr") && message.contains("Ns.X"), "{message}");
    }

    #[test]
    fn a_picture_that_claims_to_be_huge_is_an_error_and_no_allocation() {
        let mut exr = corpus("sky.exr");
        let at = exr.windows(10).position(|w| w == b"dataWindow").unwrap() + 10 + 1 + 5 + 1 + 4;
        exr[at + 8..at + 12].copy_from_slice(&2_000_000_000i32.to_le_bytes());
        exr[at + 12..at + 16].copy_from_slice(&2_000_000_000i32.to_le_bytes());
        assert!(decode_file(&exr, false, "sky.exr").is_err());
    }

    /// Returns a Radiance image of one colour, run-length encoded.
    fn radiance(width: u16, height: usize) -> Vec<u8> {
        let mut row = [&[2, 2][..], &width.to_be_bytes()].concat();
        for channel in [128, 64, 32, 129] {
            let mut left = width;
            while left > 0 {
                let run = left.min(127);
                row.extend([128 + run as u8, channel]);
                left -= run;
            }
        }
        let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
        [head.into_bytes(), row.repeat(height)].concat()
    }

    #[test]
    fn skies_of_any_real_size_are_decoded() {
        // 513 MiB as 32-bit floats; the decoder's own limit is 512.
        let (width, height) = (11_000, 4080);
        let sky = decode_file(&radiance(width, height), false, "sky.hdr").unwrap();
        assert_eq!((sky.width, sky.height), (width.into(), height));
        assert!((sky.texels.get(0, height - 1) - Rgb::new(1.0, 0.5, 0.25)).length() < 1e-2);
        // Both signatures are read.
        let small = radiance(8, 2);
        let other = [b"#?RGBE", &small[b"#?RADIANCE".len()..]].concat();
        let decoded = |bytes: &[u8]| decode_file(bytes, false, "sky.hdr").unwrap();
        assert_eq!(decoded(&other), decoded(&small));
        // Line ends of the head may have a carriage return.
        let head = b"#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 2 +X 8\r\n";
        let pixels = &small[head.len() - 4..];
        assert_eq!(decoded(&[&head[..], pixels].concat()), decoded(&small));
        let cut = decode_file(&small[..small.len() - 3], false, "sky.hdr").unwrap_err().to_string();
        assert!(cut.contains("ends too early"), "{cut}");
        // A claim that no file of this size can keep.
        let claims = String::from_utf8_lossy(&radiance(8, 1)).replace("-Y 1 +X 8", "-Y 16384 +X 16384");
        let message = decode_file(claims.as_bytes(), false, "sky.hdr").unwrap_err().to_string();
        assert!(message.contains("16384 x 16384"), "{message}");
    }

    #[test]
    fn what_is_no_picture_is_an_error_that_names_it() {
        for (bytes, name) in
            [(&b""[..], "a.png"), (b"hello", "b.tga"), (b"hello", "c.txt"), (b"\x76\x2f\x31\x01", "d.exr")]
        {
            let message = decode_file(bytes, false, name).unwrap_err().to_string();
            assert!(message.contains(name) && message.contains("s.toml"), "{message}");
        }
    }
}
