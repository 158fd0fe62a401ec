//! The stages that methods over virtual lights share: the light pass and its trees.

use super::Control;
use crate::light_tree::{Family, LightTrees};
use crate::lightcut::Transfer;
use crate::stats::{Stage, Stats};
use crate::vpl::{LightPassSettings, light_pass};
use crate::world::World;

/// A scene's virtual lights.
pub struct Lights {
    /// The trees over them.
    pub trees: LightTrees,
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
        Lights { trees: stats.time(Stage::Tree, build), diagonal: world.diagonal }
    }

    /// What reaches a point from them.
    pub fn transfer(&self) -> Transfer<'_> {
        Transfer::new(&self.trees.spots, self.diagonal)
    }
}
