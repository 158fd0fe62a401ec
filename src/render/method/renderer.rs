//! The trait of methods.

use super::ladder::Move;
use super::lights::LightStore;
use super::path::Begun;
use super::{DrawnPixels, Output, Prepared, Sampled};
use base::film::{Image, Window};
use base::progress::Control;
use base::setting::Settings;
use base::stats::StageTime;
use transport::eye::Settled;
use transport::paths::Estimand;
use transport::perception::Thresholds;
use transport::radiance_cache::retained::RetainedRecords;
use world::World;
use world::view::View;

/// Work of the frames before, in a walk-through.
pub struct Before<'a> {
    /// Records.
    pub records: &'a mut RetainedRecords,
    /// Pixels whose light is known.
    pub settled: Settled,
    /// Differences that are seen, if they are to be known.
    pub thresholds: Option<&'a Thresholds>,
}

/// A method with its settings.
pub trait Renderer: Settings + Sampled {
    /// Name on the command line.
    fn name(&self) -> &'static str;

    /// A line for `--help`.
    fn about(&self) -> &'static str;

    /// Renders the picture of `view`, until `control` is cancelled.
    ///
    /// `lights` keeps virtual lights from frame to frame.
    fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output;

    /// Renders the next frame of a walk-through: by records of the frames before, to which it adds its own, and by few
    /// samples of settled pixels. Methods without records render it alone.
    fn render_next(
        &self,
        world: &World,
        lights: &LightStore,
        _before: Before,
        view: &View,
        control: &Control,
    ) -> Output {
        self.render(world, lights, view, control)
    }

    /// Renders the rest of a picture of the same settings and `view` that was interrupted. Methods whose pictures do
    /// not go on render it anew.
    fn render_rest(
        &self,
        world: &World,
        lights: &LightStore,
        _begun: &Begun,
        view: &View,
        control: &Control,
    ) -> Output {
        self.render(world, lights, view, control)
    }

    /// True if [`Renderer::render_next`] uses records of the frames before.
    fn keeps_records(&self) -> bool {
        false
    }

    /// Rejects settings that contradict each other.
    ///
    /// # Errors
    /// The contradiction and its remedy.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    /// Has a denoiser's guides found with pictures, by methods that can.
    fn find_guides(&mut self) {}

    /// True if they come with pictures ([`Output::guides`]).
    fn finds_guides(&self) -> bool {
        false
    }

    /// Value that a pixel is to have.
    fn estimand(&self) -> Estimand {
        let sampling = self.sampling();
        Estimand::EyeSamples { spp: sampling.spp, seed: sampling.seed }
    }

    /// True if pictures have noise that a denoiser is meant to take off: faster than by more samples.
    fn leaves_noise(&self) -> bool {
        false
    }

    /// The light that the method draws at random in groups of film pixels, by [`PILOT_SPP`] samples a pixel, twice,
    /// whatever its seed; `None` if none is drawn, or if cancelled.
    ///
    /// [`PILOT_SPP`]: super::PILOT_SPP
    fn draw_pixels(
        &self,
        _world: &World,
        _lights: &LightStore,
        _view: &View,
        _groups: &[Vec<[u32; 2]>],
        _control: &Control,
    ) -> Option<DrawnPixels> {
        None
    }

    /// Memory in bytes for `window` besides the scene, about: what grows with pixels, samples, virtual lights and
    /// photons.
    fn expected_bytes(&self, window: &Window) -> u64 {
        Image::expected_bytes(window)
    }

    /// Settings that qualities and plans move together; none where it is not known how.
    fn ladder(&self) -> &'static [Move] {
        &[]
    }

    /// True if [`Renderer::prepare`] makes something: where the lighting can be tried on a part of the picture.
    fn prepares(&self) -> bool {
        false
    }

    /// Makes all of the picture but its lighting, where that can be tried on a part of it.
    fn prepare<'w>(&self, _world: &'w World, _view: &View, _control: &Control) -> Option<Prepared<'w>> {
        None
    }

    /// Time that lighting a prepared picture would take, by one patch in `every`, or more where those would be few;
    /// `None` where there is none to light.
    fn lighting_time(&self, _world: &World, _prepared: &Prepared, _every: usize) -> Option<StageTime> {
        None
    }

    /// The prepared picture, lit.
    fn light(&self, _world: &World, _prepared: Prepared, _control: &Control) -> Option<Output> {
        None
    }
}

/// Renders one picture of `view`, by virtual lights of its own.
pub fn render(world: &World, view: &View, settings: &impl Renderer, control: &Control) -> Output {
    settings.render(world, &LightStore::default(), view, control)
}
