//! Image under construction, and optionally its parts by the origin of light.

use super::bands::{BANDS, BandedLight, Reflected, add_by_band};
use super::{ShadeSettings, ShadedPatch, ShadingContext, ShadingCounts, ShadingTask, patches, shade};
use crate::eye::EyePass;
use crate::lights::Origin;
use base::film::{Image, Layer, Preview};
use base::math::Rgb;
use base::progress::Control;
use base::stats::{Contributions, Stats};
use rayon::prelude::*;

/// Sums of radiance at each pixel.
pub struct ShadedImage {
    /// All light.
    pub color: Image,
    /// Direct light, indirect light, and light of both origins together.
    parts: Option<[Image; 3]>,
    /// Number of non-finite radiances, which were left out.
    pub nonfinite: u64,
    /// Luminance by technique.
    contributions: Contributions,
}

impl ShadedImage {
    /// Creates the image of the light found by the eye pass.
    pub fn new(eye: &EyePass, with_parts: bool) -> ShadedImage {
        let color = eye.known.clone();
        let blank = || Image::new(color.width, color.height);
        let parts = with_parts.then(|| [blank(), blank(), blank()]);
        ShadedImage { color, parts, nonfinite: eye.nonfinite, contributions: eye.contributions.clone() }
    }

    /// Adds the light of shading points, run by run, as if one thread added all light in order. `reflected` maps the
    /// items of runs.
    pub fn add<T: Sync>(
        &mut self,
        eye: &EyePass,
        runs: &[Vec<T>],
        reflected: impl Fn(&T) -> Reflected + Sync,
    ) {
        let band = self.color.pixels.len().div_ceil(BANDS).max(1);
        let banded = |run: &Vec<T>| BandedLight::new(eye, run.iter().map(&reflected), band);
        let runs: Vec<BandedLight> = runs.par_iter().map(banded).collect();
        self.nonfinite += runs.iter().map(|run| run.nonfinite).sum::<u64>();
        add_by_band(&mut self.color, band, &runs, |_| true);
        for (number, part) in self.parts.iter_mut().flatten().enumerate() {
            let origin = [Some(Origin::Direct), Some(Origin::Indirect), None][number];
            add_by_band(part, band, &runs, |light| light.origin == origin);
        }
    }

    /// Shades `tasks` in patches and adds their light. Watchers see the image, and then the light of each patch.
    pub fn shade<'w>(
        &mut self,
        context: &ShadingContext<'w>,
        eye: &EyePass<'w>,
        tasks: &[ShadingTask],
        settings: &ShadeSettings,
        control: &Control,
    ) -> ShadingCounts {
        let patches = patches(&eye.points, tasks, settings.patches, context.world.diagonal);
        let live = control.live([self.color.width, self.color.height]);
        if let Some(live) = &live {
            live.show(&self.color);
        }
        let show = |patch: &ShadedPatch| {
            if let Some(live) = &live {
                live.add(
                    patch.iter().flat_map(|(task, radiance)| seen_by(eye, task.point as usize, *radiance)),
                );
            }
        };
        let shading = shade(context, &eye.points, &patches, settings, control, show);
        self.add(eye, &shading.patches, |(task, radiance)| Reflected {
            point: task.point,
            origin: task.origin,
            radiance: *radiance,
        });
        shading.counts
    }

    /// Attributes the light added since the last call to a technique.
    pub fn came_by(&mut self, technique: &'static str) {
        self.contributions.rest(technique, self.color.luminance());
    }

    /// Returns the image, its parts, and the number of radiances that were left out; reports the luminance by
    /// technique.
    pub fn finish(self, stats: &mut Stats) -> (Image, Vec<Layer>, u64) {
        self.contributions.report(stats);
        let parts = ["direct", "indirect", "both"].into_iter().zip(self.parts.into_iter().flatten());
        let parts = parts.map(|(name, image)| Layer::color(name, image).shown(Preview::Exposed));
        (self.color, parts.collect(), self.nonfinite)
    }
}

/// Returns the light that a shading point sends to pixels, by their indices. Light that is not finite is left out.
fn seen_by(eye: &EyePass, point: usize, radiance: Rgb) -> impl Iterator<Item = (usize, Rgb)> {
    let light =
        eye.visibility.at_point(point).iter().map(move |seen| (seen.pixel as usize, seen.weight * radiance));
    light.filter(|(_, light)| light.is_finite())
}
