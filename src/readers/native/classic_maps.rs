//! Maps of the classic materials of MTL files, and numbers that may have one.

use super::classic::{LibraryReader, SLACK, is_principled};
use super::mtl::{existing_file, missing_file};
use crate::decode::{Channel, DecodedImage};
use crate::error::{Location, SceneError, Warning};
use crate::file::{fnv1a, folder_of, read_file};
use crate::mend::decode_mended;
use crate::mesh::map_options::{MapChannel, MapOptions, parse};
use crate::mesh::mtl::ClassicMaterial;
use crate::plan::{ImageSource, TexturePlan, TextureSource};
use base::math::{Rgb, luminance};
use glam::{Mat3, Vec2};
use scene::{Filter, Reflectance, Relief, Share, Texels, TextureId, Wrap};
use std::path::{Path, PathBuf};

/// Excess of the mean blue over red and green from which an image holds normals, not heights.
const MIN_BLUE: f32 = 0.1;

/// Map with its file.
struct OpenMap {
    file: PathBuf,
    place: Location,
    options: MapOptions,
}

impl LibraryReader<'_, '_> {
    /// Adds a feature that is not supported, at the line of the map `keyword` or of the material.
    pub fn lacks(&self, source: &mut ClassicMaterial, keyword: &str, what: String, fallback: &str) {
        let line = source.maps.get(keyword).map(|map| map.line).or(source.place.line);
        source.lacks(what, fallback, line.unwrap_or_default());
    }

    /// Returns a colour times its map. Many exporters write black beside a map, which counts as white.
    pub fn colour(
        &mut self,
        source: &mut ClassicMaterial,
        keyword: &'static str,
        factor: Rgb,
    ) -> Result<Reflectance, SceneError> {
        let Some(map) = self.open(source, keyword)? else { return Ok(Reflectance::Constant(factor)) };
        if map.options.channel.is_some() {
            let what = format!("the option -imfchan of {keyword}");
            self.lacks(source, keyword, what, "all channels count");
        }
        let texture = self.texture(source, keyword, map, Channel::Colour)?;
        let scale = match factor {
            Rgb::ZERO => Rgb::ONE,
            factor => factor,
        };
        Ok(Reflectance::Textured { texture, scale })
    }

    /// Returns the number of the extension `keyword`, times the map `map_keyword`. A 0 beside a map counts as 1.
    pub fn share(
        &mut self,
        source: &mut ClassicMaterial,
        map_keyword: &'static str,
        keyword: &'static str,
        default: f32,
    ) -> Result<Share, SceneError> {
        let Some(map) = self.open(source, map_keyword)? else {
            return Ok(Share::Constant(self.clamped(source, keyword, default)));
        };
        let scale = match self.clamped(source, keyword, 1.0) {
            0.0 => 1.0,
            scale => scale,
        };
        let channel = self.channel(source, map_keyword, map.options.channel, Channel::Data);
        Ok(Share::Textured { texture: self.texture(source, map_keyword, map, channel)?, scale })
    }

    /// Returns a number of the extension, limited to 0 to 1.
    pub fn clamped(&mut self, source: &mut ClassicMaterial, keyword: &'static str, default: f32) -> f32 {
        let value = source.principled.get(keyword).copied().unwrap_or(default);
        self.limited(source, keyword, value)
    }

    fn limited(&mut self, source: &mut ClassicMaterial, keyword: &str, value: f32) -> f32 {
        if !(-SLACK..=1.0 + SLACK).contains(&value) {
            let what = format!("{keyword} of {value}");
            self.lacks(source, "", what, "it is limited to 0 to 1");
        }
        value.clamp(0.0, 1.0)
    }

    /// Returns the share of the surface that is there; `None` if it is all there.
    pub fn opacity(&mut self, source: &mut ClassicMaterial) -> Result<Option<Share>, SceneError> {
        let mut scale = self.limited(source, "d", source.opacity());
        if let Some(filter) = source.filter.filter(|filter| *filter != Rgb::ZERO && *filter != Rgb::ONE) {
            if source.model == 4 && source.ior == Some(1.0) {
                // Maya writes its opacity so.
                scale *= luminance(filter).clamp(0.0, 1.0);
            } else if !is_principled(source) {
                let what = format!("Tf of a surface that is not glass (illum {})", source.model);
                self.lacks(source, "", what, "light passes only by d; write illum 7 and Ni for glass");
            }
        }
        let Some(map) = self.open(source, "map_d")? else {
            return Ok((scale < 1.0).then_some(Share::Constant(scale)));
        };
        let channel = self.channel(source, "map_d", map.options.channel, Channel::AlphaOrData);
        let texture = self.texture(source, "map_d", map, channel)?;
        Ok(Some(Share::Textured { texture, scale }))
    }

    /// Returns the relief of `norm`, or of `bump`.
    pub fn relief(&mut self, source: &mut ClassicMaterial) -> Result<Option<Relief>, SceneError> {
        let bump = self.open(source, "bump")?;
        if let Some(map) = self.open(source, "norm")? {
            if bump.is_some() {
                self.lacks(source, "bump", "bump beside norm".to_owned(), "norm alone counts");
            }
            let strength = map.options.bump;
            let texture = self.texture(source, "norm", map, Channel::Data)?;
            return Ok(Some(Relief::Normals { texture, strength, y_along_v: true }));
        }
        let Some(map) = bump else { return Ok(None) };
        let factor = map.options.bump;
        let holds_normals = decoded(&map, Channel::Data).is_some_and(|map| holds_normals(&map.image));
        let channel = match holds_normals {
            true => Channel::Data,
            false => self.channel(source, "bump", map.options.channel, Channel::Data),
        };
        let texture = self.texture(source, "bump", map, channel)?;
        Ok(Some(match holds_normals {
            true => Relief::Normals { texture, strength: factor, y_along_v: true },
            false => Relief::Heights { texture, scale: factor * self.unit },
        }))
    }

    /// Returns the map of a keyword, and names its options that are not supported.
    fn open(
        &mut self,
        source: &mut ClassicMaterial,
        keyword: &'static str,
    ) -> Result<Option<OpenMap>, SceneError> {
        let Some(text) = source.maps.get(keyword) else { return Ok(None) };
        let place = Location::line(self.file, text.line);
        let folder = folder_of(self.file);
        let map = parse(&text.text, |name| existing_file(folder, name));
        let Some((file, mut options)) = map.map_err(|what| SceneError::mesh(place.clone(), what))? else {
            return Ok(None);
        };
        for (what, fallback) in std::mem::take(&mut options.unmodelled) {
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
        Ok(Some(OpenMap { file, place, options }))
    }

    /// Returns the channels of a number.
    fn channel(
        &self,
        source: &mut ClassicMaterial,
        keyword: &'static str,
        asked: Option<MapChannel>,
        default: Channel,
    ) -> Channel {
        match asked {
            None => default,
            Some(MapChannel::Red) => Channel::One(0),
            Some(MapChannel::Green) => Channel::One(1),
            Some(MapChannel::Blue) => Channel::One(2),
            Some(MapChannel::Matte) => Channel::One(3),
            Some(MapChannel::Luminance) => Channel::Data,
            Some(MapChannel::Depth) => {
                let what = format!("the option -imfchan z of {keyword}");
                self.lacks(source, keyword, what, "the luminance counts");
                Channel::Data
            }
        }
    }

    fn texture(
        &mut self,
        source: &mut ClassicMaterial,
        keyword: &'static str,
        map: OpenMap,
        channel: Channel,
    ) -> Result<TextureId, SceneError> {
        let levelled = levelled(&map, channel, &mut self.builder.sources);
        if let Some(Warning { what, fallback, .. }) = levelled.as_ref().and_then(|map| map.remark.clone()) {
            self.lacks(source, keyword, what, &fallback);
        }
        let image = match levelled {
            Some(DecodedMap { image, .. }) => {
                TextureSource::Ready(format!("{keyword} of {}", source.name), image)
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
        let to_uv = Mat3::from_translation(Vec2::from(offset)) * Mat3::from_scale(Vec2::from(scale));
        let filter = if blend == [false, false] { Filter::Nearest } else { Filter::Bilinear };
        let wrap = if clamp { Wrap::Clamp } else { Wrap::Repeat };
        let plan = TexturePlan { place: map.place, image, filter, wrap, to_uv };
        Ok(self.builder.contents.add_texture(plan))
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

/// Returns the decoded image of a map; `None` if it cannot be read.
fn decoded(map: &OpenMap, channel: Channel) -> Option<DecodedMap> {
    let bytes = read_file(&map.file, &map.place).ok()?;
    let (image, remark) = decode_mended(&bytes, channel, &map.file, &map.place, false).ok()?;
    Some(DecodedMap { image, hash: fnv1a(&bytes), remark })
}

/// Returns the image whose texels have the gain and base of `-mm`; `None` without the option, or if the image cannot be
/// read.
fn levelled(map: &OpenMap, channel: Channel, sources: &mut Vec<(PathBuf, u64)>) -> Option<DecodedMap> {
    let [base, gain] = map.options.levels;
    if (base, gain) == (0.0, 1.0) {
        return None;
    }
    let decoded = decoded(map, channel)?;
    if !sources.iter().any(|source| source.0 == map.file) {
        sources.push((map.file.clone(), decoded.hash));
    }
    let image = &decoded.image;
    let texels: Vec<Rgb> =
        image.texels.iter().map(|texel| (texel * gain + base).clamp(Rgb::ZERO, Rgb::MAX)).collect();
    let image = DecodedImage { texels: Texels::new(image.width, &texels), ..*image };
    Some(DecodedMap { image, ..decoded })
}

/// True if an image is bluish, as normals are and heights are not.
fn holds_normals(image: &DecodedImage) -> bool {
    let sum = image.texels.iter().fold(glam::DVec3::ZERO, |sum, texel| sum + texel.as_dvec3());
    let mean = sum / image.texels.len() as f64;
    mean.z - 0.5 * (mean.x + mean.y) > f64::from(MIN_BLUE)
}
