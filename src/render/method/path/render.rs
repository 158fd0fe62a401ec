//! The image: pixels in tiles, samples in passes.

use super::pixels::sample_pixels;
use super::tile::{PASS, PartialImage, PathTile, TILE, TileInputs};
use crate::denoise::effort::Sampled;
use crate::method::Output;
use crate::method::lights::LightStore;
use crate::method::renderer::{Renderer, Resumes, SampledPixels};
use crate::method::sampling::{HasSampling, method_settings};
use crate::method::scale::{Move, PATHS};
use crate::method::tally::Tally;
use base::film::Image;
use base::math::Rgb;
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::setting::PHOTON_ENDS;
use base::stats::Stage;
use rayon::prelude::*;
use std::sync::Arc;
use transport::eye::{PackedGuides, survey};
use transport::irradiance::PathEnds;
use transport::paths::{Batch, Estimand};
use world::World;
use world::view::View;

method_settings! {
    /// Settings of the method.
    spp = 64 {
        /// True if photons end the paths of denoised images.
        photon_ends: bool = true => [is PHOTON_ENDS];
        /// True if the image will be denoised.
        denoised: bool = false;
        /// Quantity that a pixel estimates.
        estimand: Estimand = Estimand::Pixels;
    }
}

impl Renderer for Settings {
    fn name(&self) -> &'static str {
        "path"
    }

    fn about(&self) -> &'static str {
        "Path tracing: unbiased and slow to converge, for references"
    }

    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        self.image(world, lights, None, view, control)
    }

    fn estimand(&self) -> Estimand {
        self.estimand
    }

    fn expect_denoising(&mut self) {
        self.denoised = true;
    }

    fn as_resumes(&self) -> Option<&dyn Resumes> {
        Some(self)
    }

    fn finds_guides(&self) -> bool {
        self.denoised && self.estimand == Estimand::Pixels
    }

    fn sampled(&self) -> Sampled {
        Sampled::All
    }

    fn sample_pixels(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> Option<SampledPixels> {
        let known = lights.learned(world, view, self.spp, control);
        // Full paths: noise does not show the bias of photons.
        sample_pixels(world, view, self.max_depth, known.light.as_ref(), groups, control)
    }

    fn moves(&self) -> &'static [Move] {
        &PATHS
    }
}

impl Resumes for Settings {
    fn render_rest(
        &self,
        world: &World,
        lights: &LightStore,
        partial: &PartialImage,
        view: &View,
        control: &Control,
    ) -> Output {
        self.image(world, lights, Some(partial), view, control)
    }
}

impl Settings {
    /// Returns the light by which paths end, if the image will be denoised.
    fn path_ends(
        &self,
        world: &World,
        lights: &LightStore,
        view: &View,
        control: &Control,
        tally: &mut Tally,
    ) -> Option<Arc<PathEnds>> {
        let settings = self.sampling().eye(&world.scene);
        let wanted = self.denoised && self.photon_ends;
        wanted.then(|| lights.path_ends(world, view, settings, control, tally)).flatten()
    }

    /// Renders the image, from the end of an interrupted one if there is one.
    fn image(
        &self,
        world: &World,
        lights: &LightStore,
        partial: Option<&PartialImage>,
        view: &View,
        control: &Control,
    ) -> Output {
        let mut tally = Tally::default();
        let known = tally.time(Stage::Render, || lights.learned(world, view, self.spp, control));
        tally.rays(known.counts.rays);
        tally.shadow_rays("Rays/shadow", known.counts.shadow_rays);
        let tile = |i| partial.and_then(|p| PathTile::of(p, view, self.spp, i)).unwrap_or_default();
        let mut tiles: Vec<PathTile> = (0..view.window.tile_count(TILE)).map(tile).collect();
        let Settings { estimand, spp, seed, .. } = *self;
        let max_depth = world.scene.path_limit(self.max_depth);
        let ends = self.path_ends(world, lights, view, control, &mut tally);
        let survey =
            self.finds_guides().then(|| tally.time(Stage::Render, || survey(world, view, seed, control)));
        let (learned, path_ends) = (known.light.as_ref(), ends.as_deref());
        let inputs = TileInputs {
            world,
            view,
            estimand,
            spp,
            seed,
            max_depth,
            survey: survey.as_ref(),
            learned,
            path_ends,
        };
        tally.time(Stage::Render, || render_tiles(&mut tiles, &inputs, control));

        for tile in &tiles {
            tally.count("Paths/total", tile.paths);
            tally.rays(tile.counts.rays);
            tally.count("Rays/positions", tile.covering);
            tally.shadow_rays("Rays/shadow", tile.counts.shadow_rays);
        }
        let TileImages { color, squares, samples } = TileImages::new(&tiles, view);
        let complete = tiles.iter().all(|tile| tile.samples == spp);
        let nonfinite = partial.map_or(0, |partial| partial.nonfinite)
            + tiles.iter().map(|tile| tile.nonfinite).sum::<u64>();
        // A single sample has no variance.
        let variance = (spp > 1).then(|| variance(&squares, &samples));
        let resumable = PartialImage::layers(squares, samples);
        let guides =
            survey.map_or_else(Vec::new, |survey| PackedGuides::of_survey(&survey).layers(&view.window));
        Output { variance, resumable, guides, complete, nonfinite, ..Output::new(color, tally) }
    }
}

/// Takes the samples of all tiles, pass by pass, until cancelled.
fn render_tiles(tiles: &mut [PathTile], inputs: &TileInputs, control: &Control) {
    let passes = inputs.spp.div_ceil(PASS);
    control.begin(Stage::Render, passes as u64 * tiles.len() as u64);
    let window = &inputs.view.window;
    let live = control.live([window.width, window.height]);
    let show = |i: usize, tile: &PathTile| {
        if let Some(live) = &live {
            let indices = window.tile(i, TILE).map(|[x, y]| (y * window.width + x) as usize);
            live.set(indices.zip(tile.pixels.iter().map(|pixel| pixel.mean)));
        }
    };
    // Samples of an interrupted run are there from the start.
    tiles.iter().enumerate().filter(|(_, tile)| tile.samples > 0).for_each(|(i, tile)| show(i, tile));
    let batches = Workspaces::new(Batch::default);
    for pass in 0..passes {
        if control.is_cancelled() {
            break;
        }
        let end = (pass * PASS).saturating_add(PASS).min(inputs.spp);
        tiles.par_iter_mut().one_by_one().enumerate().for_each(|(i, tile)| {
            if !control.is_cancelled() {
                batches.with(|batch| tile.render(inputs, i, end, batch));
                show(i, tile);
                control.advance(1);
            }
        });
    }
}

/// Images that tiles are put together to.
struct TileImages {
    color: Image,
    squares: Image,
    samples: Image<u32>,
}

impl TileImages {
    fn new(tiles: &[PathTile], view: &View) -> TileImages {
        let window = &view.window;
        let mut color = Image::new(window.width, window.height);
        let mut squares = Image::new(window.width, window.height);
        let mut samples = squares.map(|_| 0);
        for (i, tile) in tiles.iter().enumerate() {
            let indices = || window.tile(i, TILE).map(|[x, y]| (y * window.width + x) as usize);
            for (pixel, at) in tile.pixels.iter().zip(indices()) {
                color.pixels[at] = pixel.mean;
                // Squares of radiances that f32 holds may overflow.
                squares.pixels[at] = pixel.squares.min(Rgb::splat(f32::MAX));
                samples.pixels[at] = tile.samples;
            }
        }
        TileImages { color, squares, samples }
    }
}

/// Returns the variance of each pixel's mean; 0 if there are too few samples.
fn variance(squares: &Image, samples: &Image<u32>) -> Image {
    let mut samples = samples.pixels.iter().map(|n| *n as f32);
    squares.map(|squares| match samples.next() {
        Some(n) if n > 1.0 => *squares / (n * (n - 1.0)),
        _ => Rgb::ZERO,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::film::Layer;
    use glam::Vec3;
    use transport::eye::{Feature, FeatureSettings, Features, SeenPixels};
    use world::testkit::*;

    #[test]
    fn guides_are_as_good_as_many_samples_however_few_paths_there_are() {
        let world = room_with_ball(Some(mirror()));
        let (view, control) = (&world.view, &Control::new());
        let render = |settings: &Settings| settings.render(&world, &LightStore::default(), view, control);
        let plain = Settings { spp: 1, seed: 3, ..Settings::default() };
        assert!(render(&plain).guides.is_empty());
        let denoised = Settings { denoised: true, ..plain };
        let found = render(&denoised);
        let features = |spp| {
            let settings = FeatureSettings { estimand: Estimand::Pixels, spp, seed: 7 };
            let wanted = Features::default().with(Feature::Albedo).with(Feature::Normal);
            SeenPixels::new(&world, view, &settings, control).layers(&world, wanted)
        };
        let error = |guides: &[Layer], truth: &[Layer]| -> f32 {
            let pairs = guides.iter().zip(truth).flat_map(|(guide, truth)| {
                assert_eq!(guide.name, truth.name);
                let pixels = |layer: &Layer| layer.triples().expect("a vector").pixels.clone();
                pixels(guide).into_iter().zip(pixels(truth))
            });
            pairs.map(|(a, b)| (a - b).length_squared()).sum()
        };
        let truth = features(32);
        let [own, of_one] = [&found.guides, &features(1)].map(|guides| error(guides, &truth));
        assert!(own < 0.1 * of_one, "{own} {of_one}");
        // An image that is resumed has them too.
        let more = Settings { spp: 32, ..denoised };
        let (color, squares, samples) = (found.color.clone(), found.color.clone(), found.color.map(|_| 16));
        let partial = PartialImage { color, squares, samples, nonfinite: 0, seconds: 0.0 };
        let rest = more.render_rest(&world, &LightStore::default(), &partial, view, control);
        assert!(rest.complete && error(&rest.guides, &found.guides) == 0.0);
    }

    /// Returns the mean image over seeds, and the variance of a pixel.
    fn statistics(settings: &Settings, world: &WorldAndView, seeds: u32) -> (Image, f32) {
        let images = (0..seeds).map(|seed| {
            let settings = Settings { seed, ..*settings };
            settings.render(world, &LightStore::default(), &world.view, &Control::new()).color
        });
        let images: Vec<Image> = images.collect();
        let mut mean = Image::new(images[0].width, images[0].height);
        for (i, pixel) in mean.pixels.iter_mut().enumerate() {
            *pixel = images.iter().map(|image| image.pixels[i]).sum::<Rgb>() / seeds as f32;
        }
        let square = |image: &Image| {
            image.pixels.iter().zip(&mean.pixels).map(|(a, b)| (*a - *b).length_squared()).sum::<f32>()
        };
        let variance = images.iter().map(square).sum::<f32>() / (seeds as f32 * mean.pixels.len() as f32);
        (mean, variance)
    }

    #[test]
    fn images_to_be_denoised_have_the_light_of_others_and_less_noise() {
        let world = room_with_ball(None);
        let plain = Settings { spp: 4, max_depth: Some(12), ..Settings::default() };
        let positions = Settings { denoised: true, photon_ends: false, ..plain };
        let ends = Settings { photon_ends: true, ..positions };
        let (truth, _) = statistics(&Settings { spp: 256, ..plain }, &world, 4);
        let variance = |settings: &Settings, most: f64| {
            let (mean, variance) = statistics(settings, &world, 48);
            let off = (mean.luminance() / truth.luminance() - 1.0).abs();
            assert!(off < most, "{off}");
            variance
        };
        let variances = [variance(&plain, 0.01), variance(&positions, 0.01), variance(&ends, 0.02)];
        assert!(variances[2] < 0.5 * variances[0], "{variances:?}");
        // Edges of an emitter in view.
        let mut scene = scene(camera(Vec3::Z * 3.0, Vec3::ZERO, 0.3), [32, 32]);
        let black = add_material(&mut scene, diffuse(Rgb::ZERO));
        let lamp = quad(Vec3::new(-0.45, -0.35, 0.0), Vec3::X * 0.8, Vec3::new(0.2, 0.7, 0.0), black);
        scene.meshes.push(emitting(lamp, Rgb::ONE));
        let world = world::testkit::world(scene);
        let [(truth, of_own), (mean, chosen)] =
            [plain, positions].map(|settings| statistics(&settings, &world, 48));
        assert!((mean.luminance() / truth.luminance() - 1.0).abs() < 0.003);
        assert!(chosen < 0.5 * of_own, "{chosen} {of_own}");
    }
}
