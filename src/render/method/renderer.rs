//! Traits of methods: the abilities of every method, and those of some. An ability of few methods has a default.

use super::lights::LightStore;
use super::outlook::Outlook;
use super::path::PartialImage;
use super::sampled_pixels::SampledPixels;
use super::sampling::HasSampling;
use super::scale::{Demand, Move};
use crate::denoise::effort::Sampled;
use crate::method::Output;
use base::film::{Image, Window};
use base::progress::Control;
use base::setting::Settings;
use transport::eye::Settled;
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

    /// Makes renders return a denoiser's guides, if the method can.
    fn find_guides(&mut self) {}

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
