//! The image: eye pass, light pass, trees, records, and cuts at the points that records do not reach.

use super::direct_sampling::direct_sampling;
use super::resolve::resolve;
use crate::cost::PRICES;
use crate::method::Output;
use crate::method::lights::LightStore;
use crate::method::photon_store::FoundCaustics;
use crate::method::prepared::{LitSurfaces, Preparation, Prepared};
use crate::method::renderer::{FormerFrames, Noisy, Pilots, Renderer, Walks};
use crate::method::sampled_pixels::{PILOT_SPP, SampledPixels};
use crate::method::sampling::{HasSampling, method_settings};
use crate::method::scale::{CUTS, Demand, Move, SAMPLED, ScaledSetting, Scales};
use crate::method::tally::Tally;
use base::film::Window;
use base::progress::Control;
use base::setting::{COMPENSATION, INSPECT, Value};
use base::stats::Stage;
use transport::eye::{DirectSampling, EyePass, EyePilot, EyeSettings, LightSources, Settled};
use transport::lightcut::{CutSettings, Samples};
use transport::lights::{Family, LightPassSettings};
use transport::paths::Estimand;
use transport::perception::Thresholds;
use transport::radiance_cache::fill::CacheFrame;
use transport::radiance_cache::glossy::Glossy;
use transport::radiance_cache::retained::RetainedRecords;
use transport::radiance_cache::source::LightcutSource;
use transport::radiance_cache::store::Records;
use transport::radiance_cache::targets::Targets;
use transport::radiance_cache::vantage::Vantage;
use transport::radiance_cache::{CLAMP, CacheSettings, DirectBy, MAX_CUT};
use transport::shade::{ShadeSettings, ShadedImage, ShadingContext, ShadingCounts};
use world::World;
use world::view::View;

/// Samples of a cut at a point without records, times the cut's ε and the pixel's relative error of direct light.
///
/// Variance times cost is least if the samples are in inverse proportion to that error.
const CUT_SAMPLES: f32 = 0.3;
/// Minimum number of samples of a cut.
const MIN_CUT_SAMPLES: f32 = 4.0;

method_settings! {
    /// Settings of the method.
    spp = 16, "Records" {
        /// Numbers of VPLs; their seed is not used.
        light: LightPassSettings = LightPassSettings { indirect: 600_000, ..LightPassSettings::default() } => [group];
        /// Accuracy of the cut of an eye sample; cap and clamp are those of records, too.
        cut: CutSettings = CutSettings { clamp: CLAMP, max_cut: MAX_CUT, ..CutSettings::default() } => [group];
        /// Compensation by short rays for light lost to clamping.
        compensation: bool = true => [is COMPENSATION];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Number and accuracy of records.
        cache: CacheSettings = CacheSettings::default() => [group];
        /// Images of the records, beside the image; see `radiance_cache::inspect`.
        inspect: bool = false => [is INSPECT];
    }
}

/// Inputs in which a still, a view of a list and a frame of a walk differ.
struct FrameInputs<'a> {
    /// Settings of records.
    cache: CacheSettings,
    /// Records of former frames; `None` for a still.
    kept: Option<&'a mut RetainedRecords>,
    /// Surfaces that virtual lights are made for.
    lit: LitSurfaces<'a>,
    /// True for a frame of a film, whose noise must not flicker and whose guides are computed before.
    is_film: bool,
    /// Pixels whose direct light is reprojected.
    settled: Settled,
    /// Visibility thresholds of the previous frame.
    thresholds: Option<&'a Thresholds>,
    /// Expected work besides the eye samples, in rays; unknown in a walk, which has records already.
    other_rays: Option<f64>,
}

impl Settings {
    /// Returns the settings of records, whose cuts have the cap and the clamp of other cuts.
    fn record_settings(&self) -> CacheSettings {
        let CutSettings { max_cut, clamp, .. } = self.cut;
        CacheSettings { cut: CutSettings { max_cut, clamp, ..self.cache.cut }, ..self.cache }
    }

    fn still<'a>(&self, view: &View) -> FrameInputs<'a> {
        let pixels = view.window.film_pixel_count() as f64;
        let other_rays = PRICES.rays_beside_samples(pixels, self.spp.into(), self.light.indirect.into());
        FrameInputs {
            cache: self.record_settings(),
            kept: None,
            lit: LitSurfaces::InView,
            is_film: false,
            settled: Settled::default(),
            thresholds: None,
            other_rays: Some(other_rays),
        }
    }

    fn next_frame<'a>(&self, former: FormerFrames<'a>, view: &View) -> FrameInputs<'a> {
        let FormerFrames { records, settled, thresholds, outlook } = former;
        if let Some(outlook) = outlook {
            let lit = LitSurfaces::Seen(&outlook.points);
            let cache = self.record_settings().for_views(outlook.overlap, self.cut.epsilon);
            return FrameInputs { cache, kept: Some(records), lit, ..self.still(view) };
        }
        let cache = self.record_settings().for_walk();
        let (kept, lit) = (Some(records), LitSurfaces::All);
        FrameInputs { cache, kept, lit, is_film: true, settled, thresholds, other_rays: None }
    }

    /// Returns the settings of the shading stage for an image whose pixels have this relative variance.
    fn shading(&self, noise: f32) -> ShadeSettings {
        let whole = CUT_SAMPLES / (self.cut.epsilon * noise.sqrt());
        let samples = Samples { whole, least: MIN_CUT_SAMPLES };
        let samples = (noise > 0.0 && self.cache.share).then_some(samples);
        ShadeSettings { cut: self.cut, share: self.cache.share, samples, shadows: self.cache.shadows }
    }

    fn image(
        &self,
        world: &World,
        lights: &LightStore,
        inputs: FrameInputs,
        view: &View,
        control: &Control,
    ) -> Output {
        let FrameInputs { cache, mut kept, lit, is_film, settled, thresholds, other_rays } = inputs;
        let vantage = if is_film { Vantage::in_film(view) } else { Vantage::of(view) };
        let glossy = Glossy::new(world, &cache);
        let direct = direct_sampling(glossy.as_ref(), &cache, settled, other_rays);
        let direct = direct.map(|direct| DirectSampling { guides: !is_film, ..direct });
        let (sampling, family) = (self.sampling(), self.family);
        let preparation = Preparation { sampling, direct, lights: self.light, family, lit };
        let Prepared { eye, lights, mut tally } = Prepared::new(world, lights, view, &preparation, control);
        let context = ShadingContext::new(world, &lights, self.compensation);

        let mut own = Records::default();
        let records = match &mut kept {
            Some(kept) => kept.begin(&vantage, &cache),
            None => &mut own,
        };
        let glossy = glossy.as_ref().and_then(|glossy| glossy.for_points(&eye.points, &cache));
        let mut targets = Targets::new(&eye.points, &eye.index, glossy);
        if cache.samples_direct_light() {
            targets = targets.with_baseline(|point| eye.known_luminance(point));
        }
        if let Some(thresholds) = thresholds {
            targets = targets.with_visible(|position| thresholds.at(position));
        }
        let source = LightcutSource { context, settings: &cache };
        let frame = CacheFrame::fill(targets, records, &source, control, &mut tally.stats);
        tally.cuts("Records", &frame.cuts);

        let mut image = ShadedImage::new(&eye, self.inspect);
        let tasks = tally
            .time(Stage::Splat, || resolve(&frame, records, &eye, cache.samples_direct_light(), &mut image));
        image.came_by("records");
        control.begin(Stage::Render, tasks.len() as u64);
        // Noise that the previous frame did not have would flicker.
        let shading = self.shading(if is_film { 0.0 } else { eye.noise });
        let counts = tally
            .time(Stage::Render, || image.shade(&context, &eye, &tasks, cache.patches, &shading, control));
        image.came_by("cuts");
        tally.count("Shading/points", eye.points.len() as u64);
        tally.count("Shading/tasks by cuts", tasks.len() as u64);
        self.report(&counts, &mut tally);
        let complete = eye.complete && !control.is_cancelled();
        let (color, mut extra, nonfinite) = image.finish(&mut tally.stats);
        if self.inspect {
            extra.extend(frame.inspect(records, &eye));
        }
        if let Some(kept) = kept {
            kept.end(&frame, &vantage, &mut tally.stats);
        }
        let guides = eye.guides.as_ref().map_or_else(Vec::new, |guides| guides.layers(&view.window));
        Output { extra, guides, complete, nonfinite, ..Output::new(color, tally) }
    }

    /// Reports the counts of the shading stage.
    fn report(&self, counts: &ShadingCounts, tally: &mut Tally) {
        tally.cuts("Lightcut", &counts.cuts);
        if self.cache.direct == DirectBy::Cuts && !self.cache.cached().indirect {
            tally.clamping(&counts.cuts, self.compensation.then_some(&counts.compensation));
        }
        counts.shadows.report(&mut tally.stats);
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "cache"
    }

    fn about(&self) -> &'static str {
        "Radiance cache: direct light is sampled, indirect light comes from records splatted onto nearby points"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        self.image(world, lights, self.still(view), view, control)
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

    fn estimand(&self) -> Estimand {
        self.cache.estimand(self.spp, self.seed)
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        let lights = self.light.expected_bytes();
        EyePass::expected_bytes(window, self.cache.points_per_pixel(self.spp)).saturating_add(lights)
    }

    fn as_walks(&self) -> Option<&dyn Walks> {
        Some(self)
    }

    fn as_noisy(&self) -> Option<&dyn Noisy> {
        Some(self)
    }

    fn as_pilots(&self) -> Option<&dyn Pilots> {
        Some(self)
    }

    fn as_scales(&self) -> Option<&dyn Scales> {
        Some(self)
    }

    fn as_scales_mut(&mut self) -> Option<&mut dyn Scales> {
        Some(self)
    }
}

impl Walks for Settings {
    fn render_next(
        &self,
        world: &World,
        lights: &LightStore,
        former: FormerFrames,
        view: &View,
        control: &Control,
    ) -> Output {
        self.image(world, lights, self.next_frame(former, view), view, control)
    }
}

impl Noisy for Settings {
    fn leaves_noise(&self) -> bool {
        self.cache.samples_direct_light()
    }

    fn finds_guides(&self) -> bool {
        self.cache.samples_direct_light() && self.spp > 1
    }
}

impl Pilots for Settings {
    fn sample_pixels(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> Option<SampledPixels> {
        let glossy = Glossy::new(world, &self.cache);
        let direct = direct_sampling(glossy.as_ref(), &self.cache, Settled::default(), None)?;
        let settings = EyeSettings { spp: PILOT_SPP, seed: 0, ..self.sampling().eye(&world.scene) };
        let FoundCaustics { caustics, rays, shadow_rays, .. } =
            lights.photons.pilot(world, view, settings, control);
        let sources = LightSources { direct: &direct, caustics: caustics.as_ref() };
        let found = EyePass::pilot(world, view, settings, sources, groups, control);
        let EyePilot { luminances, photons, sampled, learned } = found;
        let luminances = luminances.map(|by_group| by_group.into_iter().flatten().map(f64::from).collect());
        let [sampled, learned] = [sampled, learned].map(|chains| chains.rays + chains.shadow_rays);
        let pixels = SampledPixels::new(luminances, sampled, learned + rays + shadow_rays);
        (!control.is_cancelled()).then_some(SampledPixels { photons, ..pixels })
    }
}

impl Scales for Settings {
    fn moves(&self) -> &'static [Move] {
        if self.cache.samples_direct_light() { &SAMPLED } else { &CUTS }
    }

    fn scaled(&mut self, setting: ScaledSetting) -> Option<&mut dyn Value> {
        Some(match setting {
            ScaledSetting::Spp => &mut self.spp,
            ScaledSetting::Epsilon => &mut self.cut.epsilon,
            ScaledSetting::MaxCut => &mut self.cut.max_cut,
            ScaledSetting::Vpls => &mut self.light.indirect,
            ScaledSetting::Patches => &mut self.cache.patches,
            ScaledSetting::RecordEpsilon => &mut self.cache.cut.epsilon,
        })
    }

    fn demand(&self) -> Demand {
        Demand {
            direct_vpls: self.light.direct,
            vpls: self.light.indirect,
            extra_samples: self.cache.extra_samples,
            shares_patches: true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_of_records_have_the_cap_and_the_clamp_of_other_cuts_but_an_error_of_their_own() {
        let mut settings = Settings::default();
        (settings.cut.max_cut, settings.cut.clamp, settings.cut.epsilon) = (7, None, 0.5);
        let CutSettings { max_cut, clamp, epsilon, .. } = settings.record_settings().cut;
        assert_eq!((max_cut, clamp, epsilon), (7, None, settings.cache.cut.epsilon));
    }
}
