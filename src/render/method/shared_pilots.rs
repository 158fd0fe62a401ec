//! Pilots of the eye pass that all views of a list share. They are run before the first view.

use super::memo::{Memo, recall};
use super::tally::Tally;
use base::progress::Control;
use base::stats::Stage;
use std::sync::Arc;
use transport::eye::{DirectSampling, EyePilots, EyeSettings};
use world::World;
use world::view::View;

/// Settings on which the pilots depend: samples, seed, path length, and the materials whose lobes are followed.
type PilotKey = (u32, u32, u32, Vec<bool>);

/// Views of a list and their pilots.
#[derive(Default)]
pub struct SharedPilots {
    views: Vec<View>,
    /// Mean number of these views that see a surface.
    overlap: f32,
    /// Pilots of the last settings; `None` if each view has its own.
    found: Memo<PilotKey, Option<Arc<EyePilots>>>,
}

impl SharedPilots {
    /// Returns the pilots of `views`. In the mean `overlap` of them see a surface.
    pub fn new(views: Vec<View>, overlap: f32) -> SharedPilots {
        SharedPilots { views, overlap, found: Memo::default() }
    }

    /// Returns the pilots for these settings, and runs them unless they are known; `None` if each view has its own.
    pub fn get(
        &self,
        world: &World,
        settings: EyeSettings,
        direct: &DirectSampling,
        control: &Control,
        tally: &mut Tally,
    ) -> Option<Arc<EyePilots>> {
        let EyeSettings { spp, seed, max_depth } = settings;
        let key = (spp, seed, max_depth, direct.followed.clone());
        let found = recall(&self.found, key, control, |_| {
            let run = || EyePilots::of_views(world, &self.views, settings, direct, self.overlap, control);
            let pilots = tally.time(Stage::EyePass, run)?;
            let chains = pilots.chains();
            tally.rays(chains.rays);
            tally.shadow_rays("Eye/shadow rays of shared pilots", chains.shadow_rays);
            Some(Arc::new(pilots))
        });
        Option::clone(&found)
    }
}
