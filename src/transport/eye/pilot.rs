//! Pilot of the eye pass with direct light: some pixels are sampled twice, independently. Plans estimate the noise of
//! the pass from the differences.

use super::tracer::Tracer;
use super::{EyeCounts, EyePass, EyeSettings, LightSources};
use crate::paths::RayCounts;
use base::progress::Control;
use world::World;
use world::view::View;

/// Seeds of the two sets of samples, combined with the seed of the settings.
const SEEDS: [u32; 2] = [0x7ab3_11d5, 0x0c94_e2f7];

/// Light that photons find in a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct ByPhotons {
    /// Mean luminance.
    pub mean: f64,
    /// Mean square of the luminance that paths would find instead.
    pub square: f64,
}

/// Light that the eye pass finds in some pixels.
pub struct EyePilot {
    /// Mean luminances of groups of pixels, by each of the two sets of samples; 0 once cancelled.
    pub luminances: [Vec<Vec<f32>>; 2],
    /// Light of photons by group, over all samples.
    pub photons: Vec<ByPhotons>,
    /// Rays of the samples.
    pub sampled: EyeCounts,
    /// Rays of the pilot before.
    pub before: RayCounts,
}

impl EyePass<'_> {
    /// Samples groups of film pixels as [`EyePass::with_direct_light`] does with the same number of samples per pixel.
    pub fn pilot(
        world: &World,
        view: &View,
        settings: EyeSettings,
        sources: LightSources,
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> EyePilot {
        let mut counts = RayCounts::default();
        let tracer = Tracer::new(world, view, settings, sources, control, &mut counts);
        let mut traced = vec![EyeCounts::default(); groups.len()];
        let luminances = SEEDS.map(|seed| {
            let (values, chains) = tracer.luminances(groups.to_vec(), settings.seed ^ seed);
            traced.iter_mut().zip(chains).for_each(|(sum, chains)| *sum += chains);
            values.into_iter().map(|group| group.into_iter().map(|[mean, _]| mean).collect()).collect()
        });
        let by_photons = |(group, chains): (&Vec<_>, &EyeCounts)| {
            let samples = (SEEDS.len() * group.len().max(1)) as f64 * f64::from(settings.spp.max(1));
            ByPhotons { mean: chains.by_photons / samples, square: chains.square_by_photons / samples }
        };
        let photons = groups.iter().zip(&traced).map(by_photons).collect();
        EyePilot { luminances, photons, sampled: traced.into_iter().sum(), before: counts }
    }
}
