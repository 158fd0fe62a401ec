//! Weighted means of several images of one view, channel by channel.

use super::exr_read::text;
use super::{CRYPTO, ExrFile, ImageError};
use ::exr::prelude::FlatSamples;

/// Weight of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Weight {
    /// One weight for all pixels.
    Uniform(f64),
    /// One weight per pixel.
    ByPixel(Vec<u32>),
}

impl Weight {
    /// Returns the weight of a pixel.
    pub fn at(&self, pixel: usize) -> f64 {
        match self {
            Weight::Uniform(weight) => *weight,
            Weight::ByPixel(weights) => weights.get(pixel).copied().unwrap_or_default().into(),
        }
    }
}

impl ExrFile {
    /// Replaces every float channel by the weighted mean of the images. Layers of `variances` become the variance of
    /// that mean.
    ///
    /// Pixels without weight are 0. Ids and layers of Cryptomatte stay unchanged.
    ///
    /// # Errors
    /// If channels or sizes differ.
    pub fn merge(
        &mut self,
        others: &[ExrFile],
        weights: &[Weight],
        variances: &[&str],
    ) -> Result<(), ImageError> {
        if let Some(other) = others.iter().find(|other| other.shape() != self.shape()) {
            let [a, b] = [&self.path, &other.path].map(|path| path.display());
            let reason = format!("its parts or channels differ from {a}");
            return Err(ImageError::Decode { path: b.to_string().into(), reason });
        }
        let sum = |pixel: usize| weights.iter().map(|weight| weight.at(pixel)).sum::<f64>();
        for (p, part) in self.parts.layer_data.iter_mut().enumerate() {
            for (c, channel) in part.channel_data.list.iter_mut().enumerate() {
                let name = text(&channel.name);
                let is_variance =
                    variances.iter().any(|layer| name.rsplit_once('.').is_some_and(|(l, _)| l == *layer));
                let of_others =
                    others.iter().map(|other| &other.parts.layer_data[p].channel_data.list[c].sample_data);
                if matches!(channel.sample_data, FlatSamples::U32(_)) || name.starts_with(CRYPTO) {
                    continue;
                }
                let mut means = vec![0.0f64; channel.sample_data.len()];
                for (samples, weight) in std::iter::once(&channel.sample_data).chain(of_others).zip(weights) {
                    for (i, (mean, x)) in means.iter_mut().zip(samples.values_as_f32()).enumerate() {
                        let part = weight.at(i) / sum(i).max(f64::MIN_POSITIVE);
                        *mean += if is_variance { part * part } else { part } * f64::from(x);
                    }
                }
                channel.sample_data = FlatSamples::F32(means.into_iter().map(|mean| mean as f32).collect());
            }
        }
        Ok(())
    }

    /// Returns the sizes of the parts and the names of their channels.
    fn shape(&self) -> Vec<(usize, usize, Vec<String>)> {
        let parts = self.parts.layer_data.iter();
        let names = |part: &::exr::prelude::Layer<_>| -> Vec<String> {
            let channels: &::exr::prelude::AnyChannels<FlatSamples> = &part.channel_data;
            channels.list.iter().map(|channel| text(&channel.name)).collect()
        };
        parts.map(|part| (part.size.0, part.size.1, names(part))).collect()
    }
}
