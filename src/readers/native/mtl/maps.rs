//! Maps of MTL materials, and numbers that may have one.

use super::LibraryReader;
use super::options::{MapOptions, parse};
use super::source::SourceMaterial;
use crate::decode::{Channel, DecodedImage};
use crate::error::{Location, SceneError, Warning};
use crate::file::{fnv1a, folder_of, read_file};
use crate::mend::decode_mended;
use crate::mesh::encodings::{existing_file, missing_file};
use crate::plan::{ImageSource, TexturePlan, TextureSource};
use base::math::Rgb;
use glam::Mat3;
use scene::{Filter, Reflectance, Relief, Share, Texels, TextureId, Wrap};
use std::path::{Path, PathBuf};

/// Slack of numbers from 0 to 1 that counts as rounding.
pub const SLACK: f32 = 1e-3;

/// Excess of the mean blue over red and green from which an image holds normals, not heights.
const MIN_BLUE: f32 = 0.1;

/// Map with its file.
struct OpenMap {
    keyword: &'static str,
    file: PathBuf,
    place: Location,
    options: MapOptions,
}

impl LibraryReader<'_, '_> {
    /// Returns a colour times its map. Many exporters write black beside a map, which counts as white.
    pub fn colour(
        &mut self,
        source: &SourceMaterial,
        map: &'static str,
        factor: Rgb,
    ) -> Result<Reflectance, SceneError> {
        let Some(map) = self.open(source, map)? else { return Ok(Reflectance::Constant(factor)) };
        if map.options.channel.is_some() {
            let what = format!("the option -imfchan of {}", map.keyword);
            self.lacks(source, map.keyword, what, "all channels count");
        }
        let texture = self.texture(source, map, Channel::Colour);
        let scale = if factor == Rgb::ZERO { Rgb::ONE } else { factor };
        Ok(Reflectance::Textured { texture, scale })
    }

    /// Returns the number of the extension `keyword`, times its map. A 0 beside a map counts as 1.
    pub fn share(
        &mut self,
        source: &SourceMaterial,
        map: &'static str,
        keyword: &str,
        default: f32,
    ) -> Result<Share, SceneError> {
        let Some(map) = self.open(source, map)? else {
            return Ok(Share::Constant(self.clamped(source, keyword, default)));
        };
        let factor = self.clamped(source, keyword, 1.0);
        let scale = if factor == 0.0 { 1.0 } else { factor };
        Ok(Share::Textured { texture: self.texture(source, map, Channel::Data), scale })
    }

    /// Returns a number of the extension, limited to 0 to 1.
    pub fn clamped(&mut self, source: &SourceMaterial, keyword: &str, default: f32) -> f32 {
        self.limited(source, keyword, source.number(keyword).unwrap_or(default))
    }

    /// Returns the value of a keyword, limited to 0 to 1.
    pub fn limited(&mut self, source: &SourceMaterial, keyword: &str, value: f32) -> f32 {
        if !(-SLACK..=1.0 + SLACK).contains(&value) {
            self.lacks(source, keyword, format!("{keyword} of {value}"), "it is limited to 0 to 1");
        }
        value.clamp(0.0, 1.0)
    }

    /// Returns an opacity times its map; `None` if all of the surface is there.
    pub fn mask(&mut self, source: &SourceMaterial, scale: f32) -> Result<Option<Share>, SceneError> {
        let Some(map) = self.open(source, "map_d")? else {
            return Ok((scale < 1.0).then_some(Share::Constant(scale)));
        };
        let texture = self.texture(source, map, Channel::AlphaOrData);
        Ok(Some(Share::Textured { texture, scale }))
    }

    /// Returns the relief of `norm`, or of `bump`.
    pub fn relief(&mut self, source: &SourceMaterial) -> Result<Option<Relief>, SceneError> {
        let (bump, normals) = (self.open(source, "bump")?, self.open(source, "norm")?);
        if normals.is_some() && bump.is_some() {
            self.lacks(source, "bump", "bump beside norm", "norm alone counts");
        }
        let holds_normals = |map: &OpenMap| map.decoded(Channel::Data).is_some_and(|map| map.holds_normals());
        let (map, are_normals) = match (normals, bump) {
            (Some(map), _) => (map, true),
            (None, Some(map)) => {
                let are_normals = holds_normals(&map);
                (map, are_normals)
            }
            (None, None) => return Ok(None),
        };
        let factor = map.options.bump;
        Ok(Some(if are_normals {
            let options = MapOptions { channel: None, ..map.options };
            let texture = self.texture(source, OpenMap { options, ..map }, Channel::Data);
            Relief::Normals { texture, strength: factor, y_along_v: true }
        } else {
            let texture = self.texture(source, map, Channel::Data);
            Relief::Heights { texture, scale: factor * self.unit }
        }))
    }

    /// Returns the map of a keyword, and names its options that are not supported.
    fn open(
        &mut self,
        source: &SourceMaterial,
        keyword: &'static str,
    ) -> Result<Option<OpenMap>, SceneError> {
        let Some(text) = source.map(keyword) else { return Ok(None) };
        let place = Location::line(self.file, source.line(keyword));
        let folder = folder_of(self.file);
        let map = parse(text, |name| existing_file(folder, name));
        let Some((file, options)) = map.map_err(|what| SceneError::mesh(place.clone(), what))? else {
            return Ok(None);
        };
        for (what, fallback) in &options.unsupported {
            self.lacks(source, keyword, format!("{what} of {keyword}"), fallback);
        }
        let [u, v] = options.blend;
        if u != v {
            let what = format!("the option -blendu or -blendv of {keyword} alone");
            self.lacks(source, keyword, what, "texels are interpolated both ways");
        }
        if options.bump != 1.0 && !matches!(keyword, "bump" | "norm") {
            self.lacks(source, keyword, format!("the option -bm of {keyword}"), "it is left out");
        }
        // A file that is not there is named when it is to be read.
        let file = file.unwrap_or_else(|name| missing_file(folder, &name));
        Ok(Some(OpenMap { keyword, file, place, options }))
    }

    /// Adds the texture of a map. Of numbers, the channel that the map asks for counts.
    fn texture(&mut self, source: &SourceMaterial, map: OpenMap, channel: Channel) -> TextureId {
        let channel = map.options.channel.filter(|_| channel != Channel::Colour).unwrap_or(channel);
        let image = match map.levelled(channel) {
            Some(DecodedMap { image, hash, remark }) => {
                if let Some(Warning { what, fallback, .. }) = remark {
                    self.lacks(source, map.keyword, what, &fallback);
                }
                self.builder.add_source(&map.file, hash);
                TextureSource::Ready(format!("{} of {}", map.keyword, source.name), image)
            }
            None => match channel {
                Channel::Colour => TextureSource::File { path: map.file, raw: false },
                Channel::Data => TextureSource::File { path: map.file, raw: true },
                channel => TextureSource::Part {
                    name: name_of(&map.file),
                    source: ImageSource::File(map.file),
                    channel,
                },
            },
        };
        let MapOptions { offset, scale, clamp, blend, .. } = map.options;
        let to_uv = Mat3::from_translation(offset) * Mat3::from_scale(scale);
        let filter = if blend == [false, false] { Filter::Nearest } else { Filter::Bilinear };
        let wrap = if clamp { Wrap::Clamp } else { Wrap::Repeat };
        self.builder.contents.add_texture(TexturePlan { place: map.place, image, filter, wrap, to_uv })
    }
}

fn name_of(file: &Path) -> String {
    file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Image of a map, the hash of its file, and a warning about its texels.
struct DecodedMap {
    image: DecodedImage,
    hash: u64,
    remark: Option<Warning>,
}

impl OpenMap {
    /// Returns the decoded image; `None` if it cannot be read.
    fn decoded(&self, channel: Channel) -> Option<DecodedMap> {
        let bytes = read_file(&self.file, &self.place).ok()?;
        let (image, remark) = decode_mended(&bytes, channel, &self.file, &self.place, false).ok()?;
        Some(DecodedMap { image, hash: fnv1a(&bytes), remark })
    }

    /// Returns the image with the gain and base of `-mm`; `None` without the option, or if it cannot be read.
    fn levelled(&self, channel: Channel) -> Option<DecodedMap> {
        let [base, gain] = self.options.levels;
        if (base, gain) == (0.0, 1.0) {
            return None;
        }
        let mut map = self.decoded(channel)?;
        let level = |texel: Rgb| (texel * gain + base).clamp(Rgb::ZERO, Rgb::MAX);
        let texels: Vec<Rgb> = map.image.texels.iter().map(level).collect();
        map.image.texels = Texels::new(map.image.width, &texels);
        Some(map)
    }
}

impl DecodedMap {
    /// True if the image is bluish, as normals are and heights are not.
    fn holds_normals(&self) -> bool {
        let texels = &self.image.texels;
        let sum = texels.iter().fold(glam::DVec3::ZERO, |sum, texel| sum + texel.as_dvec3());
        let mean = sum / texels.len() as f64;
        mean.z - 0.5 * (mean.x + mean.y) > f64::from(MIN_BLUE)
    }
}
