//! Reader of flat OpenEXR files: half, float or integer channels, layered names, several parts.

use super::exr_write::PREFIX;
use super::{ALPHA, BACKGROUND, CameraMatrices, Fact, Image, ImageError, Metadata, NO_BACKGROUND};
use crate::exr_file::{
    ColourModel, ExrError, ExrSource, NoPicture, PartNames, PictureChannels, Primaries, from_luma_chroma,
    picture_channels, views,
};
use crate::file_kind::file_kind;
use crate::film::Window;
use crate::math::Rgb;
use ::exr::meta::BlockDescription;
use ::exr::meta::header::Header;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Encoding, FlatImage, FlatSamples, Layer, Text, Vec2,
};
use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

/// Names of the colour channels of a layer, by preference, and their meaning.
const LAYER: [([&str; 3], ColourModel); 4] = [
    (["R", "G", "B"], ColourModel::Rgb),
    (["X", "Y", "Z"], ColourModel::Rgb),
    (["Y", "RY", "BY"], ColourModel::LumaChroma),
    (["Y"; 3], ColourModel::Luma),
];

/// Returns what a file is that is no OpenEXR image, if its first bytes tell it.
fn other_kind(path: &Path) -> Option<String> {
    let mut head = Vec::new();
    File::open(path).ok()?.take(1024).read_to_end(&mut head).ok()?;
    let kind = file_kind(&head).filter(|_| !head.starts_with(&MAGIC))?;
    Some(format!("it is {}; {}", kind.what, kind.remedy))
}

/// First bytes of an OpenEXR file.
const MAGIC: [u8; 4] = [0x76, 0x2F, 0x31, 0x01];

/// An OpenEXR file in memory.
#[derive(Clone, Debug)]
pub struct ExrFile {
    pub(super) path: PathBuf,
    pub(super) parts: FlatImage,
    /// Names of the parts that are left out, since their data are deep.
    deep: Vec<String>,
}

impl ExrFile {
    /// Reads all channels of the flat parts of the file at `path`. Subsampled channels are interpolated to full size.
    ///
    /// # Errors
    /// If the file cannot be read, or is no supported OpenEXR image.
    pub fn read(path: &Path) -> Result<ExrFile, ImageError> {
        let fail = |error| ImageError::Read { path: path.to_owned(), error };
        // Opening a pipe would wait for its writer.
        if !fs::metadata(path).map_err(fail)?.is_file() {
            return Err(fail(io::Error::other("this is not a regular file")));
        }
        let file = File::open(path).map_err(fail)?;
        let decode = |error: ExrError| match error {
            ExrError::Io(error) => fail(error),
            ExrError::Content(reason) => {
                ImageError::Decode { path: path.to_owned(), reason: other_kind(path).unwrap_or(reason) }
            }
        };
        let mut source = ExrSource::open(BufReader::new(file)).map_err(decode)?;
        check_memory(source.headers()).map_err(|reason| decode(ExrError::Content(reason)))?;
        let names = source.names();
        let (mut parts, mut deep) = (Vec::new(), Vec::new());
        for (index, names) in names.into_iter().enumerate() {
            if names.is_deep {
                deep.push(names.name);
            } else {
                parts.push(part(&mut source, index).map_err(decode)?);
            }
        }
        let attributes = source.headers()[0].shared_attributes.clone();
        let parts = FlatImage { attributes, layer_data: parts.into() };
        Ok(ExrFile { path: path.to_owned(), parts, deep })
    }

    /// Returns the colour of the image, by the rule of [`picture_channels`], in the primaries of the file.
    ///
    /// # Errors
    /// If there is no colour.
    pub fn color(&self) -> Result<Image, ImageError> {
        self.join(self.color_place()?)
    }

    /// Returns the channels of [`ExrFile::color`].
    pub(super) fn color_place(&self) -> Result<PictureChannels, ImageError> {
        let names = |part: &Layer<AnyChannels<_>>| PartNames {
            name: part_name(part),
            channels: part.channel_data.list.iter().map(|channel| text(&channel.name)).collect(),
            is_deep: false,
            views: views(&part.attributes),
        };
        let parts: Vec<PartNames> = self.parts.layer_data.iter().map(names).collect();
        picture_channels(&parts).map_err(|none| ImageError::NoPicture {
            path: self.path.clone(),
            none: NoPicture { has_deep: !self.deep.is_empty(), ..none },
        })
    }

    /// Converts colours of the file to linear Rec. 709.
    ///
    /// # Errors
    /// If the primaries of the file span no colours.
    pub fn to_rec_709(&self, mut image: Image) -> Result<Image, ImageError> {
        let primaries = self.primaries()?;
        if primaries.to_rec_709.is_some() {
            image.pixels.iter_mut().for_each(|pixel| *pixel = primaries.rec_709(*pixel));
        }
        Ok(image)
    }

    fn primaries(&self) -> Result<Primaries, ImageError> {
        let reason = || "the attribute chromaticities has primaries that span no colours".to_owned();
        Primaries::new(self.parts.attributes.chromaticities)
            .ok_or_else(|| ImageError::Decode { path: self.path.clone(), reason: reason() })
    }

    /// Checks that no part of the file is left out, so that an edited file loses nothing.
    ///
    /// # Errors
    /// If the file has deep parts.
    pub fn check_whole(&self) -> Result<(), ImageError> {
        match self.deep.first() {
            Some(name) => Err(ImageError::Decode {
                path: self.path.clone(),
                reason: format!(
                    "the part `{name}` holds deep data, which would be lost; remove this part from the file"
                ),
            }),
            None => Ok(()),
        }
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

    /// Returns the share of each pixel that surfaces cover, if the background is hidden from the camera.
    pub fn alpha(&self) -> Option<Image<f32>> {
        let hidden = self.metadata().text(BACKGROUND) == Some(NO_BACKGROUND);
        let alpha = hidden.then(|| self.layer(ALPHA).ok()).flatten()?;
        Some(alpha.map(|pixel| pixel.x))
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

    /// Returns the names of all channels, with the names of their parts, in the order of the file.
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
    fn find(&self, layer: &str, names: &[([&str; 3], ColourModel)]) -> Option<PictureChannels> {
        let prefix = if layer.is_empty() { String::new() } else { format!("{layer}.") };
        self.parts.layer_data.iter().enumerate().find_map(|(index, part)| {
            let own = part_name(part);
            let channel = |wanted: &str| {
                part.channel_data.list.iter().position(|c| {
                    let name = text(&c.name);
                    name == wanted || (!own.is_empty() && format!("{own}.{name}") == wanted)
                })
            };
            let three = names.iter().find_map(|(names, model)| {
                match names.map(|name| channel(&format!("{prefix}{name}"))) {
                    [Some(a), Some(b), Some(c)] => Some(([a, b, c], *model)),
                    _ => None,
                }
            });
            let scalar = || channel(layer).map(|scalar| ([scalar; 3], ColourModel::Luma));
            let (channels, model) = three.or_else(scalar)?;
            Some(PictureChannels { part: index, channels, model })
        })
    }

    fn join(&self, place: PictureChannels) -> Result<Image, ImageError> {
        let part = &self.parts.layer_data[place.part];
        let channels = place.channels.map(|index| &part.channel_data.list[index]);
        let [width, height] = [part.size.0, part.size.1];
        let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
            let reason = format!("{width}x{height} pixels are too many");
            return Err(ImageError::Decode { path: self.path.clone(), reason });
        };
        let [r, g, b] = channels.map(|channel| channel.sample_data.values_as_f32());
        let triples = r.zip(g).zip(b).map(|((r, g), b)| [r, g, b]);
        let pixels = match place.model {
            ColourModel::LumaChroma => {
                let weights = self.primaries()?.weights;
                triples.map(|triple| from_luma_chroma(triple, weights)).collect()
            }
            ColourModel::Rgb | ColourModel::Luma => triples.map(Rgb::from).collect(),
        };
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
    for header in headers.iter().filter(|header| !header.deep) {
        let Vec2(width, height) = header.layer_size;
        let pixel: usize = header.channels.list.iter().map(|c| c.sample_type.bytes_per_sample()).sum();
        let part = width.checked_mul(height).and_then(|pixels| pixels.checked_mul(pixel));
        bytes = part
            .and_then(|part| bytes.checked_add(part))
            .ok_or_else(|| format!("its header claims {width}x{height} pixels"))?;
    }
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| {
        format!("its header claims {} MiB of pixels, more than the available memory", bytes >> 20)
    })
}

/// Reads a flat part.
fn part(
    source: &mut ExrSource<BufReader<File>>,
    index: usize,
) -> Result<Layer<AnyChannels<FlatSamples>>, ExrError> {
    let count = source.headers()[index].channels.list.len();
    let planes = source.read(index, &(0..count).collect::<Vec<_>>())?;
    let header = &source.headers()[index];
    let channels = header.channels.list.iter().zip(planes).map(|(channel, samples)| AnyChannel {
        name: channel.name.clone(),
        sample_data: samples,
        quantize_linearly: channel.quantize_linearly,
        sampling: Vec2(1, 1),
    });
    let blocks = match header.blocks {
        BlockDescription::ScanLines => Blocks::ScanLines,
        BlockDescription::Tiles(tiles) => Blocks::Tiles(tiles.tile_size),
    };
    Ok(Layer {
        channel_data: AnyChannels { list: channels.collect() },
        attributes: header.own_attributes.clone(),
        size: header.layer_size,
        encoding: Encoding { compression: header.compression, blocks, line_order: header.line_order },
    })
}

fn part_name<C>(part: &Layer<C>) -> String {
    part.attributes.layer_name.as_ref().map(text).unwrap_or_default()
}

pub(super) fn text(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
