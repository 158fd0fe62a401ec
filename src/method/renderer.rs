//! The trait of methods.

use super::ladder::Move;
use super::lights::LightStore;
use super::{Method, Output, Sampled};
use crate::film::Window;
use crate::paths::Look;
use crate::progress::Control;
use crate::setting::Settings;
use crate::stats::StageTime;
use crate::view::View;
use crate::world::World;

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

    /// Rejects settings that contradict each other.
    ///
    /// # Errors
    /// The contradiction and its remedy.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    /// Value that a pixel is to have.
    fn look(&self) -> Look {
        let sampling = self.sampling();
        Look::EyeSamples { spp: sampling.spp, seed: sampling.seed }
    }

    /// Memory for `window` besides the scene, where that grows with the samples.
    fn expected_bytes(&self, _window: &Window) -> Option<u64> {
        None
    }

    /// Settings that qualities and plans move together; none where it is not known how.
    fn ladder(&self) -> &'static [Move] {
        &[]
    }

    /// True if [`Renderer::prepare`] makes something: where the lighting can be tried on a part of the picture.
    fn prepares(&self) -> bool {
        false
    }

    /// Makes all of the picture but its lighting.
    fn prepare<'w>(
        &self,
        _world: &'w World,
        _view: &View,
        _control: &Control,
    ) -> Option<Box<dyn Prepared + 'w>> {
        None
    }
}

/// A picture that lacks but the lighting.
pub trait Prepared {
    /// Time that the lighting would take with the settings of `method`, by one patch in `every`, or more where those
    /// would be few; `None` for another method than it was made for.
    fn lighting_time(&self, method: &Method, every: usize) -> Option<StageTime>;

    /// The picture, lit with the settings of `method`; `None` for another method than it was made for.
    fn light(self: Box<Self>, method: &Method, control: &Control) -> Option<Output>;
}
