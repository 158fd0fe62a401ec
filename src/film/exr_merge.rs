//! Several pictures of one view, as weighted means of their channels.

use super::exr_read::text;
use super::{ExrFile, ImageError};
use ::exr::prelude::FlatSamples;

impl ExrFile {
    /// Puts the weighted mean of the pictures in the place of every channel of floats, and of the layers of `variances`
    /// the variance of that mean; ids stay. All pictures have the same channels and size.
    ///
    /// # Errors
    /// If they have not.
    pub fn merge(
        &mut self,
        others: &[ExrFile],
        weights: &[f64],
        variances: &[&str],
    ) -> Result<(), ImageError> {
        if let Some(other) = others.iter().find(|other| other.shape() != self.shape()) {
            let [a, b] = [&self.path, &other.path].map(|path| path.display());
            let reason = format!("its parts or channels are not those of {a}");
            return Err(ImageError::Decode { path: b.to_string().into(), reason });
        }
        let sum: f64 = weights.iter().sum();
        for (p, part) in self.parts.layer_data.iter_mut().enumerate() {
            for (c, channel) in part.channel_data.list.iter_mut().enumerate() {
                let name = text(&channel.name);
                let is_variance =
                    variances.iter().any(|layer| name.rsplit_once('.').is_some_and(|(l, _)| l == *layer));
                let of_others =
                    others.iter().map(|other| &other.parts.layer_data[p].channel_data.list[c].sample_data);
                if matches!(channel.sample_data, FlatSamples::U32(_)) {
                    continue;
                }
                let mut means = vec![0.0f64; channel.sample_data.len()];
                for (samples, weight) in std::iter::once(&channel.sample_data).chain(of_others).zip(weights) {
                    let part = weight / sum;
                    let factor = if is_variance { part * part } else { part };
                    means
                        .iter_mut()
                        .zip(samples.values_as_f32())
                        .for_each(|(m, x)| *m += factor * f64::from(x));
                }
                channel.sample_data = FlatSamples::F32(means.into_iter().map(|mean| mean as f32).collect());
            }
        }
        Ok(())
    }

    /// Sizes of the parts, and names of their channels.
    fn shape(&self) -> Vec<(usize, usize, Vec<String>)> {
        let parts = self.parts.layer_data.iter();
        let names = |part: &::exr::prelude::Layer<_>| -> Vec<String> {
            let channels: &::exr::prelude::AnyChannels<FlatSamples> = &part.channel_data;
            channels.list.iter().map(|channel| text(&channel.name)).collect()
        };
        parts.map(|part| (part.size.0, part.size.1, names(part))).collect()
    }
}
