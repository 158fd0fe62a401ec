//! Settings of the method.

use super::render::{light, lighting_time};
use crate::method::ladder::CUTS;
use crate::method::sampling::method_settings;
use crate::method::{LightStore, Move, Output, Prepared, Renderer, Sampled};
use base::film::Window;
use base::progress::Control;
use base::setting::{COMPENSATION, PATCHES, SHARE};
use base::stats::StageTime;
use transport::eye::EyePass;
use transport::lightcut::CutSettings;
use transport::lights::{Family, LightPassSettings};
use transport::radiance_cache::CacheSettings;
use transport::shade::ShadeSettings;
use world::World;
use world::shadow::ShadowSettings;
use world::view::View;

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
    /// All of the picture but its lighting.
    fn prepared<'w>(
        &self,
        world: &'w World,
        lights: &LightStore,
        view: &View,
        control: &Control,
    ) -> Prepared<'w> {
        let wanted = ((self.light, self.family), true);
        Prepared::new(world, lights, view, (self.sampling(), None), wanted, control)
    }

    /// Settings of the shading stage.
    pub(super) fn shading(&self) -> ShadeSettings {
        ShadeSettings { cut: self.cut, share: self.share, samples: None, shadows: self.shadows }
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
        light(self, world, self.prepared(world, lights, view, control), control)
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        let lights = self.light.expected_bytes();
        EyePass::expected_bytes(window, self.spp.into()).saturating_add(lights)
    }

    fn ladder(&self) -> &'static [Move] {
        &CUTS
    }

    fn prepares(&self) -> bool {
        true
    }

    fn prepare<'w>(&self, world: &'w World, view: &View, control: &Control) -> Option<Prepared<'w>> {
        Some(self.prepared(world, &LightStore::default(), view, control))
    }

    fn lighting_time(&self, world: &World, prepared: &Prepared, every: usize) -> Option<StageTime> {
        Some(lighting_time(self, world, prepared, every))
    }

    fn light(&self, world: &World, prepared: Prepared, control: &Control) -> Option<Output> {
        Some(light(self, world, prepared, control))
    }
}
