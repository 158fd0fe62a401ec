//! Writer of OpenEXR files: one part, 32-bit float, layers as dotted channels, metadata as attributes.
//!
//! The colour is `R`, `G`, `B`; for layers see [`super::layer`]. A cropped image has its window as data window, and the
//! whole film as display window. Compression is RLE, which is lossless. On rendered floats its files are within 3 % of
//! ZIP's size.
//!
//! Units: radiance W/(sr m²), linear, Rec. 709 primaries (stated in the file).

use super::exr_order::sort_attributes;
use super::{Fact, Film, ImageError, Metadata, Pixels, atomic};
use crate::exr_file::REC_709;
use ::exr::prelude::*;
use std::io::{self, Cursor, Write as _};
use std::path::Path;

/// Prefix of the program's own attributes.
pub(super) const PREFIX: &str = "lightsplat.";

/// Writes `film` to `path`, completely or not at all.
///
/// Images must not contain NaN or infinity. The caller runs [`Film::remove_nonfinite`] first, to report their number.
/// Here they are a panic in a debug build, and 0 otherwise.
///
/// # Errors
/// If the sizes of images differ, or writing fails.
pub fn write_exr(path: &Path, film: &Film) -> std::result::Result<(), ImageError> {
    film.check_sizes()?;
    let window = film.window;
    let mut channels = SmallVec::new();
    push(&mut channels, "", ["R", "G", "B"], &film.color);
    for layer in &film.layers {
        match &layer.pixels {
            Pixels::Color(image) => push(&mut channels, &layer.name, ["R", "G", "B"], image),
            Pixels::Vector(image) => push(&mut channels, &layer.name, ["X", "Y", "Z"], image),
            Pixels::Scalar(image) => channels.push(floats(&layer.name, image.pixels.iter().copied())),
            Pixels::Id(image) => channels.push(channel(&layer.name, FlatSamples::U32(image.pixels.clone()))),
        }
    }
    let encoding = Encoding {
        compression: Compression::RLE,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = Vec2(window.width as usize, window.height as usize);
    let layer = Layer::new(size, attributes(film), encoding, AnyChannels::sort(channels));
    let resolution = Vec2(window.film[0] as usize, window.film[1] as usize);
    let mut picture = Image::new(ImageAttributes::with_size(resolution), layer);
    picture.attributes.chromaticities = Some(REC_709);
    write(path, |bytes| picture.write().to_buffered(bytes))
}

/// Writes the output of `encode` with sorted attributes, completely or not at all.
pub(super) fn write(
    path: &Path,
    encode: impl FnOnce(&mut Cursor<Vec<u8>>) -> std::result::Result<(), Error>,
) -> std::result::Result<(), ImageError> {
    atomic::write_atomically(path, |file| {
        let mut bytes = Cursor::new(Vec::new());
        encode(&mut bytes).map_err(into_io)?;
        let mut bytes = bytes.into_inner();
        sort_attributes(&mut bytes);
        file.write_all(&bytes)
    })
    .map_err(|error| ImageError::Write { path: path.to_owned(), error })
}

/// Appends the three channels of a layer.
fn push(
    channels: &mut SmallVec<[AnyChannel<FlatSamples>; 4]>,
    layer: &str,
    names: [&str; 3],
    image: &super::Image,
) {
    for (i, name) in names.into_iter().enumerate() {
        let name = if layer.is_empty() { name.to_owned() } else { format!("{layer}.{name}") };
        channels.push(floats(&name, image.pixels.iter().map(|pixel| pixel[i])));
    }
}

fn floats(name: &str, values: impl Iterator<Item = f32>) -> AnyChannel<FlatSamples> {
    let finite = |x: f32| {
        debug_assert!(x.is_finite(), "{name} is not finite");
        if x.is_finite() { x } else { 0.0 }
    };
    channel(name, FlatSamples::F32(values.map(finite).collect()))
}

fn channel(name: &str, samples: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel::new(Text::from_slice_unchecked(name.as_bytes()), samples)
}

fn attributes(film: &Film) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        world_to_camera: film.camera.map(|camera| camera.world_to_camera),
        world_to_normalized_device: film.camera.map(|camera| camera.world_to_ndc),
        layer_position: Vec2(film.window.offset[0] as i32, film.window.offset[1] as i32),
        software_name: Some(Text::from(concat!("lightsplat ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    add(&mut attributes, &film.metadata);
    attributes
}

fn add(attributes: &mut LayerAttributes, metadata: &Metadata) {
    for (key, value) in metadata.iter() {
        set(attributes, key, value);
    }
}

/// Sets the attribute of a fact.
pub(super) fn set(attributes: &mut LayerAttributes, key: &str, value: &Fact) {
    let value = match value {
        // OpenEXR strings are UTF-8, but the crate's checked constructors accept Latin-1 only.
        Fact::Text(text) => AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes())),
        Fact::Number(number) => AttributeValue::F64(*number),
    };
    attributes.other.insert(name_of(key), value);
}

/// Returns the name of a fact's attribute.
pub(super) fn name_of(key: &str) -> Text {
    Text::from_slice_unchecked(format!("{PREFIX}{key}").as_bytes())
}

fn into_io(error: Error) -> io::Error {
    match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
