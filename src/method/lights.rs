//! The stages that methods over virtual lights share: the light pass and its trees.

use crate::bias_compensation::Compensation;
use crate::light_tree::{Family, LightTrees};
use crate::lightcut::Transfer;
use crate::progress::Control;
use crate::shade::ShadingContext;
use crate::stats::{Stage, Stats};
use crate::vpl::{LightPassSettings, light_pass, min_dist_sq, near_sq_of_size};
use crate::world::World;

/// A scene's virtual lights.
pub struct Lights {
    /// The trees over them.
    pub trees: LightTrees,
    /// Squared distance below which a point cannot represent the patch around it, by mesh; 0 for meshes that
    /// do not emit.
    near_sq: Vec<f32>,
    diagonal: f32,
}

impl Lights {
    /// Makes them for paths of at most `max_depth` edges; stops early if `control` is cancelled.
    pub fn new(
        world: &World,
        settings: &LightPassSettings,
        family: Family,
        max_depth: u32,
        control: &Control,
        stats: &mut Stats,
    ) -> Lights {
        control.begin(Stage::LightPass, u64::from(settings.indirect));
        let found = stats.time(Stage::LightPass, || light_pass(world, settings, max_depth, control));
        stats.count("VPLs/total", found.len() as u64);
        stats.count("VPLs/photon paths", found.photons.paths);
        stats.count("Rays/closest hit", found.photons.rays);

        control.begin(Stage::Tree, 0);
        let build = || LightTrees::build(&found.sets, found.spots, world.diagonal, family);
        let trees = stats.time(Stage::Tree, build);
        let least_sq = min_dist_sq(world.diagonal);
        let near_sq = |&size: &u32| if size > 0 { near_sq_of_size(size, least_sq) } else { 0.0 };
        Lights { trees, near_sq: found.sizes.iter().map(near_sq).collect(), diagonal: world.diagonal }
    }

    /// Returns the transfer of their light to a point; `compensated` where short rays compensate clamping
    /// close to lights.
    pub fn transfer(&self, compensated: bool) -> Transfer<'_> {
        Transfer { patches: compensated, ..Transfer::new(&self.trees, self.diagonal) }
    }

    /// Returns the inputs of shading; with `compensated` for light close to virtual lights too.
    pub fn context<'a>(&'a self, world: &'a World, compensated: bool) -> ShadingContext<'a> {
        let compensation = compensated.then(|| self.compensation(world));
        ShadingContext { world, transfer: self.transfer(compensated), compensation }
    }

    /// Returns the inputs of its compensation.
    pub fn compensation<'a>(&'a self, world: &'a World) -> Compensation<'a> {
        Compensation::new(world, self.transfer(true), &self.near_sq)
    }
}
