//! The picture: light pass, trees, then pixels in tiles.

use super::tile::{TILE, Tile, Workspace};
use crate::compensation::Compensation;
use crate::compensation::samples::NearCounts;
use crate::eye::ChainCounts;
use crate::film::Image;
use crate::light_tree::Family;
use crate::lightcut::{CutCounts, CutSettings, Transfer};
use crate::math::Rgb;
use crate::method::lights::Lights;
use crate::method::{Output, counts};
use crate::progress::Control;
use crate::shadow::{ShadowCounts, ShadowSettings};
use crate::stats::{Stage, Stats};
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;
use rayon::prelude::*;

/// What the user may set.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Eye samples a pixel.
    pub spp: u32,
    /// Another seed, other VPLs and eye samples. Overrides that of `light`.
    pub seed: u32,
    /// Longest path in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
    /// How many VPLs.
    pub light: LightPassSettings,
    /// When a cut is good enough.
    pub cut: CutSettings,
    /// Whether short rays find again what clamping takes away.
    pub compensation: bool,
    /// How light trees are built.
    pub family: Family,
    /// Whether neighbouring eye samples share cuts.
    pub share: bool,
    /// Which shadow rays ask an occluder cache.
    pub shadows: ShadowSettings,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            spp: 4,
            seed: 0,
            max_depth: None,
            light: LightPassSettings::default(),
            cut: CutSettings::default(),
            compensation: true,
            family: Family::default(),
            share: true,
            shadows: ShadowSettings::default(),
        }
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

/// Renders `window` of the scene's film.
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
