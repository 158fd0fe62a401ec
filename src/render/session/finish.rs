//! From a method's output to the picture that is kept: features beside it, its noise taken off, and sharpened where its
//! pixels' filter has negative lobes.

use super::goal::Goal;
use crate::denoise::{DenoiseError, Denoiser, Guides, NOISY, Quality, effort};
use crate::method::{Method, Output};
use crate::plan::{Work, smaller};
use base::film::{Image, Layer};
use base::progress::Control;
use base::stats::{Stage, Stats, Stopwatch, give_back};
use std::cell::{Cell, OnceCell};
use transport::eye::{Feature, FeatureSettings, Features, SeenPixels};
use world::World;
use world::view::View;

/// Number of pixels from which on the memory of the picture's making is given back before it is denoised, by a library
/// with an allocator of its own.
const LARGE: u64 = 1 << 20;

/// Divisor of each side of the picture that estimates how long finishing takes, and its samples a pixel at most.
const TRIAL_SCALE: u32 = 4;
const TRIAL_SPP: u32 = 4;

/// Time that finishing a picture takes.
#[derive(Clone, Copy, Debug, Default)]
pub struct FinishingTime {
    /// Seconds of denoising.
    pub denoising: f64,
    /// Seconds for each eye sample that is looked through anew.
    pub a_sample: f64,
}

/// The features and the denoiser that a goal asks for, for pictures of one view.
pub struct Finish<'a> {
    world: &'a World,
    view: &'a View,
    control: &'a Control,
    /// Features that are kept.
    features: Features,
    keep_noisy: bool,
    denoiser: Option<Denoiser>,
    /// Quality of denoising, where it is not to go with the work on each picture.
    quality: Option<Quality>,
    /// That of the last picture.
    last_quality: Cell<Quality>,
    /// Reason why a picture is not denoised though it was asked for: the first.
    failure: OnceCell<DenoiseError>,
}

impl<'a> Finish<'a> {
    /// Loads the denoiser, if the goal asks for it; the time is a part of denoising.
    pub fn new(
        world: &'a World,
        view: &'a View,
        goal: &Goal,
        control: &'a Control,
        stats: &mut Stats,
    ) -> Finish<'a> {
        let failure = OnceCell::new();
        let watch = Stopwatch::start();
        let denoiser = goal.denoises().then(Denoiser::load).and_then(|loaded| match loaded {
            Ok(denoiser) => {
                stats.add_time(Stage::Denoise, watch.elapsed());
                Some(denoiser)
            }
            Err(error) => {
                failure.get_or_init(|| error);
                None
            }
        });
        let Goal { features, keep_noisy, denoise_quality, .. } = *goal;
        let (quality, last_quality) = (denoise_quality, Cell::default());
        Finish { world, view, control, features, keep_noisy, denoiser, quality, last_quality, failure }
    }

    /// Reason why a picture is not denoised though it was asked for.
    pub fn failure(&self) -> Option<&DenoiseError> {
        self.failure.get()
    }

    /// Name and version of the library that denoises, and its quality where that is not the highest; `None` if it was
    /// not asked for, or failed.
    pub fn denoised_by(&self) -> Option<String> {
        let quality = match self.last_quality.get() {
            Quality::High => "",
            Quality::Balanced => ", balanced quality",
            Quality::Fast => ", fast quality",
        };
        self.denoiser().map(|denoiser| format!("{}{quality}", denoiser.name()))
    }

    /// Quality of denoising the picture of `output`.
    fn quality(&self, output: &Output) -> Quality {
        let Finish { world, view, .. } = self;
        let pixels = view.window.pixel_count();
        let by_work = || {
            let work = Work::new(world.scene.triangle_count(), pixels).of_counted(&output.stats);
            effort::for_picture(pixels, work)
        };
        self.quality.unwrap_or_else(by_work)
    }

    fn denoiser(&self) -> Option<&Denoiser> {
        self.denoiser.as_ref().filter(|_| self.failure.get().is_none())
    }

    /// True if the picture will be denoised.
    pub fn denoises(&self) -> bool {
        self.denoiser().is_some()
    }

    /// Features that are kept or guide the denoiser.
    fn wanted(&self) -> Features {
        match self.denoises() {
            true => self.features.with(Feature::Albedo).with(Feature::Normal),
            false => self.features,
        }
    }

    /// Looks through the pixels by the method's own eye samples.
    pub fn look(&self, method: &Method) -> SeenPixels {
        self.look_at(self.view, method, method.spp())
    }

    fn look_at(&self, view: &View, method: &Method, spp: u32) -> SeenPixels {
        let settings = FeatureSettings { estimand: method.estimand(), spp, seed: method.seed() };
        SeenPixels::new(self.world, view, &settings, self.control)
    }

    /// The method, which finds a denoiser's guides itself where it can and nobody keeps them.
    pub fn guided(&self, mut method: Method) -> Method {
        if self.denoises() && self.features.is_empty() {
            method.find_guides();
        }
        method
    }

    /// Adds the features of the method's own eye samples to its picture, and denoises and sharpens that, where it is
    /// complete. The times are the output's.
    pub fn apply(&self, method: &Method, output: &mut Output) {
        self.clean(method, output);
        self.sharpen(output);
    }

    fn clean(&self, method: &Method, output: &mut Output) {
        if self.wanted().is_empty() || !output.complete {
            return;
        }
        let wanted = self.wanted();
        // What is seen takes more memory than its layers, and so does denoising: not at once.
        let found = std::mem::take(&mut output.guides);
        let layers = match self.features.is_empty() && !found.is_empty() {
            true => found,
            false => {
                let look = || self.look(method).layers(self.world, wanted);
                output.stats.time(Stage::EyePass, look)
            }
        };
        self.apply_to_layers(layers, output);
    }

    /// Sharpens a complete picture, the noisy one kept beside it and its variance, where the pixels' filter says.
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
    }

    /// As [`Finish::apply`], but for sharpening, by pixels that have been looked through. Returns true if the picture
    /// is denoised.
    pub fn apply_to_seen(&self, seen: &SeenPixels, output: &mut Output) -> bool {
        self.apply_to_layers(seen.layers(self.world, self.wanted()), output)
    }

    fn apply_to_layers(&self, mut layers: Vec<Layer>, output: &mut Output) -> bool {
        output.complete &= !self.control.is_cancelled();
        if !output.complete {
            return false;
        }
        let mut is_denoised = false;
        if let Some(denoiser) = self.denoiser() {
            self.control.begin(Stage::Denoise, 0);
            output.nonfinite += output.color.remove_nonfinite();
            let quality = self.quality(output);
            self.last_quality.set(quality);
            if self.view.window.pixel_count() > LARGE {
                give_back();
            }
            let clean = || denoiser.denoise(&output.color, &guides(&layers), quality);
            match output.stats.time(Stage::Denoise, clean) {
                Ok(clean) => {
                    let noisy = std::mem::replace(&mut output.color, clean);
                    output.extra.extend(self.keep_noisy.then(|| Layer::color(NOISY, noisy)));
                    is_denoised = true;
                }
                Err(error) => {
                    self.failure.get_or_init(|| error);
                }
            }
        }
        let unwanted = [Feature::Albedo, Feature::Normal].into_iter().filter(|f| !self.features.contains(*f));
        for feature in unwanted {
            layers.retain(|layer| layer.name != feature.name());
        }
        output.extra.extend(layers);
        is_denoised
    }

    /// Time that [`Finish::apply`] is likely to take for a picture of `method` made in `within` seconds, by that of
    /// a smaller one.
    pub fn expected_time(&self, method: &Method, within: f64) -> FinishingTime {
        let Some(denoiser) = self.denoiser() else { return FinishingTime::default() };
        let small = smaller(self.view, TRIAL_SCALE);
        let spp = method.spp().min(TRIAL_SPP);
        let watch = Stopwatch::start();
        let layers = self.look_at(&small, method, spp).layers(self.world, self.wanted());
        let finds_guides = self.features.is_empty() && method.finds_guides();
        let looking = if finds_guides { 0.0 } else { watch.elapsed().wall_seconds };
        let mut denoising = 0.0;
        let guides = guides(&layers);
        let Some(color) = guides.albedo else { return FinishingTime::default() };
        // The first picture of a device takes longer, whatever its size.
        let quality = self.quality.unwrap_or_default();
        for _ in 0..2 {
            let watch = Stopwatch::start();
            if let Err(error) = denoiser.denoise(color, &guides, quality) {
                self.failure.get_or_init(|| error);
            }
            denoising = watch.elapsed().wall_seconds;
        }
        let [all, few] = [self.view, &small].map(|view| view.window.pixel_count() as f64);
        let a_sample = looking / (few * f64::from(spp));
        denoising *= all / few;
        if self.quality.is_none() {
            let looking = a_sample * all * f64::from(method.spp());
            let likely = effort::for_work(within - looking - denoising, denoising);
            denoising *= effort::relative_price(likely);
        }
        FinishingTime { denoising, a_sample }
    }
}

/// Albedo and normals among the layers of features.
fn guides(layers: &[Layer]) -> Guides<'_> {
    let image = |feature: Feature| -> Option<&Image> {
        layers.iter().find(|layer| layer.name == feature.name()).and_then(Layer::triples)
    };
    Guides { albedo: image(Feature::Albedo), normal: image(Feature::Normal), noise_free: true }
}
