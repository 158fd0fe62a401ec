//! Store of virtual lights and photons, which methods share from frame to frame.

use super::kept::kept;
use super::photon_store::PhotonStore;
use crate::method::Sampling;
use base::progress::Control;
use base::stats::Stats;
use std::sync::{Arc, Mutex};
use transport::lights::{Family, LightPassSettings, Lights, LightsWanted};
use world::{SurfacePoint, World};

/// Returns the parameters of virtual lights for the indirect light of the points `seen` (if empty, of all points).
/// Numbers and builder are those of `settings`, seed and path limit those of `sampling`.
pub fn lights_wanted(
    world: &World,
    sampling: Sampling,
    settings: (LightPassSettings, Family),
    seen: Vec<SurfacePoint>,
) -> LightsWanted {
    let (numbers, family) = settings;
    let pass = LightPassSettings { seed: sampling.seed, ..numbers };
    LightsWanted { pass, family, max_depth: world.scene.path_limit(sampling.max_depth), seen }
}

/// Virtual lights and photons. Both are kept until others are wanted.
#[derive(Default)]
pub struct LightStore {
    lights: Mutex<Option<(LightsWanted, Arc<Lights>)>>,
    /// Photons of caustics.
    pub photons: PhotonStore,
}

impl LightStore {
    /// Returns the virtual lights of `world`. Makes them anew if others were wanted last. Does not keep them if
    /// `control` is cancelled while they are made.
    pub fn get(
        &self,
        world: &World,
        wanted: LightsWanted,
        control: &Control,
        stats: &mut Stats,
    ) -> Arc<Lights> {
        kept(&self.lights, wanted, control, |wanted| Lights::new(world, wanted, control, stats))
    }
}
