//! The stages after the method: features as further layers, denoising, and sharpening for filters with negative lobes.

use super::goal::Goal;
use crate::cost::ScenePrices;
use crate::denoise::{DenoiseError, Denoiser, Guides, NOISY, Quality, effort};
use crate::method::{Method, Output};
use base::film::{ALPHA, Image, Layer, Pixels};
use base::math::Rgb;
use base::progress::Control;
use base::stats::{Stage, Stats, Stopwatch, give_back};
use scene::{Environment, Projection};
use transport::eye::{Averaging, Feature, FeatureSettings, Features, Masks, SeenPixels};
use world::World;
use world::view::View;

/// Minimum number of pixels for which free memory is returned to the system before denoising, unless the image is the
/// last.
///
/// The denoiser's library has an allocator of its own.
const LARGE: u64 = 1 << 20;

/// Features and denoiser that a goal asks for, for images of one view.
pub struct Finish<'a> {
    world: &'a World,
    view: &'a View,
    control: &'a Control,
    /// Features that are kept as layers.
    features: Features,
    averaging: Averaging,
    is_last: bool,
    keep_noisy: bool,
    denoiser: Option<Denoiser>,
    /// Reason why the denoiser cannot be loaded.
    load_error: Option<DenoiseError>,
    /// Quality of denoising; `None` if it depends on the work on each image.
    quality: Option<Quality>,
}

impl<'a> Finish<'a> {
    /// Loads the denoiser, if the goal asks for it. The time counts as denoising.
    pub fn new(
        world: &'a World,
        view: &'a View,
        goal: &Goal,
        control: &'a Control,
        stats: &mut Stats,
    ) -> Finish<'a> {
        let watch = Stopwatch::start();
        let (denoiser, load_error) = match goal.denoises().then(Denoiser::load) {
            Some(Ok(denoiser)) => {
                stats.add_time(Stage::Denoise, watch.elapsed());
                (Some(denoiser), None)
            }
            Some(Err(error)) => (None, Some(error)),
            None => (None, None),
        };
        let Goal { mut features, averaging, is_last, keep_noisy, denoise_quality: quality, .. } = *goal;
        if world.scene.hides_background {
            features = features.with(Feature::Alpha);
        }
        Finish {
            world,
            view,
            control,
            features,
            averaging,
            is_last,
            keep_noisy,
            denoiser,
            load_error,
            quality,
        }
    }

    /// Returns the reason why the denoiser cannot be loaded.
    pub fn load_error(&self) -> Option<&DenoiseError> {
        self.load_error.as_ref()
    }

    /// Returns the denoiser, if images are denoised.
    pub fn denoiser(&self) -> Option<&Denoiser> {
        self.denoiser.as_ref()
    }

    /// True if images are denoised.
    pub fn denoises(&self) -> bool {
        self.denoiser.is_some()
    }

    /// True if features are kept as layers.
    pub fn keeps_features(&self) -> bool {
        !self.features.is_empty()
    }

    /// Returns the quality of denoising that the goal sets; `None` if it depends on the work on each image.
    pub fn fixed_quality(&self) -> Option<Quality> {
        self.quality
    }

    /// Returns the library that denoised an image, with the quality unless it is the highest.
    pub fn denoised_by(&self, output: &Output) -> Option<String> {
        let quality = match output.denoised.as_ref()?.as_ref().ok()? {
            Quality::High => "",
            Quality::Balanced => ", balanced quality",
            Quality::Fast => ", fast quality",
        };
        self.denoiser().map(|denoiser| format!("{}{quality}", denoiser.name()))
    }

    /// Returns the quality of denoising for an image of a method.
    fn quality(&self, method: &Method, output: &Output) -> Quality {
        let pixels = self.view.window.pixel_count();
        let work = || ScenePrices::new(self.world.scene.seen_triangle_count()).time(&output.work);
        self.quality.unwrap_or_else(|| effort::for_image(pixels, work(), method.sampled()))
    }

    /// Returns the features that are kept or guide the denoiser.
    fn wanted(&self) -> Features {
        match self.denoises() {
            true => self.features.with(Feature::Albedo).with(Feature::Normal),
            false => self.features,
        }
    }

    /// Finds the surfaces seen by the method's own eye samples.
    pub fn look(&self, method: &Method) -> SeenPixels {
        self.look_at(self.view, method, method.spp())
    }

    fn look_at(&self, view: &View, method: &Method, spp: u32) -> SeenPixels {
        let settings = FeatureSettings { estimand: method.estimand(), spp, seed: method.seed() };
        SeenPixels::new(self.world, view, &settings, self.control)
    }

    /// Returns the layers that are kept: among `means`, or layers of first hits.
    fn kept(&self, method: &Method, mut means: Vec<Layer>) -> Vec<Layer> {
        let unwanted = [Feature::Albedo, Feature::Normal].into_iter().filter(|f| !self.features.contains(*f));
        for feature in unwanted {
            means.retain(|layer| layer.name != feature.name());
        }
        let masks = Feature::ALL.into_iter().filter(|feature| self.features.contains(*feature));
        // Images of other seeds have the same masks, so that they can be merged.
        let of_masks = |masks: Masks| masks.layers(self.world, self.view, 0, self.control);
        let masks: Vec<Layer> = masks.filter_map(Feature::masks).flat_map(of_masks).collect();
        if self.averaging == Averaging::Mean || self.features.is_empty() {
            means.extend(masks);
            return means;
        }
        let settings = FeatureSettings { estimand: method.estimand(), spp: 1, seed: method.seed() };
        let seen = SeenPixels::first_hits(self.world, self.view, &settings, self.control);
        let mut layers = seen.layers(self.world, self.features);
        layers.retain(|layer| layer.name != ALPHA);
        layers.extend(means.into_iter().filter(|layer| layer.name == ALPHA).chain(masks));
        layers
    }

    /// Returns the layers of all features that are wanted, at `spp` eye samples of the method.
    pub fn features(&self, view: &View, method: &Method, spp: u32) -> Vec<Layer> {
        self.look_at(view, method, spp).layers(self.world, self.wanted())
    }

    /// Tells the method if the image will be denoised.
    pub fn guided(&self, mut method: Method) -> Method {
        if self.denoises() {
            method.expect_denoising();
        }
        method
    }

    /// Adds features to a complete image, and denoises and sharpens it. The times are added to the output's.
    pub fn apply(&self, method: &Method, output: Output) -> Output {
        let mut output = self.clean(method, output);
        self.sharpen(&mut output);
        output
    }

    fn clean(&self, method: &Method, mut output: Output) -> Output {
        if self.wanted().is_empty() || !output.complete {
            return output;
        }
        // Surfaces seen take more memory than their layers, so they are dropped before denoising.
        let layers = match output.guides.is_empty() || self.keeps_features() {
            true => {
                let features = || self.features(self.view, method, method.spp());
                output.stats.time(Stage::EyePass, features)
            }
            false => Vec::new(),
        };
        self.apply_to_layers(method, layers, output)
    }

    /// Sharpens a complete image, its noisy layer and its variance, if the filter of the pixels asks for it.
    pub fn sharpen(&self, output: &mut Output) {
        let a = self.view.camera.filter.sharpening();
        if a == 0.0 || !output.complete {
            return;
        }
        output.nonfinite += output.color.remove_nonfinite();
        output.color = output.color.sharpened(a);
        for layer in output.extra.iter_mut().filter(|layer| layer.name == NOISY) {
            if let Some(noisy) = layer.triples() {
                *layer = Layer::color(NOISY, noisy.sharpened(a));
            }
        }
        output.variance = output.variance.take().map(|variance| variance.sharpened_variance(a));
        if self.world.scene.hides_background {
            sharpen_cover(output, a);
        }
    }

    /// True if pixels that see the environment alone have no noise: a lens blurs an environment that varies.
    fn background_is_clean(&self) -> bool {
        let scene = &self.world.scene;
        let varies = matches!(scene.environment, Some(Environment::Map(_))) || !scene.discs.is_empty();
        scene.hides_background || !varies || !matches!(self.view.camera.projection, Projection::Lens { .. })
    }

    /// Adds features to an image, and denoises it, given the surfaces seen.
    pub fn apply_to_seen(&self, method: &Method, seen: &SeenPixels, output: Output) -> Output {
        self.apply_to_layers(method, seen.layers(self.world, self.wanted()), output)
    }

    fn apply_to_layers(&self, method: &Method, layers: Vec<Layer>, mut output: Output) -> Output {
        output.complete &= !self.control.is_cancelled();
        if !output.complete {
            return output;
        }
        if let Some(denoiser) = self.denoiser() {
            let quality = self.quality(method, &output);
            self.denoise(denoiser, quality, &layers, &mut output);
        }
        let kept = self.kept(method, layers);
        output.extra.extend(kept);
        if self.world.scene.hides_background {
            clear_uncovered(&mut output);
        }
        output
    }

    fn denoise(&self, denoiser: &Denoiser, quality: Quality, layers: &[Layer], output: &mut Output) {
        self.control.begin(Stage::Denoise, 0);
        output.nonfinite += output.color.remove_nonfinite();
        if self.is_last || self.view.window.pixel_count() > LARGE {
            give_back();
        }
        let keeps_background = self.background_is_clean();
        let found = std::mem::take(&mut output.guides);
        let layers = if found.is_empty() { layers } else { &found };
        let guides = Guides { keeps_background, ..guides(layers) };
        let clean = || denoiser.denoise(&output.color, &guides, quality);
        let clean = output.stats.time(Stage::Denoise, clean);
        output.denoised = Some(clean.map(|clean| {
            let noisy = std::mem::replace(&mut output.color, clean);
            output.extra.extend(self.keep_noisy.then(|| Layer::color(NOISY, noisy)));
            quality
        }));
    }
}

/// Sharpens the layer of alpha as the image is.
fn sharpen_cover(output: &mut Output, a: f32) {
    for layer in output.extra.iter_mut().filter(|layer| layer.name == ALPHA) {
        if let Pixels::Scalar(alpha) = &mut layer.pixels {
            let sharp = alpha.map(|alpha| Rgb::splat(*alpha)).sharpened(a);
            *alpha = sharp.map(|alpha| alpha.x.clamp(0.0, 1.0));
        }
    }
    clear_uncovered(output);
}

/// Clears pixels whose alpha is 0. Samples that features do not count may have found surfaces there.
fn clear_uncovered(output: &mut Output) {
    for layer in output.extra.iter().filter(|layer| layer.name == ALPHA) {
        if let Pixels::Scalar(alpha) = &layer.pixels {
            let pixels = output.color.pixels.iter_mut().zip(&alpha.pixels);
            pixels.filter(|(_, alpha)| **alpha == 0.0).for_each(|(pixel, _)| *pixel = Rgb::ZERO);
        }
    }
}

/// Returns albedo and normals among the layers of features.
pub fn guides(layers: &[Layer]) -> Guides<'_> {
    let image = |feature: Feature| -> Option<&Image> {
        layers.iter().find(|layer| layer.name == feature.name()).and_then(Layer::triples)
    };
    let (albedo, normal) = (image(Feature::Albedo), image(Feature::Normal));
    Guides { albedo, normal, noise_free: true, ..Guides::default() }
}
