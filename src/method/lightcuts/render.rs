//! The picture: light pass, trees, then pixels in tiles.

use super::blocks::{TILE, Tile, Tiles};
use crate::eye::{ChainCounts, EyeRays, EyeSettings, VisibleSurfaces};
use crate::film::{Image, Layer};
use crate::light_tree::Family;
use crate::lightcut::CutSettings;
use crate::method::ladder::CUTS;
use crate::method::lights::{LightStore, LightsWanted};
use crate::method::sampling::method_settings;
use crate::method::{Move, Output, Renderer, counts};
use crate::progress::Control;
use crate::setting::{COMPENSATION, SHARE};
use crate::shade::{ShadeSettings, Shader, ShadingCounts};
use crate::shadow::ShadowSettings;
use crate::stats::{Stage, Stats};
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;
use rayon::prelude::*;

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

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        render_by(world, lights, view, self, control)
    }

    fn ladder(&self) -> &'static [Move] {
        &CUTS
    }
}

/// Renders the picture of `view`.
pub fn render(world: &World, view: &View, settings: &Settings, control: &Control) -> Output {
    settings.render(world, &LightStore::default(), view, control)
}

fn render_by(
    world: &World,
    lights: &LightStore,
    view: &View,
    settings: &Settings,
    control: &Control,
) -> Output {
    let mut stats = Stats::new();
    let max_depth = world.scene.path_limit(settings.max_depth);
    let pass = LightPassSettings { seed: settings.seed, ..settings.light };
    let lights =
        lights.get(world, LightsWanted { pass, family: settings.family, max_depth }, control, &mut stats);
    let context = lights.context(world, settings.compensation);
    let shading = ShadeSettings { cut: settings.cut, share: settings.share, shadows: settings.shadows };
    let eye = EyeSettings { spp: settings.spp.max(1), seed: settings.seed, max_depth };
    let tiles = Tiles { rays: EyeRays::new(world, view, eye), window: &view.window, spp: eye.spp };

    let corners: Vec<[u32; 2]> = view.window.film_squares(TILE).collect();
    control.begin(Stage::Render, corners.len() as u64);
    let workspace = || (Shader::new(&context, &shading), VisibleSurfaces::default());
    let done: Vec<Option<Tile>> = stats.time(Stage::Render, || {
        let shade = corners.par_iter().map_init(workspace, |(shader, seen), &corner| {
            if control.is_cancelled() {
                return None;
            }
            let tile = tiles.shade(corner, shader, seen);
            control.advance(1);
            Some(tile)
        });
        shade.collect()
    });

    let mut color = Image::new(view.window.width, view.window.height);
    let mut cut_size = color.map(|_| 0.0);
    let (mut work, mut chains, mut nonfinite) = (ShadingCounts::default(), ChainCounts::default(), 0);
    for tile in done.iter().flatten() {
        for &(pixel, radiance, clusters) in &tile.pixels {
            color.pixels[pixel] = radiance;
            cut_size.pixels[pixel] = clusters;
        }
        work += tile.counts;
        chains += tile.chains;
        nonfinite += tile.nonfinite;
    }
    stats.count("Rays/shadow packets", work.cuts.packets);
    work.shadows.report(&mut stats);
    counts::cuts(&mut stats, "Lightcut", &work.cuts);
    counts::clamping(&mut stats, &work.cuts, settings.compensation.then_some(&work.compensation));
    counts::eye(&mut stats, &chains);
    let complete = done.iter().all(Option::is_some);
    let extra = vec![Layer::scalar("cut", cut_size)];
    Output { color, variance: None, extra, stats, complete, nonfinite }
}
