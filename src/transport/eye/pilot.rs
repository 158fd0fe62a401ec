//! A few pixels of the eye pass with direct light, each sampled twice, independently: from their differences plans
//! learn how noisy the pass is.

use super::drawn::Tracer;
use super::{ChainCounts, DrawnLight, EyePass, EyeSettings};
use crate::caustics::Caustics;
use crate::paths::Counts;
use base::progress::Control;
use world::World;
use world::view::View;

/// Seeds of the two sets of samples over that of the settings.
const SEEDS: [u32; 2] = [0x7ab3_11d5, 0x0c94_e2f7];

/// Divisor of the number of paths by which emitters are learned: fewer do for a few pixels.
const FEWER: u64 = 4;

/// Light that photons find in a pixel, where paths find little.
#[derive(Clone, Copy, Debug, Default)]
pub struct ByPhotons {
    /// Mean luminance.
    pub mean: f64,
    /// Mean square of the luminance that paths find in its place.
    pub square: f64,
}

/// Light that the eye pass finds in some pixels.
pub struct EyePilot {
    /// Mean luminances of groups of pixels, by each of the two sets of samples; 0 where cancelled.
    pub luminances: [Vec<Vec<f32>>; 2],
    /// Light of photons by group, of all samples.
    pub photons: Vec<ByPhotons>,
    /// Rays of the samples, without those of what is learned before.
    pub sampled: ChainCounts,
    /// Rays of what is learned before.
    pub learned: ChainCounts,
}

impl EyePass<'_> {
    /// Samples groups of film pixels as [`EyePass::with_direct_light`] does with so many samples a pixel.
    pub fn pilot(
        world: &World,
        view: &View,
        settings: EyeSettings,
        (drawn, caustics): (&DrawnLight, Option<&Caustics>),
        groups: &[Vec<[u32; 2]>],
        control: &Control,
    ) -> EyePilot {
        let mut counts = Counts::default();
        let tracer = Tracer::new(world, view, settings, (drawn, caustics), control, &mut counts);
        let found = tracer.learn(settings.seed, FEWER);
        let mut learned = found.as_ref().map_or(ChainCounts::default(), |(_, chains)| *chains);
        learned.rays += counts.rays;
        learned.shadow_rays += counts.shadow_rays;
        let emitters = found.as_ref().map(|(learned, _)| learned);
        let mut traced = vec![ChainCounts::default(); groups.len()];
        let luminances = SEEDS.map(|seed| {
            let (values, chains) = tracer.luminances(groups.to_vec(), settings.seed ^ seed, emitters);
            traced.iter_mut().zip(chains).for_each(|(sum, chains)| *sum += chains);
            values.into_iter().map(|group| group.into_iter().map(|[mean, _]| mean).collect()).collect()
        });
        let by_photons = |(group, chains): (&Vec<_>, &ChainCounts)| {
            let samples = (SEEDS.len() * group.len().max(1)) as f64 * f64::from(settings.spp.max(1));
            ByPhotons { mean: chains.by_photons / samples, square: chains.square_by_photons / samples }
        };
        let photons = groups.iter().zip(&traced).map(by_photons).collect();
        EyePilot { luminances, photons, sampled: traced.into_iter().sum(), learned }
    }
}
