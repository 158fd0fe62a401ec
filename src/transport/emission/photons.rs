//! Tracing of photons from the emitters of a scene, planned for the points that the eye sees.
//!
//! Paths run in chunks of fixed size and are kept in order, so the photons are the same for any number of threads.
//! Units: flux in watts, to be divided by the number of paths.

use super::openings::Openings;
use super::plan::{CHUNK, EmitterPlan, PathTracer, PhotonChunk};
use super::walk::MAX_EDGES;
use super::{PhotonCounts, PhotonEmitter, PhotonHit, PhotonSettings};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::sampling::hash;
use rayon::prelude::*;
use world::World;

/// Number of chunks in the first wave, from which the yield of the others is estimated.
const FIRST_WAVE: u32 = 16;

/// Maximum number of paths per photon asked for; reached if most light misses the scene.
const PATHS_PER_PHOTON: u32 = 32;

/// Traces photons, maps each of them by `keep`, and returns the results in order. Nothing is traced if no surface
/// stores photons.
pub fn trace_photons<T: Send>(
    world: &World,
    settings: &PhotonSettings,
    control: &Control,
    keep: impl Fn(&PhotonHit) -> T + Sync,
) -> (Vec<T>, PhotonCounts) {
    let (parts, counts) = trace_in_parts(world, settings, control, keep);
    let mut photons = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    parts.into_iter().for_each(|part| photons.extend(part));
    (photons, counts)
}

/// Traces photons like [`trace_photons`], and returns the results as they were traced: in consecutive parts.
pub fn trace_in_parts<T: Send>(
    world: &World,
    settings: &PhotonSettings,
    control: &Control,
    keep: impl Fn(&PhotonHit) -> T + Sync,
) -> (Vec<Vec<T>>, PhotonCounts) {
    let max_edges = settings.max_edges.min(MAX_EDGES);
    let emitter = match PhotonEmitter::new(world) {
        Some(emitter) if settings.photons > 0 && max_edges > 0 && world.specular.store_light() => emitter,
        _ => return (Vec::new(), PhotonCounts::default()),
    };
    let planned = plan(&emitter, settings, max_edges);
    let mut counts = PhotonCounts { paths: 0, rays: planned.rays, gain: planned.gain };
    let wanted = planned.plan.photons;
    let seed = hash(settings.seed, 0x1d1d);
    let tracer = PathTracer { emitter: &emitter, plan: &planned.plan, seed, max_edges };
    let max_chunks = (settings.photons.saturating_mul(PATHS_PER_PHOTON) / CHUNK).max(FIRST_WAVE);
    let mut parts = Vec::new();
    let (mut found, mut chunks) = (0, 0);
    while found < wanted && chunks < max_chunks && !control.is_cancelled() {
        let wave = next_wave(chunks, found, wanted).min(max_chunks - chunks);
        let traced: Vec<PhotonChunk<T>> = (chunks..chunks + wave)
            .into_par_iter()
            .one_by_one()
            .map(|chunk| match control.is_cancelled() {
                true => PhotonChunk { photons: Vec::new(), rays: 0 },
                false => tracer.chunk(chunk, &keep),
            })
            .collect();
        for chunk in traced {
            // Some chunks of the wave may not have been traced.
            if control.is_cancelled() {
                break;
            }
            counts.rays += chunk.rays;
            // Chunks beyond the one that fills the quota are dropped, so that the result does not depend on the waves.
            if found < wanted {
                chunks += 1;
                found += chunk.photons.len();
                control.advance(chunk.photons.len() as u64);
                parts.push(chunk.photons);
            }
        }
    }
    counts.paths = u64::from(chunks) * u64::from(CHUNK);
    (parts, counts)
}

/// Returns the number of chunks to trace next: the estimate from the yield so far less 10 %, so that few are discarded.
fn next_wave(chunks: u32, found: usize, wanted: usize) -> u32 {
    if chunks == 0 {
        return FIRST_WAVE;
    }
    let yield_per_chunk = found as f64 / f64::from(chunks);
    let missing = (wanted - found) as f64;
    let guess = if yield_per_chunk > 0.0 { 0.9 * missing / yield_per_chunk } else { f64::from(chunks) };
    (guess as u32).clamp(4, 4096)
}

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
