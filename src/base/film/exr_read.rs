//! Reader of flat OpenEXR files: half, float or integer channels, layered names, several parts.

use super::exr_write::PREFIX;
use super::{CameraMatrices, Fact, Image, ImageError, Metadata};
use crate::film::Window;
use crate::math::Rgb;
use ::exr::meta::header::Header;
use ::exr::prelude::{
    AttributeValue, Error, FlatImage, FlatSamples, Layer, ReadChannels, ReadLayers, Text, Vec2, read,
};
use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

/// Names of the colour channels of an image, by preference.
const COLOR: [[&str; 3]; 2] = [["R", "G", "B"], ["Y"; 3]];
/// Names of the colour channels of a layer, by preference.
const LAYER: [[&str; 3]; 3] = [["R", "G", "B"], ["X", "Y", "Z"], ["Y"; 3]];

/// An OpenEXR file in memory.
#[derive(Clone, Debug)]
pub struct ExrFile {
    pub(super) path: PathBuf,
    pub(super) parts: FlatImage,
}

/// Indices of three channels in a file. The channels may be equal.
#[derive(Clone, Copy)]
pub(super) struct ChannelPlace {
    /// Index of the part.
    pub part: usize,
    /// Indices of the channels in the part.
    pub channels: [usize; 3],
}

impl ExrFile {
    /// Reads all channels of the file at `path`.
    ///
    /// # Errors
    /// If the file cannot be read, or is no supported OpenEXR image.
    pub fn read(path: &Path) -> Result<ExrFile, ImageError> {
        let fail = |error| ImageError::Read { path: path.to_owned(), error };
        // Opening a pipe would wait for its writer.
        if !fs::metadata(path).map_err(fail)?.is_file() {
            return Err(fail(io::Error::other("it is not a regular file")));
        }
        let file = File::open(path).map_err(fail)?;
        let decode = |error: Error| match error {
            Error::Io(error) => fail(error),
            other => ImageError::Decode { path: path.to_owned(), reason: other.to_string() },
        };
        let chunks = ::exr::block::read(BufReader::new(file), false).map_err(decode)?;
        check_memory(chunks.headers())
            .map_err(|reason| ImageError::Decode { path: path.to_owned(), reason })?;
        let parts = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_chunks(chunks)
            .map_err(decode)?;
        Ok(ExrFile { path: path.to_owned(), parts })
    }

    /// Returns the colour of the image: `R`, `G`, `B`, else the luminance `Y` as grey, else the colour of the only
    /// layer with one, or of Blender's `Combined`.
    ///
    /// # Errors
    /// If there is no colour.
    pub fn color(&self) -> Result<Image, ImageError> {
        self.join(self.color_place()?)
    }

    /// Returns the channels of [`ExrFile::color`].
    pub(super) fn color_place(&self) -> Result<ChannelPlace, ImageError> {
        let layer = || {
            let layers = self.layers();
            let combined = |layer: &&String| layer.rsplit('.').next() == Some("Combined");
            let only = layers.first().filter(|_| layers.len() == 1);
            self.find(only.or_else(|| layers.iter().find(combined))?, &LAYER)
        };
        self.find("", &COLOR).or_else(layer).ok_or_else(|| self.missing("colour (R, G, B or Y)".to_owned()))
    }

    /// Returns the values of layer `name`: the channels `name.R`, `name.G`, `name.B`, or X, Y, Z, or a part of that
    /// name.
    ///
    /// A single channel `name.Y` or `name` is read as grey.
    ///
    /// # Errors
    /// If there are no such channels.
    pub fn layer(&self, name: &str) -> Result<Image, ImageError> {
        self.join(self.find(name, &LAYER).ok_or_else(|| self.missing(format!("layer `{name}`")))?)
    }

    /// Returns the unsigned integers of the channel `name`, if there is one.
    pub fn numbers(&self, name: &str) -> Option<Image<u32>> {
        let part = self.parts.layer_data.first()?;
        let channel = part.channel_data.list.iter().find(|channel| text(&channel.name) == name)?;
        let (width, height) = (part.size.0, part.size.1);
        match &channel.sample_data {
            FlatSamples::U32(pixels) if pixels.len() == width * height => {
                Some(Image { width: width as u32, height: height as u32, pixels: pixels.clone() })
            }
            _ => None,
        }
    }

    /// Returns the names of all layers with a colour, in the file's order. The image itself has the name "".
    pub fn layers(&self) -> Vec<String> {
        let (mut names, channels) = (Vec::new(), self.channels());
        // Y with X is a coordinate, not a luminance.
        let is_vector = |layer: &str| channels.iter().any(|name| *name == format!("{layer}.X"));
        for name in &channels {
            let layer = match name.rsplit_once('.') {
                Some((layer, "R")) => layer,
                Some((layer, "Y")) if !is_vector(layer) => layer,
                None if matches!(name.as_str(), "R" | "Y") => "",
                _ => continue,
            };
            if !names.iter().any(|known| known == layer) {
                names.push(layer.to_owned());
            }
        }
        names
    }

    /// Returns the window that the first part covers within the whole film.
    pub fn window(&self) -> Window {
        let display = self.parts.attributes.display_window;
        let film = [display.size.0 as u32, display.size.1 as u32];
        let Some(part) = self.parts.layer_data.first() else { return Window::whole(film) };
        let Vec2(x, y) = part.attributes.layer_position - display.position;
        Window {
            film,
            offset: [x.max(0) as u32, y.max(0) as u32],
            width: part.size.0 as u32,
            height: part.size.1 as u32,
        }
    }

    /// Returns the camera of the image, if the file states it.
    pub fn camera(&self) -> Option<CameraMatrices> {
        let attributes = &self.parts.layer_data.first()?.attributes;
        let (world_to_camera, world_to_ndc) =
            attributes.world_to_camera.zip(attributes.world_to_normalized_device)?;
        Some(CameraMatrices { world_to_camera, world_to_ndc })
    }

    /// Returns the metadata that this program wrote, sorted by key; empty for files of other programs.
    pub fn metadata(&self) -> Metadata {
        let attributes = self.parts.layer_data.first().map(|part| &part.attributes.other);
        let mut facts: Vec<(String, Fact)> = attributes
            .into_iter()
            .flatten()
            .filter_map(|(name, value)| {
                let key = text(name).strip_prefix(PREFIX)?.to_owned();
                match value {
                    AttributeValue::Text(words) => Some((key, Fact::Text(text(words)))),
                    AttributeValue::F64(number) => Some((key, Fact::Number(*number))),
                    _ => None,
                }
            })
            .collect();
        facts.sort_by(|a, b| a.0.cmp(&b.0));
        let mut metadata = Metadata::default();
        facts.into_iter().for_each(|(key, value)| metadata.set(&key, value));
        metadata
    }

    /// Returns the names of all channels, with those of their parts, in the file's order.
    pub fn channels(&self) -> Vec<String> {
        let mut names = Vec::new();
        for part in &self.parts.layer_data {
            let own = part_name(part);
            for channel in &part.channel_data.list {
                let name = text(&channel.name);
                names.push(if own.is_empty() { name } else { format!("{own}.{name}") });
            }
        }
        names
    }

    /// Returns the channels of `layer`: the first three of `names` that all exist, or the single channel called
    /// `layer`.
    fn find(&self, layer: &str, names: &[[&str; 3]]) -> Option<ChannelPlace> {
        let prefix = if layer.is_empty() { String::new() } else { format!("{layer}.") };
        self.parts.layer_data.iter().enumerate().find_map(|(index, part)| {
            let own = part_name(part);
            let channel = |wanted: &str| {
                part.channel_data.list.iter().position(|c| {
                    let name = text(&c.name);
                    name == wanted || (!own.is_empty() && format!("{own}.{name}") == wanted)
                })
            };
            let three =
                names.iter().find_map(|names| match names.map(|name| channel(&format!("{prefix}{name}"))) {
                    [Some(a), Some(b), Some(c)] => Some([a, b, c]),
                    _ => None,
                });
            let channels = three.or_else(|| channel(layer).map(|scalar| [scalar; 3]))?;
            Some(ChannelPlace { part: index, channels })
        })
    }

    fn join(&self, place: ChannelPlace) -> Result<Image, ImageError> {
        let decode = |reason: String| ImageError::Decode { path: self.path.clone(), reason };
        let part = &self.parts.layer_data[place.part];
        let channels = place.channels.map(|index| &part.channel_data.list[index]);
        let [width, height] = [part.size.0, part.size.1];
        for channel in channels {
            if channel.sampling != Vec2(1, 1) || channel.sample_data.len() != width * height {
                return Err(decode(format!("channel {} is subsampled", text(&channel.name))));
            }
        }
        let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(decode(format!("{width}x{height} pixels are too many")));
        };
        let [r, g, b] = channels.map(|channel| channel.sample_data.values_as_f32());
        let pixels = r.zip(g).zip(b).map(|((r, g), b)| Rgb::new(r, g, b)).collect();
        Ok(Image { width: columns, height: rows, pixels })
    }

    fn missing(&self, wanted: String) -> ImageError {
        ImageError::NoColor { path: self.path.clone(), wanted, channels: self.channels() }
    }
}

/// Reads the colour of the OpenEXR image at `path`; see [`ExrFile::color`].
///
/// # Errors
/// If the file cannot be read, or has no colour.
pub fn read_exr(path: &Path) -> Result<Image, ImageError> {
    ExrFile::read(path)?.color()
}

/// Checks that the memory exists that the header claims to need, by allocating and freeing it.
///
/// The OpenEXR library would abort the process on a damaged header with a size of terabytes.
fn check_memory(headers: &[Header]) -> Result<(), String> {
    let mut bytes = 0usize;
    for header in headers {
        let Vec2(width, height) = header.layer_size;
        let pixel: usize = header.channels.list.iter().map(|c| c.sample_type.bytes_per_sample()).sum();
        let part = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(pixel));
        bytes = part
            .and_then(|part| bytes.checked_add(part))
            .ok_or_else(|| format!("its header claims {width}x{height} pixels"))?;
    }
    Vec::<u8>::new()
        .try_reserve_exact(bytes)
        .map_err(|_| format!("its header claims {} MiB of pixels, more than there is memory", bytes >> 20))
}

fn part_name<C>(part: &Layer<C>) -> String {
    part.attributes.layer_name.as_ref().map(text).unwrap_or_default()
}

pub(super) fn text(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
