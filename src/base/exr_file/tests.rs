//! Tests on files made byte by byte: subsampled channels, windows, parts in any order, primaries, damage.

use super::*;
use crate::math::Rgb;
use ::exr::compression::Compression;
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, SampleType};
use ::exr::meta::header::Header;
use ::exr::prelude::{Text, Vec2};
use std::io::Cursor;

/// A channel of floats: name, sampling in both directions, and the sample at a pixel.
type Channel = (&'static str, usize, fn(i32, i32) -> f32);

/// A part of a file; windows have the first and the last pixel.
struct Part {
    name: &'static str,
    kind: &'static str,
    channels: Vec<Channel>,
    data: [i32; 4],
    display: [i32; 4],
    compression: Compression,
    primaries: Option<[f32; 8]>,
}

impl Part {
    fn new(channels: &[Channel]) -> Part {
        let (data, compression) = ([0, 0, 5, 3], Compression::Uncompressed);
        let channels = channels.to_vec();
        Part { name: "", kind: "scanlineimage", channels, data, display: data, compression, primaries: None }
    }

    /// Returns a part whose colour is constant.
    fn rgb(name: &'static str) -> Part {
        Part { name, ..Part::new(&[("B", 1, |_, _| 2.0), ("G", 1, |_, _| 1.0), ("R", 1, |_, _| 0.5)]) }
    }

    fn header(&self) -> Vec<u8> {
        let mut header = Vec::new();
        let mut attribute = |name: &str, kind: &str, value: &[u8]| {
            header.extend([name.as_bytes(), &[0], kind.as_bytes(), &[0]].concat());
            header.extend((value.len() as i32).to_le_bytes());
            header.extend(value);
        };
        let mut list = Vec::new();
        for (name, sampling, _) in &self.channels {
            list.extend([name.as_bytes(), &[0], &2i32.to_le_bytes(), &[0; 4]].concat());
            list.extend([(*sampling as i32).to_le_bytes(); 2].concat());
        }
        list.push(0);
        let kind = match self.compression {
            Compression::Uncompressed => 0u8,
            Compression::ZIP16 => 3,
            Compression::PIZ => 4,
            other => panic!("{other}"),
        };
        attribute("channels", "chlist", &list);
        attribute("compression", "compression", &[kind]);
        attribute("dataWindow", "box2i", &self.data.map(i32::to_le_bytes).concat());
        attribute("displayWindow", "box2i", &self.display.map(i32::to_le_bytes).concat());
        attribute("lineOrder", "lineOrder", &[0]);
        attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
        attribute("screenWindowCenter", "v2f", &[0; 8]);
        attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
        if let Some(numbers) = self.primaries {
            attribute("chromaticities", "chromaticities", &numbers.map(f32::to_le_bytes).concat());
        }
        if !self.name.is_empty() {
            attribute("name", "string", self.name.as_bytes());
            attribute("type", "string", self.kind.as_bytes());
            attribute("chunkCount", "int", &(self.blocks().len() as i32).to_le_bytes());
            if self.kind.starts_with("deep") {
                attribute("version", "int", &1i32.to_le_bytes());
            }
        }
        header.push(0);
        header
    }

    /// Returns the first line and the bytes of each block.
    fn blocks(&self) -> Vec<(i32, Vec<u8>)> {
        let [left, top, right, bottom] = self.data;
        let lines = self.compression.scan_lines_per_block();
        let block = |first: i32| {
            let end = (first + lines as i32).min(bottom + 1);
            let mut bytes = Vec::new();
            for y in first..end {
                for (_, sampling, value) in &self.channels {
                    let sampling = *sampling as i32;
                    if y % sampling == 0 {
                        let row = (left..=right).filter(|x| x % sampling == 0);
                        row.for_each(|x| bytes.extend(value(x, y).to_le_bytes()));
                    }
                }
            }
            let size = Vec2((right - left + 1) as usize, (end - first) as usize);
            (first, self.compressed(bytes, IntegerBounds { position: Vec2(0, first - top), size }))
        };
        (top..=bottom).step_by(lines).map(block).collect()
    }

    fn compressed(&self, bytes: Vec<u8>, section: IntegerBounds) -> Vec<u8> {
        let description = |(name, sampling, _): &Channel| ChannelDescription {
            name: Text::from(*name),
            sample_type: SampleType::F32,
            quantize_linearly: false,
            sampling: Vec2(*sampling, *sampling),
        };
        let mut channels = ChannelList::new(self.channels.iter().map(description).collect());
        channels.bytes_per_pixel = bytes.len() / section.size.area();
        let mut header = Header::new(Text::from(""), section.size, channels.list.clone());
        (header.channels, header.compression) = (channels, self.compression);
        header.blocks = BlockDescription::ScanLines;
        self.compression.compress_image_section_to_le(&header, bytes, section).unwrap()
    }
}

/// Returns the bytes of a file.
fn file(parts: &[Part]) -> Vec<u8> {
    let several = parts.len() > 1;
    let is_deep = parts.iter().any(|part| part.kind.starts_with("deep"));
    let flags = (if several { 0x10 } else { 0 }) | if is_deep { 0x08 } else { 0 };
    let mut bytes = vec![0x76, 0x2F, 0x31, 0x01, 2, flags, 0, 0];
    parts.iter().for_each(|part| bytes.extend(part.header()));
    if several {
        bytes.push(0);
    }
    let blocks: Vec<(usize, i32, Vec<u8>)> = (parts.iter().enumerate())
        .flat_map(|(i, part)| part.blocks().into_iter().map(move |(y, block)| (i, y, block)))
        .collect();
    let mut at = bytes.len() + 8 * blocks.len();
    let head = if several { 12 } else { 8 };
    for (_, _, block) in &blocks {
        bytes.extend((at as u64).to_le_bytes());
        at += head + block.len();
    }
    for (part, y, block) in blocks {
        if several {
            bytes.extend((part as i32).to_le_bytes());
        }
        bytes.extend([y.to_le_bytes(), (block.len() as i32).to_le_bytes()].concat());
        bytes.extend(block);
    }
    bytes
}

fn read(bytes: &[u8], raw: bool) -> Result<ExrPicture, ExrError> {
    let mut source = ExrSource::open(Cursor::new(bytes))?;
    read_picture(&mut source, raw, |[width, height], _| match width * height {
        0..=10_000 => Ok(()),
        _ => Err(ExrError::Content("too large".to_owned())),
    })
}

fn picture(parts: &[Part]) -> ExrPicture {
    read(&file(parts), false).unwrap()
}

fn near(a: Rgb, b: Rgb) -> bool {
    (a - b).abs().max_element() < 1e-4
}

#[test]
fn the_colour_without_layer_is_read_among_layers_before_it() {
    let mut part = Part::rgb("");
    part.channels.extend::<[Channel; 3]>([
        ("Albedo.B", 1, |_, _| 0.05),
        ("Albedo.G", 1, |_, _| 0.1),
        ("Albedo.R", 1, |_, _| 0.9),
    ]);
    part.channels.sort_by_key(|channel| channel.0);
    let found = picture(&[part]);
    assert_eq!((found.size, found.pixels), ([6, 4], vec![Rgb::new(0.5, 1.0, 2.0); 24]));
}

#[test]
fn parts_stand_in_any_order_and_deep_ones_are_left_out() {
    let depth = || Part { name: "depth", ..Part::new(&[("Z", 1, |_, _| 7.0)]) };
    let normal = || Part { name: "normal", ..Part::new(&[("N.X", 1, |_, _| 7.0), ("N.Y", 1, |_, _| 7.0)]) };
    let deep = || Part { kind: "deepscanline", ..Part::rgb("volume") };
    let right = vec![Rgb::new(0.5, 1.0, 2.0); 24];
    assert_eq!(picture(&[depth(), normal(), Part::rgb("beauty")]).pixels, right);
    assert_eq!(picture(&[Part::rgb("beauty"), Part::rgb("albedo"), depth()]).pixels, right);
    assert_eq!(picture(&[deep(), depth(), Part::rgb("shot")]).pixels, right);
    let refused = |parts: &[Part]| read(&file(parts), false).unwrap_err().to_string();
    assert!(refused(&[Part::rgb("a"), Part::rgb("b")]).contains("a.B, a.G, a.R, b.B"));
    assert!(refused(&[deep(), depth()]).contains("flatten"));
    assert!(refused(&[deep()]).contains("deep data"));
}

#[test]
fn subsampled_chroma_becomes_colours_under_every_compression() {
    // Colour (0.6, 0.3, 0.1) by the weights of Rec. 709.
    let channels: [Channel; 3] = [
        ("BY", 2, |_, _| 0.1 / 0.34934 - 1.0),
        ("RY", 2, |_, _| 0.6 / 0.34934 - 1.0),
        ("Y", 1, |x, y| 0.34934 * (1 + x + y) as f32),
    ];
    for compression in [Compression::Uncompressed, Compression::ZIP16, Compression::PIZ] {
        for data in [[0, 0, 5, 3], [-4, -2, 31, 37]] {
            let part = Part { compression, data, display: data, ..Part::new(&channels) };
            let found = picture(&[part]);
            let width = found.size[0];
            for (i, pixel) in found.pixels.iter().enumerate() {
                let at = 1 + data[0] + data[1] + (i % width + i / width) as i32;
                let right = Rgb::new(0.6, 0.3, 0.1) * at as f32;
                assert!((*pixel - right).abs().max_element() < 2e-4 * (1.0 + at.abs() as f32), "{pixel}");
            }
        }
    }
    // Chroma between samples is their mean, beyond the last one it is repeated.
    let ramp: [Channel; 3] = [("BY", 2, |_, _| 0.0), ("RY", 2, |x, _| x as f32), ("Y", 1, |_, _| 1.0)];
    let reds: Vec<f32> = picture(&[Part::new(&ramp)]).pixels[6..12].iter().map(|pixel| pixel.x).collect();
    assert_eq!(reds, [1.0, 2.0, 3.0, 4.0, 5.0, 5.0]);
    // Without subsampling, and grey without chroma.
    let whole = channels.map(|(name, _, value)| (name, 1, value));
    assert!(near(picture(&[Part::new(&whole)]).pixels[0], Rgb::new(0.6, 0.3, 0.1)));
    assert_eq!(picture(&[Part::new(&[("Y", 1, |x, _| x as f32)])]).pixels[3], Rgb::splat(3.0));
}

#[test]
fn data_lie_in_the_display_window_and_the_rest_is_black() {
    let at: [Channel; 3] =
        [("B", 1, |_, _| 0.0), ("G", 1, |_, y| (10 + y) as f32), ("R", 1, |x, _| (10 + x) as f32)];
    let placed = |data, display| picture(&[Part { data, display, ..Part::new(&at) }]);
    let value = |x: i32, y: i32| Rgb::new((10 + x) as f32, (10 + y) as f32, 0.0);
    // A crop, with a corner outside the display.
    let found = placed([-1, -2, 1, 2], [0, 0, 3, 3]);
    assert_eq!(found.size, [4, 4]);
    for (i, pixel) in found.pixels.iter().enumerate() {
        let (x, y) = (i as i32 % 4, i as i32 / 4);
        assert_eq!(*pixel, if x <= 1 && y <= 2 { value(x, y) } else { Rgb::ZERO }, "{x}, {y}");
    }
    // Windows that do not begin at the origin.
    let found = placed([-3, 5, 2, 9], [-3, 5, 2, 9]);
    assert_eq!((found.size, found.pixels[7]), ([6, 5], value(-2, 6)));
    let outside = Part { data: [9, 9, 12, 12], ..Part::new(&at) };
    assert!(read(&file(&[outside]), false).unwrap_err().to_string().contains("outside the display window"));
}

#[test]
fn colours_of_other_primaries_are_converted_unless_raw() {
    // Rec. 2020. Matrix by ITU-R BT.2087.
    let primaries = Some([0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290]);
    let wide = || Part { primaries, ..Part::rgb("") };
    let own = Rgb::new(0.5, 1.0, 2.0);
    let right = Rgb::new(
        1.6605 * 0.5 - 0.5876 - 0.0728 * 2.0,
        1.1329 - 0.1246 * 0.5 - 0.0083 * 2.0,
        1.1187 * 2.0 - 0.0182 * 0.5 - 0.1006,
    );
    assert!((picture(&[wide()]).pixels[0] - right).abs().max_element() < 4e-4);
    assert_eq!(read(&file(&[wide()]), true).unwrap().pixels[0], own);
    let line = Part { primaries: Some([0.3; 8]), ..Part::rgb("") };
    assert!(read(&file(&[line]), false).unwrap_err().to_string().contains("chromaticities"));
}

#[test]
fn damaged_files_are_errors_and_no_panic() {
    let chroma: [Channel; 3] = [("BY", 2, |_, _| 0.0), ("RY", 2, |_, _| 0.0), ("Y", 1, |_, _| 1.0)];
    for parts in [vec![Part::new(&chroma)], vec![Part::rgb("a"), Part::rgb("beauty")]] {
        let whole = file(&parts);
        for length in 0..whole.len() {
            assert!(read(&whole[..length], false).is_err() || length + 100 > whole.len(), "{length} bytes");
        }
        for at in 0..whole.len() {
            for bit in [0x01, 0x15, 0x80] {
                let mut flipped = whole.clone();
                flipped[at] ^= bit;
                let _any_outcome_but_a_panic = read(&flipped, false);
            }
        }
    }
    let odd = Part { data: [0, 0, 4, 3], ..Part::new(&chroma) };
    assert!(read(&file(&[odd]), false).unwrap_err().to_string().contains("sampling"));
    let huge = Part { display: [0, 0, 1 << 30, 1 << 30], ..Part::rgb("") };
    assert!(read(&file(&[huge]), false).is_err());
}
