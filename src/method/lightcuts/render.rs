//! The picture: light pass, trees, then pixels in tiles.

use crate::eye::{ChainCounts, EyeSample, Window, primary_ray, trace};
use crate::image::Image;
use crate::light_tree::{Family, LightTrees};
use crate::lightcut::{CutCounts, CutSettings, Lightcut, Reflector, Transfer};
use crate::math::Rgb;
use crate::method::{Control, Output};
use crate::sampling::{Sampler, hash};
use crate::stats::{Stage, Stats};
use crate::vpl::{LightPassSettings, light_pass};
use crate::world::World;
use rayon::prelude::*;

/// Pixels along a tile's edge.
const TILE: u32 = 16;

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
    /// How light trees are built.
    pub family: Family,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            spp: 1,
            seed: 0,
            max_depth: None,
            light: LightPassSettings::default(),
            cut: CutSettings::default(),
            family: Family::default(),
        }
    }
}

/// A tile's pixels and what was counted for them.
#[derive(Default)]
struct Tile {
    radiance: Vec<Rgb>,
    cut_sizes: Vec<f32>,
    counts: CutCounts,
    chains: ChainCounts,
    nonfinite: u64,
    done: bool,
}

/// What all tiles share.
struct Scenery<'a> {
    world: &'a World,
    window: &'a Window,
    settings: &'a Settings,
    trees: &'a LightTrees,
    transfer: Transfer<'a>,
    max_depth: u32,
}

/// Renders `window` of the scene's film.
pub fn render(world: &World, window: &Window, settings: &Settings, control: &Control) -> Output {
    let mut stats = Stats::new();
    let max_depth = settings.max_depth.or(world.scene.max_depth).unwrap_or(u32::MAX);

    let light = LightPassSettings { seed: settings.seed, ..settings.light };
    control.begin(Stage::LightPass, u64::from(light.indirect));
    let lights = stats.time(Stage::LightPass, || light_pass(world, &light, max_depth, control));
    stats.count("VPLs/total", lights.len() as u64);
    stats.count("VPLs/photon paths", lights.photons.paths);

    control.begin(Stage::Tree, 0);
    let trees = stats
        .time(Stage::Tree, || LightTrees::build(&lights.sets, lights.spots, world.diagonal, settings.family));
    let transfer = Transfer::new(&trees.spots, world.diagonal);
    let scenery = Scenery { world, window, settings, trees: &trees, transfer, max_depth };

    let (across, down) = (window.width.div_ceil(TILE), window.height.div_ceil(TILE));
    let mut tiles: Vec<Tile> = (0..across * down).map(|_| Tile::default()).collect();
    control.begin(Stage::Render, tiles.len() as u64);
    stats.time(Stage::Render, || {
        tiles.par_iter_mut().enumerate().for_each_init(Lightcut::new, |cut, (i, tile)| {
            if !control.is_cancelled() {
                let corner = [i as u32 % across * TILE, i as u32 / across * TILE];
                tile.render(&scenery, corner, cut);
                control.advance(1);
            }
        });
    });

    let mut color = Image::new(window.width, window.height);
    let mut cut_size = Image::new(window.width, window.height);
    let mut counts = CutCounts::default();
    let (mut eye_rays, mut overflow, mut nonfinite) = (0, 0, 0);
    for (i, tile) in tiles.iter().enumerate() {
        let corner = [i as u32 % across * TILE, i as u32 / across * TILE];
        for (k, [x, y]) in tile_pixels(window, corner).enumerate().take(tile.radiance.len()) {
            let at = (y * window.width + x) as usize;
            color.pixels[at] = tile.radiance[k];
            cut_size.pixels[at] = Rgb::splat(tile.cut_sizes[k]);
        }
        counts.add(&tile.counts);
        eye_rays += tile.chains.rays;
        overflow += tile.chains.overflow;
        nonfinite += tile.nonfinite;
    }
    count(&mut stats, &counts);
    stats.count("Rays/closest hit", eye_rays + lights.photons.rays);
    stats.count("Eye/branches dropped", overflow);
    let complete = tiles.iter().all(|t| t.done);
    let extra = vec![("cut".to_owned(), cut_size)];
    Output { color, variance: None, extra, stats, complete, nonfinite }
}

fn count(stats: &mut Stats, counts: &CutCounts) {
    stats.count("Rays/shadow", counts.rays);
    stats.count("Lightcut/cuts", counts.cuts);
    stats.count("Lightcut/clusters", counts.clusters);
    stats.count("Lightcut/capped", counts.capped);
    stats.count("Lightcut/bounds", counts.bounds);
    stats.count("Lightcut/clamped VPLs", counts.clamped);
    stats.add("Lightcut/mean cut", counts.clusters as f64 / counts.cuts.max(1) as f64);
}

/// The pixels of the tile whose first pixel is `corner`, in rows, relative to the window.
fn tile_pixels(window: &Window, corner: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
    let (right, bottom) = ((corner[0] + TILE).min(window.width), (corner[1] + TILE).min(window.height));
    (corner[1]..bottom).flat_map(move |y| (corner[0]..right).map(move |x| [x, y]))
}

impl Tile {
    fn render(&mut self, scenery: &Scenery, corner: [u32; 2], cut: &mut Lightcut) {
        cut.counts = CutCounts::default();
        let spp = scenery.settings.spp.max(1);
        for at in tile_pixels(scenery.window, corner) {
            let [x, y] = scenery.window.film_pixel(at);
            // The film's own coordinates, so that a crop repeats the whole picture's pixels.
            let seed = hash(hash(x, y), scenery.settings.seed);
            let before = cut.counts.clusters;
            let mut sum = Rgb::ZERO;
            for sample in 0..spp {
                let radiance = self.sample(scenery, [x, y], &mut Sampler::new(seed, sample), cut);
                if radiance.is_finite() {
                    sum += radiance;
                } else {
                    self.nonfinite += 1;
                }
            }
            self.radiance.push(sum / spp as f32);
            self.cut_sizes.push((cut.counts.clusters - before) as f32 / spp as f32);
        }
        self.counts = cut.counts;
        self.done = true;
    }

    /// Radiance of one eye sample: emission along its specular chains, and what the surfaces at their ends reflect.
    fn sample(&mut self, s: &Scenery, pixel: [u32; 2], sampler: &mut Sampler, cut: &mut Lightcut) -> Rgb {
        let jitter = sampler.next_2d();
        let ray = primary_ray(&s.world.scene.camera, s.window, pixel, jitter);
        let mut reflected = Rgb::ZERO;
        let visit = |eye: EyeSample| {
            if eye.depth < s.max_depth {
                let surface = &eye.surface;
                let bsdf = s.world.bsdf(surface);
                let receiver =
                    Reflector::new(surface.position, surface.normal, &surface.frame, bsdf, eye.out);
                let radiance = cut.gather(s.trees, &s.transfer, s.world, &receiver, &s.settings.cut);
                reflected += eye.throughput * radiance;
            }
        };
        let emitted = trace(s.world, ray, s.max_depth, sampler, &mut self.chains, visit);
        emitted + reflected
    }
}
