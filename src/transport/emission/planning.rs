//! Planning of photon tracing for the points that the eye sees, from pilot paths.

use super::openings::Openings;
use super::plan::EmitterPlan;
use super::tracing::PathTracer;
use super::{PhotonEmitter, PhotonSettings};
use base::parallel::ShortRuns;
use base::sampling::hash;
use rayon::prelude::*;

/// Number of chunks of paths in each of two trials: with aims and without.
const TRIAL_CHUNKS: u32 = 4;

/// Minimum gain at which paths are aimed.
const MIN_GAIN_TO_AIM: f32 = 1.5;

/// Gain above which fewer photons are traced, in inverse proportion.
const GAIN_TO_REDUCE: f32 = 2.0;

/// Minimum number of photons that go anywhere, relative to the number of all photons without aims.
const MIN_UNAIMED_SHARE: f32 = 0.25;

/// Plan, and the work that it took.
pub(super) struct PhotonPlanning<'w> {
    pub plan: EmitterPlan<'w>,
    /// Number of closest-hit queries of the trials.
    pub rays: u64,
    /// Number of unaimed photons that are as good as one photon of the plan; 0 if none is aimed.
    pub gain: f32,
}

/// Plans the photons for the indirect light of the points `settings.seen`.
pub(super) fn plan<'w>(
    emitter: &PhotonEmitter<'w>,
    settings: &PhotonSettings,
    max_edges: u32,
) -> PhotonPlanning<'w> {
    let PhotonSettings { photons, seen, seed, .. } = *settings;
    let photons = photons as usize;
    let unaimed = EmitterPlan::by_power(emitter, photons);
    let mut planned = PhotonPlanning { plan: unaimed, rays: 0, gain: 0.0 };
    let mut anywhere = 1.0;
    if let Some(aims) = Openings::new(emitter.world, &emitter.target, seen, seed) {
        let (gain, share) = (aims.gain, aims.share);
        let aimed = EmitterPlan::aimed(emitter, aims, photons);
        let [without, with] =
            [&planned.plan, &aimed].map(|plan| trial(&PathTracer { emitter, plan, seed, max_edges }));
        planned.rays = without.rays + with.rays;
        // Most unaimed paths leave fewer photons, outside.
        let gain = gain * without.photons / with.photons.max(1.0);
        if gain >= MIN_GAIN_TO_AIM {
            (planned.plan, planned.gain, anywhere) = (aimed, gain, share);
        }
    }
    // Most photons of aimed paths come from infinitely far.
    if planned.gain > 0.0 {
        let fewer = (GAIN_TO_REDUCE / planned.gain).max(MIN_UNAIMED_SHARE / anywhere).min(1.0);
        planned.plan.photons = (photons as f32 * fewer) as usize;
    }
    planned
}

/// Yield of some paths.
struct Trial {
    photons: f32,
    rays: u64,
}

/// Traces some paths; their photons are only counted.
fn trial(tracer: &PathTracer) -> Trial {
    let tracer = PathTracer { seed: hash(tracer.seed, 0xa14d), ..*tracer };
    let chunks: Vec<_> =
        (0..TRIAL_CHUNKS).into_par_iter().one_by_one().map(|chunk| tracer.chunk(chunk, &|_| ())).collect();
    Trial {
        photons: chunks.iter().map(|chunk| chunk.photons.len() as f32).sum(),
        rays: chunks.iter().map(|chunk| chunk.rays).sum(),
    }
}
