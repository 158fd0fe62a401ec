//! The image by blocks of pixels: light pass, trees, then tile by tile.

use super::Settings;
use super::blocks::{BlockTiles, LitTile, TILE};
use crate::method::Output;
use crate::method::lights::{LightStore, lights_wanted};
use crate::method::sampling::HasSampling;
use crate::method::tally::Tally;
use base::film::{Image, Layer};
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::stats::{Contributions, Stage};
use rayon::prelude::*;
use transport::eye::{EyeRays, LightBySpecularLobes, VisibleSurfaces};
use transport::shade::{Shader, ShadingContext, ShadingCounts};
use world::World;
use world::view::View;

impl Settings {
    /// Renders the image of `view` without keeping its eye samples.
    pub(super) fn by_blocks(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        control: &Control,
    ) -> Output {
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
        self.report(&work, &mut tally);
        tally.eye(&chains);
        let complete = tiles.iter().all(Option::is_some) && !control.is_cancelled();
        let extra = vec![Layer::scalar("cut", cut_size)];
        Output { extra, complete, nonfinite, ..Output::new(color, tally) }
    }

    /// Shades all tiles; `None` for those that were cancelled.
    fn tiles(&self, context: &ShadingContext, tiles: &BlockTiles, control: &Control) -> Vec<Option<LitTile>> {
        let corners: Vec<[u32; 2]> = tiles.window.film_squares(TILE).collect();
        control.begin(Stage::Render, corners.len() as u64);
        let settings = self.shading();
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
