//! Edits of an OpenEXR file in memory. They leave everything else unchanged: parts, channels of any type, attributes.

use super::exr_read::text;
use super::exr_write::{name_of, set, write};
use super::{ExrFile, Fact, Image, ImageError, mended_value};
use crate::exr_file::ColourModel;
use crate::math::luminance;
use ::exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Text, WritableImage};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

impl ExrFile {
    /// Replaces [`ExrFile::color`] by an image of the same size. The old colour becomes the layer `kept`, if named.
    ///
    /// Luminance and chroma become red, green and blue.
    ///
    /// # Errors
    /// If the file has no colour, or the sizes differ.
    pub fn replace_color(&mut self, image: &Image, kept: Option<&str>) -> Result<(), ImageError> {
        let size = self.color()?.size();
        if image.size() != size {
            let what = format!("the colour of {} and its replacement differ in size", self.path.display());
            return Err(ImageError::Size { what, sizes: [image.size().0, size.0] });
        }
        let place = self.color_place()?;
        let channels = &mut self.parts.layer_data[place.part].channel_data;
        let mut list = std::mem::take(&mut channels.list);
        let is_grey = place.model == ColourModel::Luma;
        for (k, index) in place.channels.into_iter().enumerate().take(if is_grey { 1 } else { 3 }) {
            let samples = image.pixels.iter().map(|p| if is_grey { luminance(*p) } else { p[k] }).collect();
            let own = text(&list[index].name);
            let (layer, component) = own.rsplit_once('.').unwrap_or(("", &own));
            let name = match place.model {
                ColourModel::LumaChroma => name_in(layer, ["R", "G", "B"][k]),
                ColourModel::Rgb | ColourModel::Luma => list[index].name.clone(),
            };
            let new = AnyChannel::new(name, FlatSamples::F32(samples));
            let mut old = std::mem::replace(&mut list[index], new);
            if let Some(layer) = kept {
                old.name = name_in(layer, component);
                list.push(old);
            }
        }
        *channels = AnyChannels::sort(list);
        Ok(())
    }

    /// Mends the float numbers of all layers as [`Image::mend_nonfinite`]. Returns for each layer with such numbers its
    /// name, the number of its pixels, and column and row of the first.
    pub fn mend_nonfinite(&mut self) -> Vec<(String, usize, [u32; 2])> {
        let mut mended = Vec::new();
        for part in &mut self.parts.layer_data {
            let width = part.size.0.max(1);
            let mut layers: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
            for channel in &mut part.channel_data.list {
                let samples: Vec<f32> = channel.sample_data.values_as_f32().collect();
                if matches!(channel.sample_data, FlatSamples::U32(_)) || samples.iter().all(|x| x.is_finite())
                {
                    continue;
                }
                let name = text(&channel.name);
                let layer = name.rsplit_once('.').map_or("", |(layer, _)| layer);
                let bad = (0..).zip(&samples).filter(|(_, x)| !x.is_finite()).map(|(at, _)| at);
                layers.entry(layer.to_owned()).or_default().extend(bad);
                channel.sample_data = FlatSamples::F32(samples.into_iter().map(mended_value).collect());
            }
            for (layer, pixels) in layers {
                let first = pixels.first().copied().unwrap_or_default();
                mended.push((layer, pixels.len(), [(first % width) as u32, (first / width) as u32]));
            }
        }
        mended
    }

    /// Renames the layer `from` to `to`, if it exists.
    pub fn rename_layer(&mut self, from: &str, to: &str) {
        for part in &mut self.parts.layer_data {
            let mut list = std::mem::take(&mut part.channel_data.list);
            for channel in &mut list {
                if let Some((layer, own)) = text(&channel.name).rsplit_once('.')
                    && layer == from
                {
                    channel.name = name_in(to, own);
                }
            }
            part.channel_data = AnyChannels::sort(list);
        }
    }

    /// Sets a fact of [`ExrFile::metadata`].
    pub fn set(&mut self, key: &str, value: impl Into<Fact>) {
        if let Some(part) = self.parts.layer_data.first_mut() {
            set(&mut part.attributes, key, &value.into());
        }
    }

    /// Removes a fact, if it exists.
    pub fn remove_fact(&mut self, key: &str) {
        if let Some(part) = self.parts.layer_data.first_mut() {
            part.attributes.other.remove(&name_of(key));
        }
    }

    /// Removes the layer `name`, if it exists.
    pub fn remove_layer(&mut self, name: &str) {
        for part in &mut self.parts.layer_data {
            part.channel_data.list.retain(|channel| {
                let channel = text(&channel.name);
                channel.rsplit_once('.').map_or(channel.as_str(), |(layer, _)| layer) != name
            });
        }
    }

    /// Adds a channel of unsigned integers of the size of the first part.
    pub fn add_numbers(&mut self, name: &str, numbers: Vec<u32>) {
        if let Some(part) = self.parts.layer_data.first_mut() {
            let mut list = std::mem::take(&mut part.channel_data.list);
            let name = Text::from_slice_unchecked(name.as_bytes());
            list.push(AnyChannel::new(name, FlatSamples::U32(numbers)));
            part.channel_data = AnyChannels::sort(list);
        }
    }

    /// Renames the key of a fact, if it exists.
    pub fn rename_fact(&mut self, from: &str, to: &str) {
        let Some(part) = self.parts.layer_data.first_mut() else { return };
        if let Some(value) = part.attributes.other.remove(&name_of(from)) {
            part.attributes.other.insert(name_of(to), value);
        }
    }

    /// Writes the file to `path`, completely or not at all.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, path: &Path) -> Result<(), ImageError> {
        write(path, |bytes| self.parts.write().to_buffered(bytes))
    }
}

/// Returns the name of a layer's channel. The image itself has the name "".
fn name_in(layer: &str, channel: &str) -> Text {
    let dot = if layer.is_empty() { "" } else { "." };
    Text::from_slice_unchecked(format!("{layer}{dot}{channel}").as_bytes())
}
