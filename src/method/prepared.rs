//! A picture that lacks but its lighting: the beginning of all methods that light the samples of an eye pass.

use super::lights::{LightStore, Lights, LightsWanted};
use super::{Sampling, counts};
use crate::eye::{DrawnLight, EyePass};
use crate::light_tree::Family;
use crate::progress::Control;
use crate::stats::{Stage, Stats};
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;
use std::sync::Arc;

/// Shading points and virtual lights: all of a picture but its lighting.
pub struct Prepared<'w> {
    /// Visibility samples and the points to shade.
    pub eye: EyePass<'w>,
    /// The virtual lights.
    pub lights: Arc<Lights>,
    /// Counters and times so far.
    pub stats: Stats,
}

impl<'w> Prepared<'w> {
    /// Runs the light pass, unless `lights` holds what it would make, and the eye pass.
    pub fn new(
        world: &'w World,
        lights: &LightStore,
        view: &View,
        (sampling, drawn): (Sampling, Option<DrawnLight>),
        wanted: (LightPassSettings, Family),
        control: &Control,
    ) -> Prepared<'w> {
        let mut stats = Stats::new();
        let rays = sampling.eye(&world.scene);
        let wanted = LightsWanted::new(world, sampling, wanted);
        let caustics = lights.caustics((world, view), (sampling.seed, rays.max_depth), control, &mut stats);
        control.begin(Stage::EyePass, view.window.tile_count(16) as u64);
        let eye = stats.time(Stage::EyePass, || {
            EyePass::of(world, view, rays, (drawn.as_ref(), caustics.as_ref()), control)
        });
        counts::eye(&mut stats, &eye.chains);
        if drawn.is_some() {
            stats.count("Eye/light samples", eye.light_samples.into());
        }
        // Afterwards, since most memory is taken where the eye pass is put in order.
        let lights = lights.get(world, wanted, control, &mut stats);
        Prepared { eye, lights, stats }
    }
}
