//! Traits of methods: the abilities of every method, and those of some, with their results. An ability of few methods
//! has a default.

use super::lights::LightStore;
use super::outlook::Outlook;
use super::path::PartialImage;
use super::sampling::HasSampling;
use super::scale::{Demand, Move};
use super::tally::Tally;
use crate::cost::Work;
use crate::denoise::effort::Sampled;
use crate::denoise::{DenoiseError, Quality};
use base::film::{Image, Layer, Window};
use base::progress::Control;
use base::setting::Settings;
use base::stats::Stats;
use transport::eye::{ByPhotons, Settled};
use transport::paths::Estimand;
use transport::perception::Thresholds;
use transport::radiance_cache::retained::RetainedRecords;
use world::World;
use world::view::View;

/// A method with its settings.
pub trait Renderer: Settings + HasSampling {
    /// Returns the name on the command line.
    fn name(&self) -> &'static str;

    /// Returns a line for `--help`.
    fn about(&self) -> &'static str;

    /// Renders the image of `view`. The image is partial if `control` is cancelled.
    ///
    /// `lights` holds virtual lights and photons from frame to frame.
    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output;

    /// Rejects settings that contradict each other.
    ///
    /// # Errors
    /// The contradiction and its remedy.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    /// Returns the quantity that a pixel estimates.
    fn estimand(&self) -> Estimand {
        let sampling = self.sampling();
        Estimand::EyeSamples { spp: sampling.spp, seed: sampling.seed }
    }

    /// Returns the approximate memory of a render of `window`, in bytes, without the scene.
    ///
    /// The memory covers all that grows with pixels, samples, virtual lights and photons.
    fn expected_bytes(&self, window: &Window) -> u64 {
        Image::expected_bytes(window)
    }

    /// True if renders return images of the records.
    fn inspects(&self) -> bool {
        false
    }

    /// True if a denoiser takes off the noise faster than further samples would. Such images are denoised by default.
    fn leaves_noise(&self) -> bool {
        false
    }

    /// True if renders return the denoiser's guides ([`Output::guides`]).
    fn finds_guides(&self) -> bool {
        false
    }

    /// Lets renders have errors that a denoiser's exceed, if that takes off noise, and return its guides.
    fn expect_denoising(&mut self) {}

    /// Returns the light that is sampled.
    fn sampled(&self) -> Sampled {
        Sampled::Part
    }

    /// Samples groups of film pixels twice, by [`PILOT_SPP`] samples per pixel, with seeds of its own. So a plan can
    /// measure noise and work.
    ///
    /// The result is `None` if the method samples no single pixels or no light, or if `control` is cancelled.
    ///
    /// [`PILOT_SPP`]: super::PILOT_SPP
    fn sample_pixels(
        &self,
        _world: &World,
        _lights: &LightStore,
        _view: &View,
        _groups: &[Vec<[u32; 2]>],
        _control: &Control,
    ) -> Option<SampledPixels> {
        None
    }

    /// Returns the factors of all settings that the quality scale moves; none if the method is not on the scale.
    fn moves(&self) -> &'static [Move] {
        &[]
    }

    /// Returns the numbers on which the work depends.
    fn demand(&self) -> Demand {
        Demand::default()
    }

    /// Returns the method as one that renders frames of walk-throughs, if it is one.
    fn as_walks(&self) -> Option<&dyn Walks> {
        None
    }

    /// Returns the method as one that resumes interrupted images, if it is one.
    fn as_resumes(&self) -> Option<&dyn Resumes> {
        None
    }
}

/// Results of the previous frames of a walk-through, or of the previous views of a list.
pub struct FormerFrames<'a> {
    /// Records of indirect light.
    pub records: &'a mut RetainedRecords,
    /// Pixels whose direct light is reprojected, so that they get fewer samples.
    pub settled: Settled,
    /// Visibility thresholds of the previous frame, if records are adapted to them.
    pub thresholds: Option<&'a Thresholds>,
    /// Surfaces that all views see, if the frames are views of their own. The frames of a film have no outlook: noise
    /// that the previous frame did not have would flicker.
    pub outlook: Option<&'a Outlook>,
}

/// A method that renders frames of a walk-through with the records of previous frames.
pub trait Walks {
    /// Renders the next frame, and adds its records to those of `former`.
    fn render_next(
        &self,
        world: &World,
        lights: &LightStore,
        former: FormerFrames,
        view: &View,
        control: &Control,
    ) -> Output;
}

/// A method that resumes interrupted images.
pub trait Resumes {
    /// Renders the missing samples of `partial`, an image of the same settings and `view`.
    ///
    /// The result has the bits of an image that was not interrupted.
    fn render_rest(
        &self,
        world: &World,
        lights: &LightStore,
        partial: &PartialImage,
        view: &View,
        control: &Control,
    ) -> Output;
}

/// Renders one image of `view` with virtual lights of its own.
pub fn render(world: &World, view: &View, settings: &impl Renderer, control: &Control) -> Output {
    settings.render(world, &LightStore::default(), view, control)
}

/// Samples per pixel of each of the two sets.
pub const PILOT_SPP: u32 = 8;

/// Light of some pixels by two independent sets of [`PILOT_SPP`] samples each.
pub struct SampledPixels {
    /// Mean luminance of each pixel, in order, by set.
    pub luminances: [Vec<f64>; 2],
    /// Light that the method finds with photons, by group of pixels; empty if it has no photons.
    pub photons: Vec<ByPhotons>,
    /// Rays per sample.
    pub rays_a_sample: f64,
    /// All rays traced, without those of learned light, which the image shares.
    pub rays: u64,
}

impl SampledPixels {
    /// Creates the light of samples that took `rays_of_samples`, besides `other_rays` of other pilots.
    pub fn new(luminances: [Vec<f64>; 2], rays_of_samples: u64, other_rays: u64) -> SampledPixels {
        let samples = 2.0 * f64::from(PILOT_SPP) * luminances[0].len().max(1) as f64;
        let rays = rays_of_samples + other_rays;
        SampledPixels {
            luminances,
            photons: Vec::new(),
            rays_a_sample: rays_of_samples as f64 / samples,
            rays,
        }
    }
}

/// Result of rendering one frame. All images have the size of the rendered window.
#[derive(Clone, Debug)]
pub struct Output {
    /// Radiance per pixel.
    pub color: Image,
    /// Variance of the pixel mean in `color`, per channel, if the method can estimate it.
    pub variance: Option<Image>,
    /// Further images.
    pub extra: Vec<Layer>,
    /// Features of the surfaces seen by all samples, to guide a denoiser; empty if the method finds none.
    pub guides: Vec<Layer>,
    /// Layers from which a partial image can be resumed; empty if the method cannot resume.
    pub resumable: Vec<Layer>,
    /// Counters and times, for reports.
    pub stats: Stats,
    /// Work that the image took, on which later stages depend.
    pub work: Work,
    /// Quality of denoising, or the reason why it failed; `None` if the image was not denoised.
    pub denoised: Option<Result<Quality, DenoiseError>>,
    /// False if the method was cancelled: the image is partial.
    pub complete: bool,
    /// Samples that were not finite and were dropped. Anything but 0 is a defect that should be reported.
    pub nonfinite: u64,
}

impl Output {
    /// Creates a complete image without further layers.
    pub(super) fn new(color: Image, tally: Tally) -> Output {
        Output {
            color,
            variance: None,
            extra: Vec::new(),
            guides: Vec::new(),
            resumable: Vec::new(),
            stats: tally.stats,
            work: tally.work,
            denoised: None,
            complete: true,
            nonfinite: 0,
        }
    }
}
