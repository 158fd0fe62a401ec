//! The picture: light pass, trees, then pixels in tiles.

use super::tile::{TILE, Tile, Workspace};
use crate::compensation::Compensation;
use crate::compensation::samples::NearCounts;
use crate::eye::ChainCounts;
use crate::film::Image;
use crate::light_tree::Family;
use crate::lightcut::{CutCounts, CutSettings, Transfer};
use crate::math::Rgb;
use crate::method::ladder::CUTS;
use crate::method::lights::Lights;
use crate::method::sampling::method_settings;
use crate::method::{Move, Output, Renderer, counts};
use crate::progress::Control;
use crate::setting::{COMPENSATION, SHARE};
use crate::shadow::{ShadowCounts, ShadowSettings};
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

    fn render(&self, world: &World, view: &View, control: &Control) -> Output {
        render(world, view, self, control)
    }

    fn ladder(&self) -> &'static [Move] {
        &CUTS
    }
}

/// What all tiles share.
pub(super) struct Scenery<'a> {
    pub world: &'a World,
    pub view: &'a View,
    pub settings: &'a Settings,
    pub transfer: Transfer<'a>,
    pub compensation: Option<Compensation<'a>>,
    pub max_depth: u32,
}

/// Renders what `view` sees.
pub fn render(world: &World, view: &View, settings: &Settings, control: &Control) -> Output {
    let mut stats = Stats::new();
    let max_depth = world.scene.path_limit(settings.max_depth);

    let light = LightPassSettings { seed: settings.seed, ..settings.light };
    let lights = Lights::new(world, &light, settings.family, max_depth, control, &mut stats);
    let transfer = lights.transfer(settings.compensation);
    let compensation = settings.compensation.then(|| lights.compensation(world));
    let scenery = Scenery { world, view, settings, transfer, compensation, max_depth };

    // Tiles are aligned to the film, not to the window.
    let first = view.window.offset.map(|o| o / TILE);
    let across = (view.window.offset[0] + view.window.width).div_ceil(TILE) - first[0];
    let down = (view.window.offset[1] + view.window.height).div_ceil(TILE) - first[1];
    let corner = |i: usize| [(i as u32 % across + first[0]) * TILE, (i as u32 / across + first[1]) * TILE];
    let mut tiles: Vec<Tile> = (0..across * down).map(|_| Tile::default()).collect();
    control.begin(Stage::Render, tiles.len() as u64);
    stats.time(Stage::Render, || {
        tiles.par_iter_mut().enumerate().for_each_init(
            || Workspace::new(world, settings),
            |work, (i, tile)| {
                if !control.is_cancelled() {
                    tile.render(&scenery, corner(i), work);
                    control.advance(1);
                }
            },
        );
    });

    let mut color = Image::new(view.window.width, view.window.height);
    let mut cut_size = Image::new(view.window.width, view.window.height);
    let mut used = CutCounts::default();
    let mut near = NearCounts::default();
    let mut chains = ChainCounts::default();
    let mut nonfinite = 0;
    let mut shadows = ShadowCounts::default();
    for (i, tile) in tiles.iter().enumerate().filter(|(_, tile)| tile.done) {
        for (k, [x, y]) in scenery.tile_area(corner(i)).pixels().enumerate() {
            let at = ((y - view.window.offset[1]) * view.window.width + x - view.window.offset[0]) as usize;
            color.pixels[at] = tile.radiance[k];
            cut_size.pixels[at] = Rgb::splat(tile.cut_sizes[k]);
        }
        used += tile.counts;
        near += tile.near;
        shadows += tile.shadows;
        chains += tile.chains;
        nonfinite += tile.nonfinite;
    }
    stats.count("Rays/shadow packets", used.packets);
    shadows.report(&mut stats);
    counts::cuts(&mut stats, "Lightcut", &used);
    counts::clamping(&mut stats, &used, scenery.compensation.is_some().then_some(&near));
    counts::eye(&mut stats, &chains);
    let complete = tiles.iter().all(|t| t.done);
    let extra = vec![("cut".to_owned(), cut_size)];
    Output { color, variance: None, extra, stats, complete, nonfinite }
}
