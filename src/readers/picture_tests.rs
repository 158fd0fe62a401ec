//! Tests: kinds of images and channels of OpenEXR files are read or refused, as the page says.

use super::decode::{Channel, DecodedImage, decode};
use super::error::Location;
use base::math::Rgb;
use exr::meta::attribute::{Chromaticities, IntegerBounds};
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, Vec2, WritableImage};
use image::{DynamicImage, ImageFormat};
use std::io::Cursor;
use std::path::Path;

fn read(bytes: &[u8], name: &str) -> Option<DecodedImage> {
    decode(bytes, Channel::Colour, Path::new(name), &Location::file(Path::new("s.toml"))).ok()
}

/// A square of one colour in a format.
fn encoded(format: ImageFormat, image: DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A PNG of one pixel with a palette of two colours, the second of which is the pixel's.
fn palette() -> Vec<u8> {
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        let named = [&kind[..], data].concat();
        // The checksum of PNG (ISO 15948, annex D).
        let crc = named.iter().fold(u32::MAX, |crc, byte| {
            (0..8)
                .fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 })
        });
        png.extend([&(data.len() as u32).to_be_bytes()[..], &named, &(!crc).to_be_bytes()].concat());
    };
    chunk(b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0]);
    chunk(b"PLTE", &[1, 2, 3, 200, 60, 40]);
    // One stored block of zlib: filter 0, index 1, and the sum by Adler.
    chunk(b"IDAT", &[0x78, 0x01, 1, 2, 0, 0xFD, 0xFF, 0, 1, 0, 3, 0, 2]);
    chunk(b"IEND", &[]);
    png
}

/// A JPEG of 8 x 8 pixels of cyan, magenta, yellow and black, as programs of Adobe write it.
fn cmyk(inks: [u8; 4]) -> Vec<u8> {
    let mut jpeg = vec![0xFF, 0xD8];
    let mut segment = |marker: u8, data: &[u8]| {
        jpeg.extend([&[0xFF, marker][..], &(data.len() as u16 + 2).to_be_bytes(), data].concat());
    };
    // Without a transform of colours.
    segment(0xEE, &[&b"Adobe\0\x64"[..], &[0; 5]].concat());
    // A step of 8 for all coefficients: the first one is then the value.
    segment(0xDB, &[&[0u8][..], &[8; 64]].concat());
    let components: Vec<u8> = (1..5).flat_map(|id| [id, 0x11, 0]).collect();
    segment(0xC0, &[&[8, 0, 8, 0, 8, 4][..], &components].concat());
    // Nine lengths of values have codes of four bits. A code of one bit ends a block.
    segment(0xC4, &[&[0, 0, 0, 0, 9][..], &[0; 12], &[0, 1, 2, 3, 4, 5, 6, 7, 8]].concat());
    segment(0xC4, &[&[0x10, 1][..], &[0; 15], &[0]].concat());
    segment(0xDA, &[&[4, 1, 0, 2, 0, 3, 0, 4, 0][..], &[0, 63, 0]].concat());
    let mut bits = String::new();
    for ink in inks {
        let value = i32::from(ink) - 128;
        let length = (i32::BITS - value.abs().leading_zeros()) as usize;
        let code = if value < 0 { value + (1 << length) - 1 } else { value };
        let code = if length > 0 { format!("{code:0length$b}") } else { String::new() };
        bits += &format!("{length:04b}{code}0");
    }
    bits += &"1".repeat(bits.len().next_multiple_of(8) - bits.len());
    for byte in bits.as_bytes().chunks(8) {
        let byte = byte.iter().fold(0u8, |byte, bit| byte << 1 | (bit - b'0'));
        jpeg.push(byte);
        // A zero follows a byte of ones, which would begin a marker.
        jpeg.extend((byte == 0xFF).then_some(0));
    }
    jpeg.extend([0xFF, 0xD9]);
    jpeg
}

#[test]
fn each_kind_of_picture_has_its_colour() {
    let rgb8 = DynamicImage::from(image::RgbImage::from_pixel(8, 8, image::Rgb([200, 60, 40])));
    let rgba8 = DynamicImage::from(image::RgbaImage::from_pixel(8, 8, image::Rgba([200, 60, 40, 9])));
    let rgb16 = image::ImageBuffer::from_pixel(8, 8, image::Rgb([200u16 * 257, 60 * 257, 40 * 257]));
    let floats = image::ImageBuffer::from_pixel(8, 8, image::Rgb([0.5f32, 1.0, 2.0]));
    let grey = DynamicImage::from(image::GrayImage::from_pixel(8, 8, image::Luma([200])));
    // 200, 60 and 40 of 255, by IEC 61966-2-1 in f64.
    let srgb = Rgb::new(0.577580, 0.0451862, 0.0212190);
    let near = |bytes: Vec<u8>, name: &str, right: Rgb, tolerance: f32| {
        let found = read(&bytes, name).unwrap_or_else(|| panic!("{name}")).texels.get(0, 0);
        assert!((found - right).abs().max_element() <= tolerance, "{name}: {found}");
    };
    near(encoded(ImageFormat::Png, rgba8.clone()), "a.png", srgb, 1e-6);
    near(encoded(ImageFormat::WebP, rgba8.clone()), "a.webp", srgb, 1e-6);
    // Inks are stored as the light that they leave, 255 for none.
    near(cmyk([200, 60, 40, 255]), "b.jpg", srgb, 1e-3);
    near(cmyk([255, 255, 255, 60]), "c.jpg", Rgb::splat(srgb.y), 1e-3);
    near(encoded(ImageFormat::Png, rgb16.into()), "b.png", srgb, 1e-6);
    near(encoded(ImageFormat::Png, grey), "c.png", Rgb::splat(srgb.x), 1e-6);
    near(palette(), "d.png", srgb, 1e-6);
    near(encoded(ImageFormat::Bmp, rgb8.clone()), "a.bmp", srgb, 1e-6);
    near(encoded(ImageFormat::Tga, rgba8), "a.tga", srgb, 1e-6);
    near(encoded(ImageFormat::Jpeg, rgb8), "a.jpg", srgb, 0.02);
    near(encoded(ImageFormat::Hdr, floats.into()), "a.hdr", Rgb::new(0.5, 1.0, 2.0), 0.01);
    for (name, signature) in [
        ("a.gif", &b"GIF89a\x01\0\x01\0\0\0\0;"[..]),
        ("a.tif", b"II*\0\x08\0\0\0"),
        ("a.dds", b"DDS \x7c\0\0\0"),
        ("a.ktx2", b"\xabKTX 20\xbb\r\n\x1a\n"),
    ] {
        assert!(read(signature, name).is_none(), "{name}");
    }
}

/// Returns a file of 3 x 2 pixels with constant channels, whose attributes are changed.
fn exr(channels: &[(&str, f32)], change: impl FnOnce(&mut exr::meta::header::ImageAttributes)) -> Vec<u8> {
    exr_of(channels, |image| change(&mut image.attributes))
}

/// Returns a file of 3 x 2 pixels with constant channels, which is changed.
fn exr_of(
    channels: &[(&str, f32)],
    change: impl FnOnce(&mut Image<Layer<AnyChannels<FlatSamples>>>),
) -> Vec<u8> {
    let channel = |(name, value): &(&str, f32)| AnyChannel::new(*name, FlatSamples::F32(vec![*value; 6]));
    let list = channels.iter().map(channel).collect();
    let mut image = Image::from_channels((3, 2), AnyChannels::sort(list));
    change(&mut image);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn each_channel_of_an_exr_has_its_meaning() {
    let colour = |channels: &[(&str, f32)]| {
        let decoded = read(&exr(channels, |_| ()), "a.exr")?;
        assert!(
            (decoded.width, decoded.height) == (3, 2)
                && decoded.texels.all(|t| t == decoded.texels.get(0, 0))
        );
        Some(decoded.texels.get(0, 0))
    };
    let layer = |layer: &'static str, [r, g, b]: [f32; 3]| {
        [("R", r), ("G", g), ("B", b)].map(|(name, value)| {
            let name = if layer.is_empty() { name.to_owned() } else { format!("{layer}.{name}") };
            (&*name.leak(), value)
        })
    };
    let (own, right) = ([0.5, 1.0, 2.0], Some(Rgb::new(0.5, 1.0, 2.0)));
    let other = layer("albedo", [0.9, 0.1, 0.05]);
    let more = [("A", 0.5), ("N.X", 7.0), ("N.Y", 7.0), ("N.Z", 7.0), ("Z", 7.0)];
    for name in ["", "View.Combined", "beauty", "rgba", "rgb", "color", "colour"] {
        assert_eq!(colour(&[&layer(name, own)[..], &other, &more].concat()), right, "{name}");
    }
    assert_eq!(colour(&[&layer("shot", own)[..], &more].concat()), right);
    assert_eq!(colour(&[&[("Y", 0.25)], &other[..], &more].concat()), Some(Rgb::splat(0.25)));
    assert_eq!(colour(&[&layer("shot", own)[..], &other].concat()), None);
    let chroma = colour(&[("Y", 0.34934), ("RY", 0.6 / 0.34934 - 1.0), ("BY", 0.1 / 0.34934 - 1.0)]).unwrap();
    assert!((chroma - Rgb::new(0.6, 0.3, 0.1)).abs().max_element() < 1e-4, "{chroma}");
    // The first view is the default.
    let views = ["left", "right"].map(exr::prelude::Text::from).to_vec();
    let stereo = exr_of(&[layer("left", own), layer("right", [7.0; 3])].concat(), |image| {
        image.layer_data.attributes.multi_view_names = Some(views);
    });
    assert_eq!(read(&stereo, "a.exr").unwrap().texels.get(0, 0), right.unwrap());
    // The display window is the image.
    let wider = exr(&layer("", own), |attributes| {
        attributes.display_window = IntegerBounds { position: Vec2(-1, 0), size: Vec2(4, 2) };
    });
    let decoded = read(&wider, "a.exr").unwrap();
    assert_eq!((decoded.width, decoded.texels.get(0, 0)), (4, Rgb::ZERO));
    assert_eq!(decoded.texels.get(1, 1), right.unwrap());
    // White stays white whatever the primaries are.
    let wide = exr(&layer("", [0.5; 3]), |attributes| {
        attributes.chromaticities = Some(Chromaticities {
            red: Vec2(0.708, 0.292),
            green: Vec2(0.170, 0.797),
            blue: Vec2(0.131, 0.046),
            white: Vec2(0.3127, 0.3290),
        });
    });
    let white = read(&wide, "a.exr").unwrap().texels.get(0, 0);
    assert!((white - Rgb::splat(0.5)).abs().max_element() < 1e-6, "{white}");
}
