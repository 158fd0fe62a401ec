//! Reconstruction cuts: sixteen eye samples of a patch share a cut, from which the light of the others is
//! reconstructed.
//!
//! Paper: Walter et al. 2005, *Lightcuts: A Scalable Approach to Illumination*, section 5; see
//! [`crate::lightcut::ReconstructionCut`], also for where this departs from it.
//!
//! Use it as the default: against records ([`super::cache`]) it takes as long and errs less, most of all where shadows
//! are fine. The patch's cut is its record, a linear fit its gradient, and rays correct it where the sixteen disagree.
//! Caustics on what the eye sees are missing, as in [`super::lightcuts`].

use super::cache::{self, Prepared};
use super::ladder::CUTS;
use super::sampling::method_settings;
use super::{Method, Move, Output, Renderer};
use crate::eye::EyePass;
use crate::film::Window;
use crate::light_tree::Family;
use crate::lightcut::CutSettings;
use crate::progress::Control;
use crate::radiance_cache::{CacheSettings, FoundBy};
use crate::setting::{COMPENSATION, INSPECT, PATCHES, SHARE};
use crate::shadow::ShadowSettings;
use crate::stats::StageTime;
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;

method_settings! {
    /// Settings of the method.
    spp = 4, "Lightcuts" {
        /// Numbers of VPLs; their seed is not used.
        light: LightPassSettings = LightPassSettings::default() => [group];
        /// Accuracy of the cut of an eye sample.
        cut: CutSettings = CutSettings::default() => [group];
        /// Compensation by short rays for light lost to clamping.
        compensation: bool = true => [is COMPENSATION];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Number of patches of eye samples, about. The cost of cuts is in proportion to it, whatever the
        /// resolution.
        patches: u32 = CacheSettings::default().patches => [is PATCHES];
        /// Sharing of cuts between neighbours; if off, all have their own, whatever `patches` says.
        share: bool = true => [is SHARE];
        /// Use of the occluder cache by shadow rays of cuts.
        shadows: ShadowSettings = ShadowSettings::default() => [group];
        /// Images of direct and of indirect light, beside the picture.
        inspect: bool = false => [is INSPECT];
    }
}

impl Settings {
    /// The same of a cache without records.
    fn cached(&self) -> cache::Settings {
        let Settings { spp, seed, max_depth, light, cut, compensation, family, inspect, .. } = *self;
        let cache = CacheSettings {
            direct: FoundBy::Cuts,
            indirect: FoundBy::Cuts,
            patches: self.patches,
            share: self.share,
            shadows: self.shadows,
            ..CacheSettings::default()
        };
        cache::Settings { spp, seed, max_depth, light, cut, compensation, family, cache, inspect }
    }
}

/// Renders what `view` sees.
pub fn render(world: &World, view: &View, settings: &Settings, control: &Control) -> Output {
    cache::render(world, view, &settings.cached(), control)
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "reconstruction"
    }

    fn about(&self) -> &'static str {
        "Reconstruction cuts: a few eye samples of each patch share a lightcut, from which the others are lit"
    }

    fn render(&self, world: &World, view: &View, control: &Control) -> Output {
        render(world, view, self, control)
    }

    fn expected_bytes(&self, window: &Window) -> Option<u64> {
        Some(EyePass::expected_bytes(window, self.spp))
    }

    fn ladder(&self) -> &'static [Move] {
        &CUTS
    }

    fn prepares(&self) -> bool {
        true
    }

    fn prepare<'w>(
        &self,
        world: &'w World,
        view: &View,
        control: &Control,
    ) -> Option<Box<dyn super::Prepared + 'w>> {
        Some(Box::new(Prepared::new(world, view, &self.cached(), control)))
    }
}

impl super::Prepared for Prepared<'_> {
    fn lighting_time(&self, method: &Method, every: usize) -> Option<StageTime> {
        let Method::Reconstruction(settings) = method else { return None };
        self.lighting_time(&settings.cached(), every)
    }

    fn light(self: Box<Self>, method: &Method, control: &Control) -> Option<Output> {
        let Method::Reconstruction(settings) = method else { return None };
        Some((*self).light(&settings.cached(), control))
    }
}
