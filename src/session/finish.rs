//! From a method's output to the picture that is kept: features beside it, and its noise taken off.

use super::goal::Goal;
use crate::denoise::{DenoiseError, Denoiser, Guides, NOISY};
use crate::eye::{Feature, FeatureSettings, Features, features};
use crate::film::{Image, Layer};
use crate::method::{Method, Output};
use crate::plan::smaller;
use crate::progress::Control;
use crate::stats::{Stage, Stats, Stopwatch};
use crate::view::View;
use crate::world::World;
use std::cell::OnceCell;

/// Divisor of each side of the picture that estimates how long finishing takes.
const TRIAL_SCALE: u32 = 4;

/// The features and the denoiser that a goal asks for, for pictures of one view.
pub(crate) struct Finish<'a> {
    world: &'a World,
    view: &'a View,
    control: &'a Control,
    /// Features that are kept.
    features: Features,
    keep_noisy: bool,
    denoiser: Option<Denoiser>,
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
        let Goal { features, keep_noisy, .. } = *goal;
        Finish { world, view, control, features, keep_noisy, denoiser, failure }
    }

    /// Reason why a picture is not denoised though it was asked for.
    pub fn failure(&self) -> Option<&DenoiseError> {
        self.failure.get()
    }

    /// Name and version of the library that denoises; `None` if it was not asked for, or failed.
    pub fn denoised_by(&self) -> Option<String> {
        self.denoiser().map(Denoiser::name)
    }

    fn denoiser(&self) -> Option<&Denoiser> {
        self.denoiser.as_ref().filter(|_| self.failure.get().is_none())
    }

    /// Adds the features of the method's own eye samples to its picture, and denoises that, where it is complete. The
    /// times are the output's.
    pub fn apply(&self, method: &Method, output: &mut Output) {
        let denoiser = self.denoiser();
        let mut wanted = self.features;
        if denoiser.is_some() {
            wanted = wanted.with(Feature::Albedo).with(Feature::Normal);
        }
        if wanted.is_empty() || !output.complete {
            return;
        }
        let mut layers = output.stats.time(Stage::EyePass, || self.layers(self.view, method, wanted));
        output.complete &= !self.control.is_cancelled();
        if !output.complete {
            return;
        }
        if let Some(denoiser) = denoiser {
            self.control.begin(Stage::Denoise, 0);
            output.nonfinite += output.color.remove_nonfinite();
            match output.stats.time(Stage::Denoise, || denoiser.denoise(&output.color, &guides(&layers))) {
                Ok(clean) => {
                    let noisy = std::mem::replace(&mut output.color, clean);
                    output.extra.extend(self.keep_noisy.then(|| Layer::color(NOISY, noisy)));
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
    }

    /// Seconds that [`Finish::apply`] is likely to take for a picture of `method`, by that of a smaller one.
    pub fn expected_seconds(&self, method: &Method) -> f64 {
        let Some(denoiser) = self.denoiser() else { return 0.0 };
        let small = smaller(self.view, TRIAL_SCALE);
        let watch = Stopwatch::start();
        let layers =
            self.layers(&small, method, Features::default().with(Feature::Albedo).with(Feature::Normal));
        let mut seconds = watch.elapsed().wall_seconds;
        let guides = guides(&layers);
        let Some(color) = guides.albedo else { return 0.0 };
        // The first picture of a device takes longer, whatever its size.
        for is_first in [true, false] {
            let watch = Stopwatch::start();
            if let Err(error) = denoiser.denoise(color, &guides) {
                self.failure.get_or_init(|| error);
            }
            seconds += if is_first { 0.0 } else { watch.elapsed().wall_seconds };
        }
        seconds * self.view.window.pixel_count() as f64 / small.window.pixel_count() as f64
    }

    fn layers(&self, view: &View, method: &Method, wanted: Features) -> Vec<Layer> {
        let settings = FeatureSettings { look: method.look(), spp: method.spp(), seed: method.seed() };
        features(self.world, view, &settings, wanted, self.control)
    }
}

/// Albedo and normals among the layers of features.
fn guides(layers: &[Layer]) -> Guides<'_> {
    let image = |feature: Feature| -> Option<&Image> {
        layers.iter().find(|layer| layer.name == feature.name()).and_then(Layer::triples)
    };
    Guides { albedo: image(Feature::Albedo), normal: image(Feature::Normal), noise_free: true }
}
