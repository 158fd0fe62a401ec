//! Plan of photon tracing: shares of the paths by emitter, and aims of paths from infinitely far.

use super::openings::Openings;
use super::{EmissionNumbers, EmissionSample, PhotonEmitter};
use base::sampling::Sampler;
use world::light::DiscreteDistribution;

/// Minimum share of the paths of emitters that are infinitely far, and of the other emitters. The brighter ones may
/// light nothing that is seen, as the sky does around a closed room.
const MIN_SHARE: f32 = 0.1;

/// Plan for the photons of a scene. Flux is unbiased for any plan.
pub(super) struct EmitterPlan<'w> {
    /// Emitters in proportion to their numbers of paths.
    by_paths: DiscreteDistribution,
    /// Share of the paths that begin infinitely far.
    far_share: f32,
    /// Aims of paths from infinitely far; `None` if these paths go anywhere.
    pub aims: Option<Openings<'w>>,
}

impl<'w> EmitterPlan<'w> {
    /// Creates the plan: paths in proportion to the flux of emitters, but for [`MIN_SHARE`]. Emitters that are
    /// infinitely far have fewer paths, by the gain of the `aims`.
    pub fn new(emitter: &PhotonEmitter, aims: Option<Openings<'w>>) -> EmitterPlan<'w> {
        let by_power = &emitter.by_power;
        let fewer = |gain: f32| {
            let divisor = |index| if emitter.is_far(index) { gain } else { 1.0 };
            DiscreteDistribution::new(
                (0..by_power.len()).map(|index| by_power.probability(index) / divisor(index)),
            )
        };
        let by_paths = aims.as_ref().map_or_else(|| by_power.clone(), |aims| fewer(aims.gain));
        let by_paths = with_shares(emitter, by_paths);
        EmitterPlan { far_share: far_share(emitter, &by_paths), by_paths, aims }
    }

    /// Samples the beginning of a path; `None` if the emitter is dark there.
    pub fn sample(&self, emitter: &PhotonEmitter, sampler: &mut Sampler) -> Option<EmissionSample> {
        let (index, _) = self.by_paths.sample(sampler.next_1d());
        let numbers = EmissionNumbers::new(sampler);
        match self.aims.as_ref().filter(|_| emitter.is_far(index)) {
            Some(aims) => {
                let sample = aims.sample(&emitter.target, &numbers)?;
                Some(EmissionSample { flux: sample.flux / self.far_share, ..sample })
            }
            None => emitter.begin(index, 1.0 / self.by_paths.probability(index), &numbers),
        }
    }
}

/// Returns the distribution with at least [`MIN_SHARE`] for each of both kinds of emitters, if there are both.
fn with_shares(emitter: &PhotonEmitter, by_paths: DiscreteDistribution) -> DiscreteDistribution {
    let far = far_share(emitter, &by_paths);
    let wanted = far.clamp(MIN_SHARE, 1.0 - MIN_SHARE);
    if wanted == far || far <= 0.0 || far >= 1.0 {
        return by_paths;
    }
    let factor = |index| if emitter.is_far(index) { wanted / far } else { (1.0 - wanted) / (1.0 - far) };
    let weight = |index| by_paths.probability(index) * factor(index);
    DiscreteDistribution::new((0..by_paths.len()).map(weight))
}

/// Share of the paths that begin infinitely far.
fn far_share(emitter: &PhotonEmitter, by_paths: &DiscreteDistribution) -> f32 {
    let far = (0..by_paths.len()).filter(|index| emitter.is_far(*index));
    far.map(|index| by_paths.probability(index)).sum()
}
