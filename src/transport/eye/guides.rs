//! Denoiser guides found by eye samples and paths: mean albedo and normal per pixel.
//!
//! Guides follow the definitions of [`super::features`], over all eye samples of a pixel. Only samples that hit a
//! mirror or glass first are traced separately.
//!
//! Errors: values have 16 bits, hence 1e-5 of an albedo and 3e-5 of a normal.

use super::seen::{FIRST_SAMPLES, FeatureSampler, FeatureSettings, MoreSamples, PixelFeatures};
use super::tiles::by_tiles;
use crate::irradiance::PathEnds;
use crate::paths::{Estimand, PathPolicy};
use base::film::{Image, Layer, Window};
use base::math::Rgb;
use base::progress::Control;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;
use world::World;
use world::light::Learned;
use world::view::View;

/// Rule by which pixels at edges of surfaces get more eye rays than others. Textures count if their contrast is great:
/// texels are means over footprints.
const RULE: MoreSamples = MoreSamples {
    samples: 16,
    max_difference: 0.1,
    max_albedo_difference: 0.3,
    albedo_edge: f32::INFINITY,
    beside_others: false,
};

/// Changes the seed for the eye rays of a survey.
const SURVEY: u32 = 0x9e6c_63d1;

/// Maximum code of a packed value.
const MAX_CODE: f32 = u16::MAX as f32;

/// Sums over samples of albedo and of the shading normal towards the viewer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Guide {
    albedo: Rgb,
    normal: Vec3,
}

impl Guide {
    /// Adds the sums of other samples.
    pub fn add(&mut self, other: Guide) {
        self.albedo += other.albedo;
        self.normal += other.normal;
    }

    /// Returns the packed mean over a number of samples.
    pub fn kept(&self, samples: u32) -> PackedGuide {
        let n = samples.max(1) as f32;
        let code = |value: f32| (value.clamp(0.0, 1.0) * MAX_CODE).round() as u16;
        let (albedo, normal) = (self.albedo / n, 0.5 * self.normal / n + 0.5);
        PackedGuide { albedo: albedo.to_array().map(code), normal: normal.to_array().map(code) }
    }
}

/// Mean guide of a pixel in 12 bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackedGuide {
    /// Albedo; codes map to [0, 1].
    albedo: [u16; 3],
    /// Normal; codes map to [-1, 1].
    normal: [u16; 3],
}

/// Pixel of a denoised image, as eye rays of its own see it before its samples are taken.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurveyedPixel {
    /// Guide of the denoiser.
    pub guide: PackedGuide,
    /// True if the pixel and its neighbours see nearly equal surfaces.
    pub is_even: bool,
}

/// Surveys the pixels of the view's window, by eye rays that depend on `seed` and are those of no sample. Pixels are
/// empty once cancelled.
pub fn survey(world: &World, view: &View, seed: u32, control: &Control) -> Image<SurveyedPixel> {
    let settings = FeatureSettings { estimand: Estimand::Pixels, spp: FIRST_SAMPLES, seed: seed ^ SURVEY };
    let sampler = FeatureSampler { world, view, settings: &settings };
    let surveyed = |pixel: PixelFeatures| SurveyedPixel {
        guide: Guide { albedo: pixel.albedo, normal: pixel.normal }.kept(pixel.samples),
        is_even: pixel.is_even,
    };
    by_tiles(view, control, |first, last| {
        sampler.pixels(RULE, first, last).into_iter().map(surveyed).collect()
    })
}

/// Guides of a window.
#[derive(Clone, Debug)]
pub struct PackedGuides(pub Vec<PackedGuide>);

impl PackedGuides {
    /// Returns the guides of surveyed pixels.
    pub fn of_survey(survey: &Image<SurveyedPixel>) -> PackedGuides {
        PackedGuides(survey.pixels.iter().map(|pixel| pixel.guide).collect())
    }

    /// Returns layers of albedo and normals, named after these features.
    pub fn layers(&self, window: &Window) -> Vec<Layer> {
        let image = |value: &(dyn Fn(&PackedGuide) -> Vec3 + Sync)| Image {
            width: window.width,
            height: window.height,
            pixels: self.0.par_iter().map(value).collect(),
        };
        let share = |codes: [u16; 3]| Vec3::from(codes.map(|code| f32::from(code) / MAX_CODE));
        let albedo = image(&|guide| share(guide.albedo));
        // The middle of the range is no code; 0 is to stay 0.
        let normal = image(&|guide| match guide.normal.map(|code| code.abs_diff(u16::MAX / 2) <= 1) {
            [true, true, true] => Vec3::ZERO,
            _ => 2.0 * share(guide.normal) - 1.0,
        });
        vec![Layer::color("albedo", albedo), Layer::vector("normal", normal)]
    }
}

/// First surfaces of paths that are traced together.
#[derive(Default)]
pub struct FirstSurfaces {
    /// Number of the first path of each pixel.
    first: u32,
    /// Number of consecutive paths per pixel.
    paths: u32,
    pixels: Vec<Guide>,
    /// Paths that hit a mirror or glass first.
    chained: Vec<u32>,
    behind: Vec<PixelFeatures>,
}

impl FirstSurfaces {
    /// Clears the surfaces seen. The next paths are those of these numbers in each of so many pixels, in order.
    pub fn begin(&mut self, pixels: usize, numbers: Range<u32>) {
        (self.first, self.paths) = (numbers.start, numbers.len().max(1) as u32);
        self.pixels.clear();
        self.pixels.resize(pixels, Guide::default());
        self.chained.clear();
    }

    /// Adds the albedo of the surface that a path hits, `None` for mirrors and glass, and the shading normal on that
    /// side.
    #[inline]
    pub fn see(&mut self, path: u32, albedo: Option<Rgb>, normal: Vec3) {
        match albedo {
            Some(albedo) => self.pixels[(path / self.paths) as usize].add(Guide { albedo, normal }),
            None => self.chained.push(path),
        }
    }

    /// Traces the samples that hit mirrors or glass first.
    pub fn finish(
        &mut self,
        world: &World,
        view: &View,
        settings: FeatureSettings,
        film_pixels: &[[u32; 2]],
    ) {
        if self.chained.is_empty() {
            return;
        }
        self.behind.clear();
        self.behind.resize(film_pixels.len(), PixelFeatures::default());
        let (first, paths) = (self.first, self.paths);
        let samples = self.chained.iter().map(|path| ((path / paths) as usize, first + path % paths));
        FeatureSampler { world, view, settings: &settings }.add(film_pixels, &mut self.behind, samples);
        for (guide, pixel) in self.pixels.iter_mut().zip(&self.behind) {
            guide.add(Guide { albedo: pixel.albedo, normal: pixel.normal });
        }
    }

    /// Returns the sums of the surfaces seen in a pixel.
    pub fn at(&self, pixel: usize) -> Guide {
        self.pixels.get(pixel).copied().unwrap_or_default()
    }
}

/// Policy of full paths from the eye.
#[derive(Default)]
pub struct FullPaths<'a> {
    /// Learned light that guides light samples.
    pub learned: Option<&'a Learned>,
    /// Light by which paths end behind wide lobes; `None` if they go on.
    pub path_ends: Option<&'a PathEnds>,
}

impl PathPolicy<'_> for FullPaths<'_> {
    const STOPS_AT_DIFFUSE: bool = false;

    fn learned(&self) -> Option<&Learned> {
        self.learned
    }

    fn path_ends(&self) -> Option<&PathEnds> {
        self.path_ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eye::{DirectSampling, EyePass, EyeSettings, LightSources};
    use world::testkit::*;

    #[test]
    fn guides_are_the_features_of_all_eye_samples() {
        const SPP: u32 = 16;
        let world = room_with_ball(Some(mirror()));
        let view = world.view;
        for max_depth in [5, 1] {
            let settings = EyeSettings { spp: SPP, seed: 3, max_depth };
            let direct = DirectSampling { guides: true, ..DirectSampling::default() };
            let pass = EyePass::with_direct_light(
                &world,
                &view,
                settings,
                LightSources { direct: &direct, caustics: None, learned: None, path_ends: None },
                &Control::new(),
            );
            let Some(guides) = pass.guides else {
                assert_eq!(max_depth, 1, "paths end at emitters");
                continue;
            };
            let layers = guides.layers(&view.window);
            let pixels: Vec<[u32; 2]> = view.window.film_pixels().collect();
            let features = FeatureSettings { estimand: Estimand::Pixels, spp: SPP, seed: 3 };
            let mut sums = vec![PixelFeatures::default(); pixels.len()];
            let samples = (0..pixels.len()).flat_map(|pixel| (0..SPP).map(move |sample| (pixel, sample)));
            FeatureSampler { world: &world, view: &view, settings: &features }
                .add(&pixels, &mut sums, samples);
            let mut through_mirrors = 0;
            for (i, sum) in sums.iter().enumerate() {
                let found = |layer: &Layer| layer.triples().map_or(Vec3::NAN, |image| image.pixels[i]);
                let n = SPP as f32;
                let errors = [found(&layers[0]) - sum.albedo / n, found(&layers[1]) - sum.normal / n];
                assert!(errors.iter().all(|error| error.abs().max_element() < 1e-4), "{i}: {errors:?}");
                through_mirrors += u32::from(sum.reflects);
            }
            assert!(through_mirrors > 50, "{through_mirrors}");
        }
    }

    #[test]
    fn guides_are_kept_to_sixteen_bits() {
        let window = Window { film: [1, 1], offset: [0, 0], width: 1, height: 1 };
        for (albedo, normal) in [
            (Rgb::new(0.0, 0.3, 1.0), Vec3::new(-1.0, 0.0, 0.0)),
            (Rgb::new(0.7, 0.123, 1e-4), Vec3::new(0.48, -0.6, 0.64)),
            (Rgb::ZERO, Vec3::ZERO),
        ] {
            let guide = Guide { albedo: 3.0 * albedo, normal: 3.0 * normal };
            let layers = PackedGuides(vec![guide.kept(3)]).layers(&window);
            let found = |layer: &Layer| layer.triples().map(|image| image.pixels[0]);
            let near = |found: Option<Vec3>, value: Vec3| {
                found.is_some_and(|f| (f - value).abs().max_element() < 3e-5)
            };
            assert!(near(found(&layers[0]), albedo) && near(found(&layers[1]), normal), "{layers:?}");
        }
        let empty = PackedGuides(vec![Guide::default().kept(0)]).layers(&window);
        assert!(empty.iter().all(|layer| layer.triples().is_some_and(|image| image.pixels[0] == Vec3::ZERO)));
    }
}
