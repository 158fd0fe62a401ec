//! Writer of OpenEXR files: one part, 32-bit float, layers as dotted channels, metadata as attributes. Colours, albedos
//! and normals may be half floats.
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

/// Prefix of attributes of Cryptomatte, which have no other.
const CRYPTOMATTE: &str = "cryptomatte/";

/// Layers that are half floats if the film asks for it; the image has the name "".
const HALVES: [&str; 5] = ["", "noisy", "albedo", "normal", "geometricNormal"];

/// End of the names of layers that files with half floats leave out: half floats cannot hold small variances.
const VARIANCE: &str = "variance";

type Channels = SmallVec<[AnyChannel<FlatSamples>; 4]>;

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
    let mut channels = Channels::new();
    let triples = |name: &str, components: [&str; 3], image: &super::Image, channels: &mut Channels| {
        let is_half = film.half && HALVES.contains(&name);
        for (i, component) in components.into_iter().enumerate() {
            let values = image.pixels.iter().map(|pixel| pixel[i]);
            let name = if name.is_empty() { component.to_owned() } else { format!("{name}.{component}") };
            channels.push(if is_half { halves(&name, values) } else { floats(&name, values) });
        }
    };
    triples("", ["R", "G", "B"], &film.color, &mut channels);
    for layer in film.layers.iter().filter(|layer| !film.half || !layer.name.ends_with(VARIANCE)) {
        let name = &layer.name;
        match &layer.pixels {
            Pixels::Color(image) => triples(name, ["R", "G", "B"], image, &mut channels),
            Pixels::Vector(image) => triples(name, ["X", "Y", "Z"], image, &mut channels),
            Pixels::Scalar(image) => channels.push(floats(name, image.pixels.iter().copied())),
            Pixels::Id(image) => channels.push(channel(name, FlatSamples::U32(image.pixels.clone()))),
            Pixels::Ranks(image) => {
                channels.extend(["R", "G", "B", "A"].into_iter().enumerate().map(|(i, component)| {
                    floats(&format!("{name}.{component}"), image.pixels.iter().map(|p| p[i]))
                }))
            }
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

fn floats(name: &str, values: impl Iterator<Item = f32>) -> AnyChannel<FlatSamples> {
    channel(name, FlatSamples::F32(values.map(|x| finite(name, x)).collect()))
}

fn halves(name: &str, values: impl Iterator<Item = f32>) -> AnyChannel<FlatSamples> {
    // Larger numbers would become infinite.
    let half = |x: f32| f16::from_f32(finite(name, x).clamp(f16::MIN.to_f32(), f16::MAX.to_f32()));
    channel(name, FlatSamples::F16(values.map(half).collect()))
}

fn finite(name: &str, x: f32) -> f32 {
    debug_assert!(x.is_finite(), "{name} is not finite");
    if x.is_finite() { x } else { 0.0 }
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
    let prefix = if key.starts_with(CRYPTOMATTE) { "" } else { PREFIX };
    Text::from_slice_unchecked(format!("{prefix}{key}").as_bytes())
}

fn into_io(error: Error) -> io::Error {
    match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
