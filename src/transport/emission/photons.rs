//! Tracing of photons from the emitters of a scene, planned for the points that the eye sees.
//!
//! Paths run in chunks of fixed size and are kept in order, so the photons are the same for any number of threads.
//! Units: flux in watts, to be divided by the number of paths.

use super::openings::Openings;
use super::plan::EmitterPlan;
use super::tracing::{CHUNK, PathTracer, PhotonChunk};
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
    let plan =
        EmitterPlan::new(&emitter, Openings::new(world, &emitter.target, settings.seen, settings.seed));
    let gain = plan.aims.as_ref().map_or(0.0, |aims| aims.gain);
    let mut counts = PhotonCounts { paths: 0, rays: 0, gain };
    let wanted = settings.photons as usize;
    let seed = hash(settings.seed, 0x1d1d);
    let tracer = PathTracer { emitter: &emitter, plan: &plan, seed, max_edges };
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
