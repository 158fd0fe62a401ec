//! The picture: eye pass, light pass, trees, the cache, and the rest by cuts.

use super::direct_sampling::direct_sampling;
use super::resolve::resolve;
use crate::method::ladder::{CUTS, DRAWN};
use crate::method::lights::LightStore;
use crate::method::photon_store::FoundCaustics;
use crate::method::sampling::method_settings;
use crate::method::{Before, DrawnPixels, Move, Output, PILOT_SPP, Prepared, Renderer, Sampled, counts};
use base::film::Window;
use base::progress::Control;
use base::setting::{COMPENSATION, Each, INSPECT, Settings as _};
use base::stats::Stage;
use transport::eye::{DirectSampling, EyePass, EyePilot, EyeSettings, LightSources, Settled};
use transport::lightcut::{CutSettings, Samples};
use transport::lights::{Family, LightPassSettings};
use transport::paths::Estimand;
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::glossy::Glossy;
use transport::radiance_cache::source::LightcutSource;
use transport::radiance_cache::store::Records;
use transport::radiance_cache::targets::Targets;
use transport::radiance_cache::work::rays_beside_samples;
use transport::radiance_cache::{CLAMP, CacheSettings, DirectBy, MAX_CUT};
use transport::shade::{ShadeSettings, ShadedImage, ShadingContext};
use world::World;
use world::view::View;

/// Samples of a cut, at a point that is lit by it alone, times a cut's error ε and the relative error of a pixel's
/// drawn light: the product of variance and time is least if they are in inverse proportion to that. And their least
/// number.
///
/// Measured (16 samples a pixel, denoised): the cuts of a living room and of a nave take .55 of the time for .07 and
/// .3 dB; in calm light hardly any point has samples. With half as many, nave loses .4 dB more for a twelfth of the
/// time.
const SAMPLES: f32 = 0.6;
const LEAST_SAMPLES: f32 = 4.0;

method_settings! {
    /// Settings of the method.
    spp = 16, "Records" {
        /// Numbers of VPLs; their seed is not used.
        light: LightPassSettings = LightPassSettings { indirect: 600_000, ..LightPassSettings::default() } => [group];
        /// Accuracy of the cut of an eye sample.
        cut: CutSettings = CutSettings { clamp: CLAMP, max_cut: MAX_CUT, ..CutSettings::default() } => [by Settings::each_of_cut];
        /// Compensation by short rays for light lost to clamping.
        compensation: bool = true => [is COMPENSATION];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Number and accuracy of records.
        cache: CacheSettings = CacheSettings::default() => [group];
        /// Images of the records, beside the picture; see `radiance_cache::inspect`.
        inspect: bool = false => [is INSPECT];
    }
}

impl Settings {
    /// Visits the settings of cuts; the cap and the clamp are those of records too.
    fn each_of_cut(&mut self, each: Each) {
        self.cut.each(each);
        self.cache.cut.max_cut = self.cut.max_cut;
        self.cache.cut.clamp = self.cut.clamp;
    }

    /// Settings of the shading stage of a picture whose pixels have this relative variance.
    fn shading(&self, noise: f32) -> ShadeSettings {
        let samples = Samples { whole: SAMPLES / (self.cut.epsilon * noise.sqrt()), least: LEAST_SAMPLES };
        let samples = (noise > 0.0 && self.cache.share).then_some(samples);
        ShadeSettings { cut: self.cut, share: self.cache.share, samples, shadows: self.cache.shadows }
    }

    /// Rays of a still picture of the view's whole film, about, but for its samples.
    fn rays_beside_samples(&self, view: &View) -> f64 {
        rays_beside_samples(
            view.window.film_pixel_count() as f64,
            self.spp.into(),
            self.light.indirect.into(),
        )
    }

    /// The picture, by records of the frames before where they are `kept`.
    fn picture(
        &self,
        world: &World,
        lights: &LightStore,
        before: Option<Before>,
        view: &View,
        control: &Control,
    ) -> Output {
        let (mut kept, settled, thresholds) = match before {
            Some(Before { records, settled, thresholds }) => (Some(records), settled, thresholds),
            None => (None, Settled::default(), None),
        };
        let cache = match kept {
            Some(_) => self.cache.for_walk(),
            None => self.cache,
        };
        let is_still = kept.is_none();
        let wanted = ((self.light, self.family), is_still);
        let glossy = Glossy::new(world, &cache);
        let besides = is_still.then(|| self.rays_beside_samples(view));
        let drawn = direct_sampling(glossy.as_ref(), &cache, settled, besides);
        let drawn = drawn.map(|drawn| DirectSampling { guides: is_still, ..drawn });
        let Prepared { eye: samples, lights, mut stats } =
            Prepared::new(world, lights, view, (self.sampling(), drawn), wanted, control);
        let context = ShadingContext::new(world, &lights, self.compensation);
        let source = LightcutSource { context, settings: &cache };

        let mut own = Records::default();
        let records = match &mut kept {
            Some(kept) => kept.begin(view.camera.origin, &cache),
            None => &mut own,
        };
        let glossy = glossy.as_ref().and_then(|glossy| glossy.for_points(&samples.points, &cache));
        let mut targets = Targets::new(&samples.points, &samples.index, glossy);
        if cache.samples_direct_light() {
            targets = targets.with_baseline(|point| samples.known_luminance(point));
        }
        if let Some(thresholds) = thresholds {
            targets = targets.with_visible(|position| thresholds.at(position));
        }
        let frame = CacheFrame::fill(targets, records, &source, control, &mut stats);
        counts::cuts(&mut stats, "Records", &frame.cuts);

        let mut picture = ShadedImage::new(&samples, self.inspect);
        let tasks = stats.time(Stage::Splat, || {
            resolve(frame.interpolate(records), &samples, cache.samples_direct_light(), &mut picture)
        });
        picture.came_by("records");
        control.begin(Stage::Render, tasks.len() as u64);
        // Noise that the frame before did not have would flicker.
        let shading = self.shading(if is_still { samples.noise } else { 0.0 });
        let counts = stats.time(Stage::Render, || {
            picture.shade(&context, &samples, &tasks, cache.patches, &shading, control)
        });
        picture.came_by("cuts");
        stats.count("Shading/points", samples.points.len() as u64);
        stats.count("Shading/tasks by cuts", tasks.len() as u64);
        counts::cuts(&mut stats, "Lightcut", &counts.cuts);
        if cache.direct == DirectBy::Cuts && !cache.cached().indirect {
            counts::clamping(&mut stats, &counts.cuts, self.compensation.then_some(&counts.compensation));
        }
        counts.shadows.report(&mut stats);
        let complete = samples.complete && !control.is_cancelled();
        let (color, mut extra, nonfinite) = picture.finish(&mut stats);
        if self.inspect {
            extra.extend(frame.inspect(records, &samples));
        }
        if let Some(kept) = kept {
            kept.end(&frame, view.camera.origin, &mut stats);
        }
        let guides = samples.guides.as_ref().map_or_else(Vec::new, |guides| guides.layers(&view.window));
        Output { extra, guides, complete, nonfinite, ..Output::new(color, stats) }
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "cache"
    }

    fn about(&self) -> &'static str {
        "The radiance cache: direct light drawn, indirect light at records, splatted onto the points around them"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        self.picture(world, lights, None, view, control)
    }

    fn render_next(
        &self,
        world: &World,
        lights: &LightStore,
        before: Before,
        view: &View,
        control: &Control,
    ) -> Output {
        self.picture(world, lights, Some(before), view, control)
    }

    fn finds_guides(&self) -> bool {
        self.cache.samples_direct_light() && self.spp > 1
    }

    fn keeps_records(&self) -> bool {
        true
    }

    fn check(&self) -> Result<(), String> {
        match self.cache.lights_by_cuts() {
            true => {
                Err("without records, direct and indirect light by cuts are --method reconstruction"
                    .to_owned())
            }
            false => Ok(()),
        }
    }

    fn draw_pixels(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> Option<DrawnPixels> {
        let glossy = Glossy::new(world, &self.cache);
        let drawn = direct_sampling(glossy.as_ref(), &self.cache, Settled::default(), None)?;
        let settings = EyeSettings { spp: PILOT_SPP, seed: 0, ..self.sampling().eye(&world.scene) };
        let FoundCaustics { caustics, rays, shadow_rays, .. } =
            lights.photons.few((world, view), settings, control);
        let sources = LightSources { direct: &drawn, caustics: caustics.as_ref() };
        let found = EyePass::pilot(world, view, settings, sources, groups, control);
        let EyePilot { luminances, photons, sampled, learned } = found;
        let luminances = luminances.map(|by_group| by_group.into_iter().flatten().map(f64::from).collect());
        let [sampled, learned] = [sampled, learned].map(|chains| chains.rays + chains.shadow_rays);
        let pixels = DrawnPixels::new(luminances, sampled, learned + rays + shadow_rays);
        (!control.is_cancelled()).then_some(DrawnPixels { photons, ..pixels })
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        let lights = self.light.expected_bytes();
        EyePass::expected_bytes(window, self.cache.points_per_pixel(self.spp)).saturating_add(lights)
    }

    fn estimand(&self) -> Estimand {
        self.cache.estimand(self.spp, self.seed)
    }

    fn leaves_noise(&self) -> bool {
        self.cache.samples_direct_light()
    }

    fn ladder(&self) -> &'static [Move] {
        if self.cache.samples_direct_light() { &DRAWN } else { &CUTS }
    }
}
