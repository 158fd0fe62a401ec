//! Image under construction, and optionally its parts by the origin of light.

use super::{ShadeSettings, ShadedPatch, ShadingContext, ShadingCounts, ShadingTask, patches, shade};
use crate::eye::EyePass;
use crate::lights::Origin;
use base::film::{Image, Layer, Preview};
use base::math::Rgb;
use base::progress::Control;
use base::stats::{Contributions, Stats};

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

    /// Adds radiance that a shading point reflects, of one origin or of both.
    pub fn add(&mut self, eye: &EyePass, point: usize, origin: Option<Origin>, radiance: Rgb) {
        for seen in eye.visibility.of(point) {
            let light = seen.weight * radiance;
            if !light.is_finite() {
                self.nonfinite += 1;
                continue;
            }
            self.color.pixels[seen.pixel as usize] += light;
            if let Some(parts) = &mut self.parts {
                let part = match origin {
                    Some(Origin::Direct) => 0,
                    Some(Origin::Indirect) => 1,
                    None => 2,
                };
                parts[part].pixels[seen.pixel as usize] += light;
            }
        }
    }

    /// Shades `tasks` in patches and adds their light. There are about `count` patches if there is a task for each
    /// point. Watchers see the image, and then the light of each patch.
    pub fn shade<'w>(
        &mut self,
        context: &ShadingContext<'w>,
        eye: &EyePass<'w>,
        tasks: &[ShadingTask],
        count: u32,
        settings: &ShadeSettings,
        control: &Control,
    ) -> ShadingCounts {
        let patches = patches(&eye.points, tasks, count, context.world.diagonal);
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
        for &(task, radiance) in shading.patches.iter().flatten() {
            self.add(eye, task.point as usize, task.origin, radiance);
        }
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
        eye.visibility.of(point).iter().map(move |seen| (seen.pixel as usize, seen.weight * radiance));
    light.filter(|(_, light)| light.is_finite())
}
