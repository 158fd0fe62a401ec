//! The image: eye pass, light pass, trees, and cuts that patches of shading points share.

use crate::method::Output;
use crate::method::lights::LightStore;
use crate::method::prepared::{LitSurfaces, Preparation, Prepared};
use crate::method::renderer::Renderer;
use crate::method::sampling::{HasSampling, method_settings};
use crate::method::scale::{CUTS, Demand, Move, ScaledSetting, Scales};
use base::film::Window;
use base::progress::Control;
use base::setting::{COMPENSATION, PATCHES, SHARE, Value};
use base::stats::Stage;
use transport::eye::EyePass;
use transport::lightcut::CutSettings;
use transport::lights::{Family, LightPassSettings};
use transport::radiance_cache::CacheSettings;
use transport::shade::{ShadeSettings, ShadedImage, ShadingContext, ShadingTask};
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
        /// Approximate number of patches of eye samples. The cost of cuts is proportional to it, whatever the
        /// resolution.
        patches: u32 = CacheSettings::default().patches => [is PATCHES];
        /// Sharing of cuts between neighbours. If off, each sample has its own, whatever `patches` says.
        share: bool = true => [is SHARE];
        /// Use of the occluder cache by shadow rays of cuts.
        shadows: ShadowSettings = ShadowSettings::default() => [group];
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "reconstruction"
    }

    fn about(&self) -> &'static str {
        "Reconstruction cuts: a few eye samples of each patch share a lightcut, which also lights the other samples"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        let preparation = Preparation {
            sampling: self.sampling(),
            direct: None,
            lights: self.light,
            family: self.family,
            lit: LitSurfaces::InView,
        };
        let Prepared { eye, lights, mut tally } = Prepared::new(world, lights, view, &preparation, control);
        let tasks: Vec<ShadingTask> = (0..eye.len() as u32).map(ShadingTask::all).collect();
        control.begin(Stage::Render, tasks.len() as u64);
        let context = ShadingContext::new(world, &lights, self.compensation);
        let shading =
            ShadeSettings { cut: self.cut, share: self.share, samples: None, shadows: self.shadows };
        let mut image = ShadedImage::new(&eye, false);
        let counts = tally
            .time(Stage::Render, || image.shade(&context, &eye, &tasks, self.patches, &shading, control));
        image.came_by("cuts");
        tally.count("Shading/tasks by cuts", tasks.len() as u64);
        tally.cuts("Lightcut", &counts.cuts);
        tally.clamping(&counts.cuts, self.compensation.then_some(&counts.compensation));
        counts.shadows.report(&mut tally.stats);
        let complete = eye.complete && !control.is_cancelled();
        let (color, extra, nonfinite) = image.finish(&mut tally.stats);
        Output { extra, complete, nonfinite, ..Output::new(color, tally) }
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        let lights = self.light.expected_bytes();
        EyePass::expected_bytes(window, self.spp.into()).saturating_add(lights)
    }

    fn as_scales(&self) -> Option<&dyn Scales> {
        Some(self)
    }

    fn as_scales_mut(&mut self) -> Option<&mut dyn Scales> {
        Some(self)
    }
}

impl Scales for Settings {
    fn moves(&self) -> &'static [Move] {
        &CUTS
    }

    fn scaled(&mut self, setting: ScaledSetting) -> Option<&mut dyn Value> {
        Some(match setting {
            ScaledSetting::Spp => &mut self.spp,
            ScaledSetting::Epsilon => &mut self.cut.epsilon,
            ScaledSetting::MaxCut => &mut self.cut.max_cut,
            ScaledSetting::Vpls => &mut self.light.indirect,
            ScaledSetting::Patches => &mut self.patches,
            ScaledSetting::RecordEpsilon => return None,
        })
    }

    fn demand(&self) -> Demand {
        let LightPassSettings { direct, indirect, .. } = self.light;
        Demand { direct_vpls: direct, vpls: indirect, extra_samples: 0.0, shares_patches: true }
    }
}
