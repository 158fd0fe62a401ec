//! OpenEXR files: one part, 32-bit float, layers as dotted channels, metadata as attributes.
//!
//! The colour is `R`, `G`, `B`; layer `variance` is `variance.R` and so on. A cropped picture has its window
//! as data window within the whole film as display window. Compression is RLE: lossless, and on rendered floats within 3 % of ZIP in size at a tenth of its time.
//!
//! Units: radiance W/(sr m²), linear, Rec. 709 primaries (stated in the file).

use super::{Film, ImageError, Metadata, Value, atomic};
use crate::math::Rgb;
use ::exr::prelude::*;
use std::io;
use std::path::Path;

/// Prefix of our attributes.
pub(super) const PREFIX: &str = "lightsplat.";

/// Writes `film` to `path`, whole or not at all.
///
/// A picture never contains NaN or infinity: see [`Film::remove_nonfinite`], which the caller runs first so
/// that it can report the number; here they are an error in a debug build and 0 otherwise.
pub fn write_exr(path: &Path, film: &Film) -> std::result::Result<(), ImageError> {
    film.check_sizes()?;
    let window = film.window;
    let channel = |name: String, image: &super::Image, component: fn(&Rgb) -> f32| {
        let finite = |x: f32| {
            debug_assert!(x.is_finite(), "{name} is not finite");
            if x.is_finite() { x } else { 0.0 }
        };
        let samples = image.pixels.iter().map(|p| finite(component(p))).collect();
        AnyChannel::new(Text::from_slice_unchecked(name.as_bytes()), FlatSamples::F32(samples))
    };
    let mut channels = SmallVec::new();
    for (layer, image) in film.images() {
        let prefix = if layer.is_empty() { String::new() } else { format!("{layer}.") };
        channels.push(channel(format!("{prefix}R"), image, |p| p.x));
        channels.push(channel(format!("{prefix}G"), image, |p| p.y));
        channels.push(channel(format!("{prefix}B"), image, |p| p.z));
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
    picture.attributes.chromaticities = Some(::exr::meta::attribute::Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    atomic::write_atomically(path, |file| picture.write().to_buffered(file).map_err(into_io))
        .map_err(|source| ImageError::Write { path: path.to_owned(), source })
}

fn attributes(film: &Film) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        layer_position: Vec2(film.window.offset[0] as i32, film.window.offset[1] as i32),
        software_name: Some(Text::from(concat!("lightsplat ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    add(&mut attributes, &film.metadata);
    attributes
}

fn add(attributes: &mut LayerAttributes, metadata: &Metadata) {
    for (key, value) in metadata.iter() {
        let value = match value {
            // OpenEXR strings are UTF-8; the crate's checked constructors know Latin-1 only.
            Value::Text(text) => AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes())),
            Value::Number(number) => AttributeValue::F64(*number),
        };
        let name = format!("{PREFIX}{key}");
        attributes.other.insert(Text::from_slice_unchecked(name.as_bytes()), value);
    }
}

fn into_io(error: Error) -> io::Error {
    match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
