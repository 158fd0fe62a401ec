//! The image: light pass, trees, then pixels in tiles.

use super::blocks::{BlockTiles, LitTile, TILE};
use crate::method::Output;
use crate::method::lights::{LightStore, lights_wanted};
use crate::method::renderer::Renderer;
use crate::method::sampling::{HasSampling, method_settings};
use crate::method::scale::{CUTS, Demand, Move, ScaledSetting, Scales};
use crate::method::tally::Tally;
use base::film::{Image, Layer, Window};
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::setting::{COMPENSATION, SHARE, Value};
use base::stats::{Contributions, Stage};
use rayon::prelude::*;
use transport::eye::{EyeRays, LightBySpecularLobes, VisibleSurfaces};
use transport::lightcut::CutSettings;
use transport::lights::{Family, LightPassSettings};
use transport::shade::{ShadeSettings, Shader, ShadingContext, ShadingCounts};
use world::World;
use world::shadow::ShadowSettings;
use world::view::View;

method_settings! {
    /// Settings of the method.
    spp = 4, "Lightcuts" {
        /// Numbers of VPLs; their seed is not used.
        light: LightPassSettings = LightPassSettings::default() => [group];
        /// Accuracy of a cut.
        cut: CutSettings = CutSettings::default() => [group];
        /// Compensation by short rays for light lost to clamping.
        compensation: bool = true => [is COMPENSATION];
        /// Builder of the light trees.
        family: Family = Family::default() => [group];
        /// Sharing of cuts between neighbouring eye samples.
        share: bool = true => [is SHARE];
        /// Use of the occluder cache by shadow rays.
        shadows: ShadowSettings = ShadowSettings::default() => [group];
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "lightcuts"
    }

    fn about(&self) -> &'static str {
        "Lightcuts per pixel: clusters of virtual point lights, refined to an expected error"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        let mut tally = Tally::default();
        let sampling = self.sampling();
        let eye = sampling.eye(&world.scene);
        let caustics = lights.photons.for_image(world, view, eye, control, &mut tally);
        let wanted = lights_wanted(world, sampling, self.light, self.family, Vec::new());
        let lights = lights.get(world, wanted, control, &mut tally);
        let context = ShadingContext::new(world, &lights, self.compensation);
        let rays = EyeRays::new(world, view, eye);
        let tiles = BlockTiles { rays, window: &view.window, spp: eye.spp, control };
        let tiles = tally.time(Stage::Render, || self.tiles(&context, &tiles, control));

        let mut color = Image::new(view.window.width, view.window.height);
        let mut cut_size = color.map(|_| 0.0);
        let light = tally
            .time(Stage::Render, || LightBySpecularLobes::new(world, view, eye, caustics.as_ref(), control));
        let (mut work, mut chains, mut nonfinite) = (ShadingCounts::default(), light.chains, light.nonfinite);
        for tile in tiles.iter().flatten() {
            for &(pixel, radiance, clusters) in &tile.pixels {
                color.pixels[pixel] = radiance;
                cut_size.pixels[pixel] = clusters;
            }
            work += tile.counts;
            chains += tile.chains;
            nonfinite += tile.nonfinite;
        }
        let mut contributions = Contributions::default();
        contributions.add("cuts and emitters in view", color.luminance());
        light.add_to(&mut color, &mut contributions);
        contributions.report(&mut tally.stats);
        tally.count("Rays/shadow packets", work.cuts.packets);
        work.shadows.report(&mut tally.stats);
        tally.cuts("Lightcut", &work.cuts);
        tally.clamping(&work.cuts, self.compensation.then_some(&work.compensation));
        tally.eye(&chains);
        let complete = tiles.iter().all(Option::is_some) && !control.is_cancelled();
        let extra = vec![Layer::scalar("cut", cut_size)];
        Output { extra, complete, nonfinite, ..Output::new(color, tally) }
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        Image::expected_bytes(window) + self.light.expected_bytes()
    }

    fn as_scales(&self) -> Option<&dyn Scales> {
        Some(self)
    }

    fn as_scales_mut(&mut self) -> Option<&mut dyn Scales> {
        Some(self)
    }
}

impl Settings {
    /// Shades all tiles; `None` for those that were cancelled.
    fn tiles(&self, context: &ShadingContext, tiles: &BlockTiles, control: &Control) -> Vec<Option<LitTile>> {
        let corners: Vec<[u32; 2]> = tiles.window.film_squares(TILE).collect();
        control.begin(Stage::Render, corners.len() as u64);
        let settings =
            ShadeSettings { cut: self.cut, share: self.share, samples: None, shadows: self.shadows };
        let live = control.live([tiles.window.width, tiles.window.height]);
        let workspaces = Workspaces::new(|| (Shader::new(context, &settings), VisibleSurfaces::default()));
        let shade = |&corner: &[u32; 2]| {
            if control.is_cancelled() {
                return None;
            }
            let tile = workspaces.with(|(shader, seen)| tiles.shade(corner, shader, seen))?;
            if let Some(live) = &live {
                live.set(tile.pixels.iter().map(|&(at, radiance, _)| (at, radiance)));
            }
            control.advance(1);
            Some(tile)
        };
        corners.par_iter().one_by_one().map(shade).collect()
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
            ScaledSetting::Patches | ScaledSetting::RecordEpsilon => return None,
        })
    }

    fn demand(&self) -> Demand {
        let LightPassSettings { direct, indirect, .. } = self.light;
        Demand { direct_vpls: direct, vpls: indirect, extra_samples: 0.0, shares_patches: false }
    }
}
