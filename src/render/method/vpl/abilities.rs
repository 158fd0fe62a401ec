//! Abilities of the method, which depend on its settings.

use super::film::FrameInputs;
use super::settings::{IndirectSource, Neighbours};
use super::{Preset, Settings};
use crate::method::Output;
use crate::method::lights::LightStore;
use crate::method::photon_store::FoundCaustics;
use crate::method::renderer::{FormerFrames, PILOT_SPP, Renderer, SampledPixels, Walks};
use crate::method::sampling::HasSampling;
use crate::method::scale::{CUTS, Demand, Move, SAMPLED};
use crate::method::tally::Tally;
use base::film::{Image, Window};
use base::progress::Control;
use transport::eye::{EyePass, EyePilot, EyeSettings, LightSources, Settled};
use transport::paths::Estimand;
use transport::radiance_cache::glossy::Glossy;
use transport::shade::ShadingCounts;
use world::World;
use world::view::View;

impl Settings {
    /// True if images have records of virtual lights, which further frames use.
    fn shares_records(&self) -> bool {
        !self.gathers() && !self.cache.lights_by_cuts()
    }

    /// Reports the counts of cuts of eye samples.
    pub(super) fn report(&self, counts: &ShadingCounts, tally: &mut Tally) {
        tally.cuts("Lightcut", &counts.cuts);
        if self.cache.lights_by_cuts() {
            tally.clamping(&counts.cuts, self.compensation.then_some(&counts.compensation));
        }
        counts.shadows.report(&mut tally.stats);
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        self.preset.name()
    }

    fn about(&self) -> &'static str {
        self.preset.about()
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        match self.neighbours {
            Neighbours::Patches => self.film(world, lights, FrameInputs::still(self, view), view, control),
            Neighbours::Blocks => self.by_blocks(world, lights, view, control),
        }
    }

    fn check(&self) -> Result<(), String> {
        match self.preset == Preset::Cache && self.cache.lights_by_cuts() {
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
        let samples = match self.neighbours {
            Neighbours::Patches => EyePass::expected_bytes(window, self.cache.points_per_pixel(self.spp)),
            Neighbours::Blocks => Image::expected_bytes(window),
        };
        let photons = if self.gathers() { self.gathering.expected_bytes() } else { 0 };
        samples.saturating_add(self.light.expected_bytes() + photons)
    }

    fn inspects(&self) -> bool {
        self.inspect
    }

    fn as_walks(&self) -> Option<&dyn Walks> {
        self.shares_records().then_some(self as &dyn Walks)
    }

    fn leaves_noise(&self) -> bool {
        self.cache.samples_direct_light()
    }

    fn finds_guides(&self) -> bool {
        self.leaves_noise() && self.spp > 1 && !self.gathers()
    }

    fn sample_pixels(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> Option<SampledPixels> {
        if !self.shares_records() {
            return None;
        }
        let glossy = Glossy::new(world, &self.cache);
        let direct = Settings::direct_sampling(glossy.as_ref(), &self.cache, Settled::default(), None)?;
        let settings = EyeSettings { spp: PILOT_SPP, seed: 0, ..self.sampling().eye(&world.scene) };
        let FoundCaustics { caustics, rays, shadow_rays, .. } =
            lights.photons.pilot(world, view, settings, control);
        let known = lights.learned(world, view, self.spp, control);
        let sources = LightSources {
            direct: &direct,
            caustics: caustics.as_ref(),
            learned: known.light.as_ref(),
            path_ends: None,
        };
        let pilot = EyePass::pilot(world, view, settings, sources, groups, control);
        let EyePilot { luminances, photons, sampled, before } = pilot;
        let luminances = luminances.map(|by_group| by_group.into_iter().flatten().map(f64::from).collect());
        let before = before.rays + before.shadow_rays + rays + shadow_rays;
        let pixels = SampledPixels::new(luminances, sampled.rays + sampled.shadow_rays, before);
        (!control.is_cancelled()).then_some(SampledPixels { photons, ..pixels })
    }

    fn moves(&self) -> &'static [Move] {
        match self.source {
            IndirectSource::PhotonMap => &[],
            IndirectSource::VirtualLights if self.cache.samples_direct_light() => &SAMPLED,
            IndirectSource::VirtualLights => &CUTS,
        }
    }

    fn demand(&self) -> Demand {
        Demand {
            direct_vpls: self.light.direct,
            vpls: self.light.indirect,
            extra_samples: if self.cache.lights_by_cuts() { 0.0 } else { self.cache.extra_samples },
            shares_patches: self.neighbours == Neighbours::Patches,
        }
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
        self.film(world, lights, FrameInputs::next(self, former, view), view, control)
    }
}
