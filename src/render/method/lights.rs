//! Virtual lights of a scene, which methods over them share: the light pass, its trees, and the store that
//! keeps them from frame to frame.

use super::kept::kept;
use super::photon_store::PhotonStore;
use crate::method::Sampling;
use base::progress::Control;
use base::stats::{Stage, Stats};
use std::sync::{Arc, Mutex};
use transport::bias_compensation::Compensation;
use transport::bias_compensation::intensities::Intensities;
use transport::light_tree::{Family, LightTrees};
use transport::lightcut::Transfer;
use transport::shade::ShadingContext;
use transport::vpl::{LightPassSettings, light_pass, min_dist_sq, near_sq_of_size};
use world::{SurfacePoint, World};

/// Facts that virtual lights depend on, besides the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightsWanted {
    /// Numbers of VPLs and the seed.
    pub pass: LightPassSettings,
    /// Builder of the trees.
    pub family: Family,
    /// Longest path in edges.
    pub max_depth: u32,
}

impl LightsWanted {
    /// Lights by the builder and the numbers of `settings`, with the seed and the path limit of the eye samples.
    pub fn new(world: &World, sampling: Sampling, settings: (LightPassSettings, Family)) -> LightsWanted {
        let (numbers, family) = settings;
        let pass = LightPassSettings { seed: sampling.seed, ..numbers };
        LightsWanted { pass, family, max_depth: world.scene.path_limit(sampling.max_depth) }
    }
}

/// Facts that virtual lights depend on, and the points whose indirect light is wanted: of all where there are none.
type LightsFor = (LightsWanted, Vec<SurfacePoint>);

/// Virtual lights and photons, kept from frame to frame: those made last, for as long as the same are wanted.
#[derive(Default)]
pub struct LightStore {
    lights: Mutex<Option<(LightsFor, Arc<Lights>)>>,
    /// Photons by mirrors and glass.
    pub photons: PhotonStore,
}

impl LightStore {
    /// Returns the lights of `world`, for the indirect light of the points `seen` or of all if there are none; made
    /// anew if others were made last. Lights are not kept if `control` is cancelled while they are made.
    pub fn get(
        &self,
        world: &World,
        (wanted, seen): (LightsWanted, Vec<SurfacePoint>),
        control: &Control,
        stats: &mut Stats,
    ) -> Arc<Lights> {
        let make = |(wanted, seen): &LightsFor| Lights::new(world, (wanted, seen), control, stats);
        kept(&self.lights, (wanted, seen), control, make)
    }
}

/// Virtual lights of a scene.
pub struct Lights {
    /// The trees over them.
    pub trees: LightTrees,
    /// Squared distance below which a point cannot represent the patch around it, by mesh; 0 for meshes that
    /// do not emit.
    near_sq: Vec<f32>,
    /// `None` if no light is indirect.
    intensities: Option<Intensities>,
    diagonal: f32,
    /// Of the short rays' directions.
    seed: u32,
}

impl Lights {
    /// Makes them; stops early if `control` is cancelled.
    fn new(
        world: &World,
        (wanted, seen): (&LightsWanted, &[SurfacePoint]),
        control: &Control,
        stats: &mut Stats,
    ) -> Lights {
        control.begin(Stage::LightPass, u64::from(wanted.pass.indirect));
        let pass = || light_pass(world, &wanted.pass, seen, wanted.max_depth, control);
        let found = stats.time(Stage::LightPass, pass);
        stats.count("VPLs/total", found.len() as u64);
        stats.count("VPLs/photon paths", found.photons.paths);
        if found.photons.gain > 0.0 {
            stats.add("VPLs/gain of aims", found.photons.gain.into());
        }
        stats.count("Rays/closest hit", found.photons.rays);

        control.begin(Stage::Tree, 0);
        let build = || {
            let intensities = Intensities::new(&found.sets, &found.profiles);
            let trees =
                LightTrees::build(&found.sets, found.profiles, world.diagonal, wanted.family, control);
            (trees, intensities)
        };
        let (trees, intensities) = stats.time(Stage::Tree, build);
        let least_sq = min_dist_sq(world.diagonal);
        let near_sq = |&size: &u32| if size > 0 { near_sq_of_size(size, least_sq) } else { 0.0 };
        let near_sq = found.sizes.iter().map(near_sq).collect();
        Lights { trees, near_sq, intensities, diagonal: world.diagonal, seed: wanted.pass.seed }
    }

    /// Transfer from the lights to a point; `compensated` where short rays find the light lost close to them.
    pub fn transfer(&self, compensated: bool) -> Transfer<'_> {
        Transfer { patches: compensated, ..Transfer::new(&self.trees, self.diagonal) }
    }

    /// Context for shading by the lights; with `compensated`, light lost close to them is found by short rays.
    pub fn context<'a>(&'a self, world: &'a World, compensated: bool) -> ShadingContext<'a> {
        let compensation = compensated.then(|| self.compensation(world));
        ShadingContext { world, transfer: self.transfer(compensated), compensation }
    }

    /// Compensation for light lost close to the lights.
    pub fn compensation<'a>(&'a self, world: &'a World) -> Compensation<'a> {
        Compensation::new(world, self.transfer(true), self.intensities.as_ref(), &self.near_sq, self.seed)
    }
}
