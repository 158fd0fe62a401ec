//! The picture: pixels in tiles, samples in passes.

use super::Begun;
use super::pixels::draw_pixels;
use crate::method::ladder::PATHS;
use crate::method::sampling::method_settings;
use crate::method::{DrawnPixels, LightStore, Move, Output, Renderer};
use base::film::Image;
use base::math::Rgb;
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::stats::{Stage, Stats};
use rayon::prelude::*;
use transport::eye::{FeatureSettings, FirstSurfaces, FullPaths, Guide, PackedGuide, PackedGuides};
use transport::paths::{Batch, Estimand, PathStart, RayCounts, start};
use world::World;
use world::view::View;

/// Pixels along a tile's edge.
const TILE: u32 = 16;

/// Samples a pixel takes before the next pass; a cancelled render keeps whole passes of each tile.
const PASS: u32 = 16;

/// Samples of a tile's pixels that are traced together: enough paths to fill packets to the end, few enough
/// for the second-level cache.
const BATCH: u32 = 4;

method_settings! {
    /// Settings of the method.
    spp = 64, "" {
        /// Value that a pixel is to have.
        estimand: Estimand = Estimand::Pixels;
        /// True if a denoiser's guides are to be found on the way.
        guides: bool = false;
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "path"
    }

    fn about(&self) -> &'static str {
        "Unbiased path tracing: slow to converge, the reference"
    }

    fn render(&self, world: &World, _lights: &LightStore, view: &View, control: &Control) -> Output {
        self.picture(world, None, view, control)
    }

    fn render_rest(
        &self,
        world: &World,
        _lights: &LightStore,
        begun: &Begun,
        view: &View,
        control: &Control,
    ) -> Output {
        self.picture(world, Some(begun), view, control)
    }

    fn estimand(&self) -> Estimand {
        self.estimand
    }

    fn find_guides(&mut self) {
        self.guides = self.estimand == Estimand::Pixels;
    }

    fn finds_guides(&self) -> bool {
        self.guides
    }

    fn draw_pixels(
        &self,
        world: &World,
        _: &LightStore,
        view: &View,
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> Option<DrawnPixels> {
        draw_pixels(world, view, self.max_depth, groups, control)
    }

    fn ladder(&self) -> &'static [Move] {
        &PATHS
    }
}

impl Settings {
    /// The picture, from where an interrupted one ended.
    fn picture(&self, world: &World, begun: Option<&Begun>, view: &View, control: &Control) -> Output {
        let mut stats = Stats::new();
        let tile = |i| begun.and_then(|begun| Tile::of(begun, view, self.spp, i)).unwrap_or_default();
        let mut tiles: Vec<Tile> = (0..view.window.tile_count(TILE)).map(tile).collect();
        let passes = self.spp.div_ceil(PASS);
        // Those of earlier samples are gone, and paths that may not go on say nothing of surfaces.
        let goes_on = world.scene.path_limit(self.max_depth) > 1;
        let finds_guides = self.guides && goes_on && tiles.iter().all(|tile| tile.samples == 0);
        control.begin(Stage::Render, passes as u64 * tiles.len() as u64);
        let batches = Workspaces::new(Batch::default);
        stats.time(Stage::Render, || {
            for pass in 0..passes {
                if control.is_cancelled() {
                    break;
                }
                let end = (pass * PASS).saturating_add(PASS).min(self.spp);
                tiles.par_iter_mut().one_by_one().enumerate().for_each(|(i, tile)| {
                    if !control.is_cancelled() {
                        let settings = Settings { guides: finds_guides, ..*self };
                        batches.with(|batch| tile.render((world, view), &settings, (i, end), batch));
                        control.advance(1);
                    }
                });
            }
        });
        let mut color = Image::new(view.window.width, view.window.height);
        let mut squares = Image::new(view.window.width, view.window.height);
        let mut samples = squares.map(|_| 0);
        let mut guides = vec![PackedGuide::default(); if finds_guides { color.pixels.len() } else { 0 }];
        let (mut rays, mut shadow_rays, mut paths) = (0, 0, 0);
        let mut nonfinite = begun.map_or(0, |begun| begun.nonfinite);
        for (i, tile) in tiles.iter().enumerate() {
            for (pixel, [x, y]) in tile.pixels.iter().zip(view.window.tile(i, TILE)) {
                let at = (y * view.window.width + x) as usize;
                color.pixels[at] = pixel.mean;
                // Squares of radiances that f32 holds may be beyond it.
                squares.pixels[at] = pixel.squares.min(Rgb::splat(f32::MAX));
                samples.pixels[at] = tile.samples;
            }
            for (guide, [x, y]) in tile.guides.iter().zip(view.window.tile(i, TILE)) {
                guides[(y * view.window.width + x) as usize] = guide.kept(tile.samples);
            }
            paths += tile.paths;
            rays += tile.counts.rays;
            shadow_rays += tile.counts.shadow_rays;
            nonfinite += tile.nonfinite;
        }
        stats.count("Paths/total", paths);
        stats.count("Rays/closest hit", rays);
        stats.count("Rays/shadow", shadow_rays);
        let complete = tiles.iter().all(|t| t.samples == self.spp);
        // With a single sample there is no spread to measure.
        let variance = (self.spp > 1).then(|| variance(&squares, &samples));
        let begun = Begun::layers(squares, samples);
        let guides = if finds_guides { PackedGuides(guides).layers(&view.window) } else { Vec::new() };
        Output { variance, begun, guides, complete, nonfinite, ..Output::new(color, stats) }
    }
}

/// Variance of each pixel's mean; 0 where there are too few samples for one.
fn variance(squares: &Image, samples: &Image<u32>) -> Image {
    let mut samples = samples.pixels.iter().map(|n| *n as f32);
    squares.map(|squares| match samples.next() {
        Some(n) if n > 1.0 => *squares / (n * (n - 1.0)),
        _ => Rgb::ZERO,
    })
}

/// Running mean and sum of squared differences of one pixel (Welford).
#[derive(Clone, Copy, Default)]
struct Pixel {
    mean: Rgb,
    squares: Rgb,
}

/// A tile's pixels and their counts.
#[derive(Default)]
struct Tile {
    pixels: Vec<Pixel>,
    /// Of the pixels, where they are wanted.
    guides: Vec<Guide>,
    samples: u32,
    /// Paths traced in this run.
    paths: u64,
    counts: RayCounts,
    nonfinite: u64,
}

impl Tile {
    /// The tile as it was when a picture of `spp` samples was interrupted; `None` if that cannot have been.
    fn of(begun: &Begun, view: &View, spp: u32, index: usize) -> Option<Tile> {
        let (mut pixels, mut samples) = (Vec::new(), None);
        for [x, y] in view.window.tile(index, TILE) {
            let at = (y * view.window.width + x) as usize;
            let [mean, squares] = [&begun.color, &begun.squares].map(|image| image.pixels.get(at).copied());
            pixels.push(Pixel { mean: mean?, squares: squares? });
            let own = *begun.samples.pixels.get(at)?;
            if *samples.get_or_insert(own) != own {
                return None;
            }
        }
        let samples = samples.filter(|n| *n <= spp && (n % PASS == 0 || *n == spp))?;
        Some(Tile { pixels, samples, ..Tile::default() })
    }

    /// Takes the samples up to `end` of every pixel of the tile of this index.
    fn render(
        &mut self,
        (world, view): (&World, &View),
        settings: &Settings,
        (index, end): (usize, u32),
        batch: &mut Batch,
    ) {
        let max_depth = world.scene.path_limit(settings.max_depth);
        let begin = self.samples;
        if begin >= end {
            return;
        }
        // The film's own coordinates, so that a crop repeats the whole picture's pixels.
        let film_pixels: Vec<[u32; 2]> =
            view.window.tile(index, TILE).map(|at| view.window.film_pixel(at)).collect();
        if self.pixels.is_empty() {
            self.pixels = vec![Pixel::default(); film_pixels.len()];
        }
        let mut paths = FullPaths::default();
        if settings.guides {
            self.guides.resize(film_pixels.len(), Guide::default());
            paths.first_surfaces = Some(FirstSurfaces::default());
        }
        for first in (begin..end).step_by(BATCH as usize) {
            let samples = first..(first + BATCH).min(end);
            let starts = film_pixels.iter().flat_map(|&pixel| {
                samples.clone().map(move |sample| PathStart { pixel, sample, seed: settings.seed })
            });
            start(batch, starts, world, view, settings.estimand, settings.spp);
            if let Some(first) = &mut paths.first_surfaces {
                first.begin(film_pixels.len(), samples.len() as u32);
            }
            let mut values = batch.trace(world, max_depth, &mut paths, &mut self.counts);
            if let Some(first) = &mut paths.first_surfaces {
                let (spp, seed) = (settings.spp, settings.seed);
                let features = FeatureSettings { estimand: Estimand::Pixels, spp, seed };
                first.finish(world, view, features, &film_pixels, samples.start);
                self.guides.iter_mut().enumerate().for_each(|(i, guide)| guide.add(first.of(i)));
            }
            for pixel in &mut self.pixels {
                for (sample, mut value) in samples.clone().zip(values.by_ref()) {
                    if !value.is_finite() {
                        self.nonfinite += 1;
                        value = Rgb::ZERO;
                    }
                    let difference = value - pixel.mean;
                    pixel.mean += difference / (sample + 1) as f32;
                    pixel.squares += difference * (value - pixel.mean);
                }
            }
        }
        self.paths += u64::from(end - begin) * self.pixels.len() as u64;
        self.samples = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use transport::eye::{Feature, Features, SeenPixels};
    use world::testkit::*;

    #[test]
    fn guides_are_the_features_of_all_paths_and_change_none() {
        let world = room_with_ball(Some(mirror()));
        let (view, control) = (&world.view, &Control::new());
        let plain = Settings { spp: 18, seed: 3, ..Settings::default() };
        let mut guided = plain;
        guided.find_guides();
        let render = |settings: &Settings| settings.render(&world, &LightStore::default(), view, control);
        let (expected, found) = (render(&plain), render(&guided));
        assert_eq!(found.color, expected.color);
        assert!(expected.guides.is_empty());
        let settings = FeatureSettings { estimand: plain.estimand(), spp: plain.spp, seed: plain.seed };
        let wanted = Features::default().with(Feature::Albedo).with(Feature::Normal);
        let features = SeenPixels::new(&world, view, &settings, control).layers(&world, wanted);
        for (feature, guide) in features.iter().zip(&found.guides) {
            assert_eq!(feature.name, guide.name);
            let [feature, guide] = [feature, guide].map(|layer| &layer.triples().expect("a vector").pixels);
            let off = |(a, b): (&Rgb, &Rgb)| (*a - *b).abs().max_element();
            let error = feature.iter().zip(guide).map(off).fold(0.0, f32::max);
            assert!(error < 1e-4, "{error}");
        }
        assert_eq!(found.guides.len(), 2);
        // Samples that were taken before have none.
        let (color, squares, samples) =
            (expected.color.clone(), expected.color.clone(), expected.color.map(|_| 16));
        let begun = Begun { color, squares, samples, nonfinite: 0, seconds: 0.0 };
        let rest = guided.render_rest(&world, &LightStore::default(), &begun, view, control);
        assert!(rest.complete && rest.guides.is_empty());
        assert!(render(&Settings { max_depth: Some(1), ..guided }).guides.is_empty());
    }
}
