//! Store of virtual lights, photons and learned light, which methods share from frame to frame.

use super::photon_store::{Memo, PhotonStore, forget, recall, recall_own};
use super::tally::Tally;
use crate::method::Sampling;
use base::progress::Control;
use base::stats::Stage;
use std::sync::Arc;
use transport::eye::EyeSettings;
use transport::irradiance::{EndsWanted, PathEnds};
use transport::learning::{LearnedLight, Learning};
use transport::lights::{LightPassSettings, Lights, LightsWanted};
use world::view::View;
use world::{SurfacePoint, World};

/// Returns the parameters of virtual lights for the indirect light of the points `seen`; of all points if it is empty.
///
/// Seed and path limit are those of the eye samples.
pub fn lights_wanted(
    world: &World,
    sampling: Sampling,
    numbers: LightPassSettings,
    seen: Vec<SurfacePoint>,
) -> LightsWanted {
    let pass = LightPassSettings { seed: sampling.seed, ..numbers };
    LightsWanted { pass, max_depth: world.scene.path_limit(sampling.max_depth), seen }
}

/// Virtual lights, photons and learned light of the last frame. Frames reuse them if they want the same ones.
#[derive(Default)]
pub struct LightStore {
    lights: Memo<LightsWanted, Lights>,
    learned: Memo<Learning, LearnedLight>,
    path_ends: Memo<EndsWanted, PathEnds>,
    /// Caustic photons.
    pub photons: PhotonStore,
}

impl LightStore {
    /// Drops all lights and photons.
    pub fn forget(&self) {
        forget(&self.lights);
        forget(&self.learned);
        forget(&self.path_ends);
        self.photons.forget();
    }

    /// Returns what is learned of the light in a view for images with `spp` samples per pixel.
    pub fn learned(&self, world: &World, view: &View, spp: u32, control: &Control) -> Arc<LearnedLight> {
        let wanted = Learning::new(view, spp);
        recall_own(&self.learned, wanted, control, |wanted| wanted.learn(world, view, control))
    }

    /// Returns the light by which the paths of a view's image end at diffuse surfaces; `None` if they go on.
    pub fn path_ends(
        &self,
        world: &World,
        view: &View,
        settings: EyeSettings,
        control: &Control,
        tally: &mut Tally,
    ) -> Option<Arc<PathEnds>> {
        let EyeSettings { seed, max_depth, spp } = settings;
        let samples = view.window.film_pixel_count().saturating_mul(spp.into());
        let wanted = EndsWanted::new(samples, max_depth, seed)?;
        let make = |wanted: &EndsWanted| PathEnds::new(world, *wanted, control);
        let ends = tally.time(Stage::LightPass, || recall_own(&self.path_ends, wanted, control, make));
        tally.count("Eye/photon paths", ends.paths);
        tally.rays(ends.rays);
        Some(ends)
    }

    /// Returns the virtual lights of `world`, and makes them if others were made last.
    ///
    /// Lights are not stored if `control` is cancelled while they are made.
    pub fn get(
        &self,
        world: &World,
        wanted: LightsWanted,
        control: &Control,
        tally: &mut Tally,
    ) -> Arc<Lights> {
        recall(&self.lights, wanted, control, |wanted| {
            let lights = Lights::new(world, wanted, control, &mut tally.stats);
            tally.work.vpls += lights.vpls;
            tally.work.rays += lights.rays;
            lights
        })
    }
}
