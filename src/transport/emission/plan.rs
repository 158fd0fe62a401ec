//! Plan of photon tracing: shares of the paths by emitter.

use super::contributions;
use super::{EmissionNumbers, EmissionSample, PhotonEmitter};
use base::sampling::Sampler;
use world::SurfacePoint;
use world::light::DiscreteDistribution;

/// Plan for the photons of a scene. Flux is unbiased for any plan.
pub(super) struct EmitterPlan {
    /// Emitters in proportion to their numbers of paths.
    by_paths: DiscreteDistribution,
}

impl EmitterPlan {
    /// Plans the photons for the indirect light of the points `seen`. Shares are in proportion to the contributions of
    /// emitters to these points, or to power if that is nearly as good.
    pub fn new(emitter: &PhotonEmitter, seen: &[SurfacePoint], seed: u32) -> EmitterPlan {
        let by_power = &emitter.by_power;
        let shares = contributions::shares(emitter.world, by_power, seen, seed);
        EmitterPlan { by_paths: shares.unwrap_or_else(|| by_power.clone()) }
    }

    /// Samples the beginning of a path; `None` if the emitter is dark there.
    pub fn sample(&self, emitter: &PhotonEmitter, sampler: &mut Sampler) -> Option<EmissionSample> {
        let (index, _) = self.by_paths.sample(sampler.next_1d());
        let numbers = EmissionNumbers::new(sampler);
        emitter.begin(index, 1.0 / self.by_paths.probability(index), &numbers)
    }
}
