//! Photons that come to surfaces by mirrors and glass alone.

use super::aims::{Aimed, Aims, Yield};
use crate::emission::{EmissionSample, MAX_CORRECTION, PhotonEmitter};
use base::math::{Rgb, luminance};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::sampling::{Sampler, hash};
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;
use world::shadow;
use world::{World, beyond};

/// Number of paths traced by one task.
const CHUNK: u32 = 1024;

/// Number of tasks that the first paths are divided into: they tell where photons come from.
const FIRST: u32 = 256;

/// Number of tasks after which the numbers found are looked at.
const WAVE: u32 = 64;

/// Number of photons without which the first paths have found nothing.
const MIN_FOUND: usize = 8;

/// Numbers of photons, paths and rays of which the first to be reached ends the tracing, for one time as many photons
/// as usual.
const PHOTONS: f32 = 300_000.0;
const PATHS: f32 = 2_000_000.0;
const RAYS: f32 = 1_200_000.0;

/// Share of the flux that mirrors and glass send on below which photons are not worth it, and paths are to find all;
/// but not of light that these cannot find.
const LITTLE: f32 = 3e-4;

/// Maximum number of edges of a path: only a closed scene of mirrors reaches it.
const MAX_EDGES: u32 = 256;

/// Maximum probability of survival, so that a path ends even if nothing absorbs.
const MAX_SURVIVAL: f32 = 0.98;

/// Light that arrives at a surface by delta lobes.
#[derive(Clone, Copy, Debug)]
pub struct CausticPhoton {
    /// Position.
    pub position: Vec3,
    /// Unit vector back along its path.
    pub towards_light: Vec3,
    /// Flux in watts.
    pub flux: Rgb,
    /// Luminance of the emitter's radiance along the path's first edge; infinite of emitters that no path can meet.
    pub radiance: f32,
    /// Edges of its path; those before and behind a sheet that light passes straight count as one.
    pub edges: u32,
    /// Radius of a disc around it in which there are some; 0 until it is known.
    pub radius: f32,
}

/// Photons in the order of their paths.
#[derive(Default)]
pub struct Traced {
    /// The photons.
    pub photons: Vec<CausticPhoton>,
    /// Number of paths that those which left photons are among, if all paths began in proportion to flux.
    pub even_paths: f32,
    /// Number of paths.
    pub paths: u64,
    /// Closest-hit queries.
    pub rays: u64,
}

/// Photons of one task.
#[derive(Default)]
struct Chunk {
    photons: Vec<CausticPhoton>,
    /// Sum of the photons' inverse boosts.
    evenly: f32,
    rays: u64,
    /// Cells of the paths that may have met a mirror or glass, with the numbers of their photons.
    cells: Vec<(usize, usize)>,
}

/// The first paths.
pub struct First {
    /// Their yield, by cell of [`Aims`]; empty if photons are not worth it.
    found: Vec<Yield>,
    /// Closest-hit queries.
    pub rays: u64,
}

/// Number of the first paths.
pub const FIRST_PATHS: u32 = CHUNK * FIRST;

/// Traces the first paths, whose photons are not kept.
pub fn first(world: &World, emitter: &PhotonEmitter, seed: u32, max_edges: u32, control: &Control) -> First {
    let even = Aims::even(emitter);
    let (mut found, mut rays) = (vec![Yield::default(); even.cells()], 0);
    let (mut flux, mut count) = (0.0, 0);
    let tasks = (hash(seed, 0xca57), 0..FIRST);
    for chunk in chunks(world, &even, tasks, max_edges.min(MAX_EDGES), control) {
        rays += chunk.rays;
        count += chunk.photons.len();
        flux += chunk.photons.iter().map(|photon| luminance(photon.flux)).sum::<f32>();
        for (cell, photons) in chunk.cells {
            found[cell].aimed += 1.0;
            found[cell].photons += photons as f32;
        }
    }
    let share = flux / (FIRST_PATHS as f32 * emitter.power());
    let is_little = !(share >= LITTLE) && !world.scene.has_small_lights();
    if count < MIN_FOUND || is_little {
        found.clear();
    }
    First { found, rays }
}

/// Traces photons from `emitter`, `many` times as many as usual, of paths of at most `max_edges` edges; none if they
/// are not worth it, fewer if `control` is cancelled.
pub fn trace(
    world: &World,
    (emitter, first): (&PhotonEmitter, &First),
    (seed, many): (u32, f32),
    max_edges: u32,
    control: &Control,
) -> Traced {
    let mut traced = Traced::default();
    if first.found.is_empty() {
        return traced;
    }
    let [photons, paths, rays] = [PHOTONS, PATHS, RAYS].map(|usual| (usual * many) as u64);
    let aims = Aims::even(emitter).learned(&first.found, FIRST_PATHS as f32);
    let (mut wave, mut evenly) = (0, 0.0);
    while (traced.photons.len() as u64) < photons
        && traced.paths < paths
        && traced.rays < rays
        && !control.is_cancelled()
    {
        let tasks = wave * WAVE..(wave + 1) * WAVE;
        for chunk in chunks(world, &aims, (hash(seed, 0xca58), tasks), max_edges.min(MAX_EDGES), control) {
            traced.photons.extend(chunk.photons);
            traced.rays += chunk.rays;
            evenly += chunk.evenly;
        }
        wave += 1;
        traced.paths += u64::from(WAVE * CHUNK);
    }
    let share = 1.0 / traced.paths.max(1) as f32;
    for photon in &mut traced.photons {
        photon.flux *= share;
    }
    let count = traced.photons.len() as f32;
    traced.even_paths = traced.paths as f32 * count / f32::max(evenly, f32::MIN_POSITIVE);
    traced
}

/// Photons of some tasks, of paths that begin by `aims`.
fn chunks(
    world: &World,
    aims: &Aims,
    (seed, tasks): (u32, Range<u32>),
    max_edges: u32,
    control: &Control,
) -> Vec<Chunk> {
    let trace = |task: u32| {
        let mut chunk = Chunk::default();
        for path in task * CHUNK..(task + 1) * CHUNK {
            if control.is_cancelled() {
                break;
            }
            let sampler = &mut Sampler::new(seed, path);
            let Some(Aimed { emission, cell, boost }) = aims.sample(sampler) else { continue };
            if !world.specular.may_meet_delta_lobes(&emission.ray) {
                continue;
            }
            let before = chunk.photons.len();
            chunk.rays += follow(world, emission, sampler, max_edges, &mut chunk.photons);
            let left = chunk.photons.len() - before;
            chunk.evenly += left as f32 / boost;
            chunk.cells.push((cell, left));
        }
        chunk
    };
    tasks.into_par_iter().one_by_one().map(trace).collect()
}

/// Follows a path by delta lobes and keeps a photon at every surface behind one that has other lobes, too. Returns the
/// number of rays.
fn follow(
    world: &World,
    EmissionSample { mut ray, mut flux, radiance }: EmissionSample,
    sampler: &mut Sampler,
    max_edges: u32,
    photons: &mut Vec<CausticPhoton>,
) -> u64 {
    let (mut edges, mut is_bent) = (1, false);
    for rays in 1..=u64::from(MAX_EDGES) {
        let Some(surface) = world.intersect(&ray) else { return rays };
        let towards_light = -ray.direction;
        let wi = surface.frame.to_local(towards_light);
        let cos_g = surface.normal.dot(towards_light);
        if wi.z * cos_g <= 0.0 {
            return rays; // the two normals disagree on which side this is
        }
        let bsdf = world.bsdf(&surface);
        if is_bent && bsdf.has_smooth() {
            let flux = flux * (wi.z / cos_g).min(MAX_CORRECTION);
            if flux.is_finite() && surface.position.is_finite() {
                let position = surface.position;
                photons.push(CausticPhoton { position, towards_light, flux, radiance, edges, radius: 0.0 });
            }
        }
        if edges == max_edges || !bsdf.has_delta() {
            return rays;
        }
        let (u_lobe, u_direction, u_survival) = (sampler.next_1d(), sampler.next_2d(), sampler.next_1d());
        let Some(s) = bsdf.sample(wi, u_lobe, u_direction).filter(|s| s.delta) else { return rays };
        let direction = surface.frame.to_world(s.wi);
        if surface.normal.dot(direction) * s.wi.z <= 0.0 {
            return rays;
        }
        let next = flux * s.weight * (s.eta * s.eta);
        let survival = (luminance(next) / luminance(flux)).min(MAX_SURVIVAL);
        if !next.is_finite() || u_survival >= survival {
            return rays;
        }
        flux = next / survival;
        if s.straight {
            ray = beyond(&ray, surface.position, surface.normal, surface.t);
        } else {
            (edges, is_bent) = (edges + 1, true);
            ray = shadow::ray_from(surface.position, surface.normal, direction);
        }
    }
    u64::from(MAX_EDGES)
}
