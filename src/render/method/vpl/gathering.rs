//! Indirect light by final gathering over a photon map.

use crate::method::Sampling;
use crate::method::tally::Tally;
use base::math::Rgb;
use base::progress::Control;
use base::setting::settings;
use base::stats::Stage;
use rayon::prelude::*;
use transport::emission::PhotonSettings;
use transport::eye::EyePass;
use transport::irradiance::{IrradianceMap, PhotonMap};
use transport::lights::Origin;
use transport::photon::indirect_light::GatherCounts;
use transport::photon::own::{SampleGather, reflected};
use transport::photon::records::FinalGatherSource;
use transport::shade::{Reflected, ShadingTask};
use world::World;

/// Memory of a photon and its place in the map, in bytes.
const PHOTON_BYTES: u64 = 180;

settings! {
    /// Settings of a photon map and of final gathering.
    pub struct GatheringSettings in "Photon map" {
        /// Approximate number of photons on diffuse surfaces.
        photons: u32 = 600_000 => [];
        /// Number of photons per estimate of irradiance, at least 16. More photons increase bias and reduce variance.
        nearest: usize = 64 => [.at_least(16.0)];
        /// Approximate number of final gathering rays per record.
        rays: u32 = 2000 => [.named("gather_rays").range(16.0, 1e6)];
        /// Number of final gathering rays per sample without a record.
        own_rays: u32 = 64 => [.named("sample_rays").range(1.0, 1e6)];
    }
}

impl GatheringSettings {
    /// Returns the approximate memory of the photons, in bytes.
    pub fn expected_bytes(&self) -> u64 {
        u64::from(self.photons) * PHOTON_BYTES
    }

    /// Traces photons, and returns a map of their irradiance.
    pub fn irradiance(
        &self,
        world: &World,
        sampling: Sampling,
        control: &Control,
        tally: &mut Tally,
    ) -> IrradianceMap {
        // One edge is the eye's, another that of the gathering.
        let max_edges = world.scene.path_limit(sampling.max_depth).saturating_sub(2);
        let wanted = PhotonSettings { photons: self.photons, seen: &[], max_edges, seed: sampling.seed };
        control.begin(Stage::LightPass, u64::from(self.photons));
        let photons = tally.time(Stage::LightPass, || PhotonMap::new(world, &wanted, control));
        tally.count("Photons/total", photons.photons.len() as u64);
        tally.count("Photons/paths", photons.counts.paths);
        tally.rays(photons.counts.rays);
        control.begin(Stage::Tree, 0);
        let estimate = || IrradianceMap::of_photons(world, &photons, self.nearest, control);
        let (map, rays) = tally.time(Stage::Tree, estimate);
        tally.count("Photons/estimates of irradiance", map.len() as u64);
        tally.rays(rays);
        map
    }

    /// Gathers indirect light at samples without records.
    pub fn gather(
        &self,
        source: &FinalGatherSource,
        eye: &EyePass,
        tasks: &[ShadingTask],
        seed: u32,
        control: &Control,
    ) -> (Vec<Reflected>, GatherCounts) {
        let gather = |&ShadingTask { point, lobe_only, .. }: &ShadingTask| {
            let (mut counts, mut radiance) = (GatherCounts::default(), Rgb::ZERO);
            if !control.is_cancelled() {
                let task = SampleGather { sample: point, lobe_only, rays: self.own_rays, seed };
                radiance = reflected(&source.light, eye, &task, &mut counts);
                control.advance(1);
            }
            (Reflected { point, origin: Some(Origin::Indirect), radiance }, counts)
        };
        let gathered: Vec<(Reflected, GatherCounts)> = tasks.par_iter().map(gather).collect();
        let mut counts = *source.counts();
        gathered.iter().for_each(|(_, used)| counts += *used);
        (gathered.into_iter().map(|(light, _)| light).collect(), counts)
    }
}

/// Divides tasks into those of direct light and those of indirect light.
pub fn by_origin(tasks: &[ShadingTask]) -> [Vec<ShadingTask>; 2] {
    [(Origin::Direct, Origin::Indirect), (Origin::Indirect, Origin::Direct)].map(|(origin, other)| {
        let wanted = tasks.iter().filter(|task| task.origin != Some(other));
        wanted.map(|task| ShadingTask { origin: Some(origin), ..*task }).collect()
    })
}
