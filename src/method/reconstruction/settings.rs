//! Settings of the method.

use super::Prepared;
use crate::eye::EyePass;
use crate::film::Window;
use crate::light_tree::Family;
use crate::lightcut::CutSettings;
use crate::method::ladder::CUTS;
use crate::method::sampling::method_settings;
use crate::method::{self, LightStore, Method, Move, Output, Renderer};
use crate::progress::Control;
use crate::radiance_cache::CacheSettings;
use crate::setting::{COMPENSATION, PATCHES, SHARE};
use crate::shade::ShadeSettings;
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
    }
}

impl Settings {
    /// Settings of the shading stage.
    pub(super) fn shading(&self) -> ShadeSettings {
        ShadeSettings { cut: self.cut, share: self.share, shadows: self.shadows }
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "reconstruction"
    }

    fn about(&self) -> &'static str {
        "Reconstruction cuts: a few eye samples of each patch share a lightcut, from which the others are lit"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        Prepared::new(world, lights, view, self, control).light(self, control)
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
    ) -> Option<Box<dyn method::Prepared + 'w>> {
        Some(Box::new(Prepared::new(world, &LightStore::default(), view, self, control)))
    }
}

impl method::Prepared for Prepared<'_> {
    fn lighting_time(&self, method: &Method, every: usize) -> Option<StageTime> {
        let Method::Reconstruction(settings) = method else { return None };
        Some(self.lighting_time(settings, every))
    }

    fn light(self: Box<Self>, method: &Method, control: &Control) -> Option<Output> {
        let Method::Reconstruction(settings) = method else { return None };
        Some((*self).light(settings, control))
    }
}
