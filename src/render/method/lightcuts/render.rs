//! The picture: light pass, trees, then pixels in tiles.

use super::blocks::{TILE, Tile, Tiles};
use crate::method::ladder::CUTS;
use crate::method::lights::{LightStore, lights_wanted};
use crate::method::sampling::method_settings;
use crate::method::{Move, Output, Renderer, Sampled, counts};
use base::film::{Image, Layer, Window};
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::setting::{COMPENSATION, SHARE};
use base::stats::{Contributions, Stage, Stats};
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
        "Lightcuts per pixel: virtual point lights, clustered as far as the expected error allows"
    }

    fn expected_bytes(&self, window: &Window) -> u64 {
        Image::expected_bytes(window) + self.light.expected_bytes()
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        let mut stats = Stats::new();
        let wanted = lights_wanted(world, self.sampling(), (self.light, self.family), Vec::new());
        let eye = self.sampling().eye(&world.scene);
        let caustics = lights.photons.of_picture((world, view), eye, control, &mut stats);
        let lights = lights.get(world, wanted, control, &mut stats);
        let context = ShadingContext::new(world, &lights, self.compensation);
        let shading =
            ShadeSettings { cut: self.cut, share: self.share, samples: None, shadows: self.shadows };
        let tiles =
            Tiles { rays: EyeRays::new(world, view, eye), window: &view.window, spp: eye.spp, control };

        let corners: Vec<[u32; 2]> = view.window.film_squares(TILE).collect();
        control.begin(Stage::Render, corners.len() as u64);
        let works = Workspaces::new(|| (Shader::new(&context, &shading), VisibleSurfaces::default()));
        let done: Vec<Option<Tile>> = stats.time(Stage::Render, || {
            let shade = |&corner: &[u32; 2]| {
                if control.is_cancelled() {
                    return None;
                }
                let tile = works.with(|(shader, seen)| tiles.shade(corner, shader, seen))?;
                control.advance(1);
                Some(tile)
            };
            corners.par_iter().one_by_one().map(shade).collect()
        });

        let mut color = Image::new(view.window.width, view.window.height);
        let mut cut_size = color.map(|_| 0.0);
        let light = stats
            .time(Stage::Render, || LightBySpecularLobes::new(world, view, eye, caustics.as_ref(), control));
        let (mut work, mut chains, mut nonfinite) = (ShadingCounts::default(), light.chains, light.nonfinite);
        for tile in done.iter().flatten() {
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
        contributions.report(&mut stats);
        stats.count("Rays/shadow packets", work.cuts.packets);
        work.shadows.report(&mut stats);
        counts::cuts(&mut stats, "Lightcut", &work.cuts);
        counts::clamping(&mut stats, &work.cuts, self.compensation.then_some(&work.compensation));
        counts::eye(&mut stats, &chains);
        let complete = done.iter().all(Option::is_some) && !control.is_cancelled();
        let extra = vec![Layer::scalar("cut", cut_size)];
        Output { extra, complete, nonfinite, ..Output::new(color, stats) }
    }

    fn ladder(&self) -> &'static [Move] {
        &CUTS
    }
}
