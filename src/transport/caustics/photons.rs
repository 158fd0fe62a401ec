//! Paths of photons that reach surfaces by mirrors and glass alone.

use super::aims::{Aimed, Aims, CellYield};
use crate::emission::{Carried, EmissionSample, MAX_EDGES, PhotonEmitter, Walk};
use base::math::{Rgb, luminance};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::sampling::{Sampler, hash};
use glam::Vec3;
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};
use world::World;

/// Number of paths per task.
const CHUNK: u32 = 1024;

/// Number of pilot paths per pixel of the film. Small films show less of what photons light, and take less time.
const PILOT_PATHS_PER_PIXEL: u64 = 4;

/// Minimum number of tasks of pilot paths.
const MIN_PILOT_TASKS: u64 = 16;

/// Maximum number of tasks of pilot paths.
const MAX_PILOT_TASKS: u32 = 256;

/// Number of tasks between two tests of the limits.
const WAVE: u32 = 64;

/// Minimum number of photons of the maximum number of pilot paths; with fewer, photons are not traced.
const MIN_FOUND: usize = 8;

/// Standard number of photons.
const PHOTONS: f32 = 300_000.0;

/// Maximum number of paths for the standard number of photons.
const MAX_PATHS: f32 = 2_000_000.0;

/// Maximum number of rays for the standard number of photons.
const MAX_RAYS: f32 = 1_200_000.0;

/// Minimum share of the flux that mirrors and glass send on. Below it paths find all the light, unless the scene has
/// emitters that no path can meet.
const MIN_FLUX: f32 = 3e-4;

/// Light that arrives at a surface by delta lobes.
#[derive(Clone, Copy, Debug)]
pub struct CausticPhoton {
    /// Position.
    pub position: Vec3,
    /// Unit vector back along the path.
    pub towards_light: Vec3,
    /// Flux in watts.
    pub flux: Rgb,
    /// Luminance of the emitter's radiance along the path's first edge; infinite for emitters that no path can meet.
    pub radiance: f32,
    /// Number of edges of the path.
    pub edges: u32,
    /// Radius of the photon's disc; 0 until it is known.
    pub radius: f32,
}

/// Photons in the order of their paths.
#[derive(Default)]
pub struct CausticTrace {
    /// The photons.
    pub photons: Vec<CausticPhoton>,
    /// Number of paths that would leave as many photons if all paths began in proportion to flux.
    pub even_paths: f32,
    /// Number of paths.
    pub paths: u64,
    /// Number of closest-hit queries.
    pub rays: u64,
}

/// Photons of one task.
#[derive(Default)]
struct CausticChunk {
    photons: Vec<CausticPhoton>,
    /// Sum of the photons' inverse boosts.
    evenly: f32,
    rays: u64,
    /// Cells of the paths that may have met a mirror or glass, and the number of photons of each path.
    cells: Vec<(usize, usize)>,
}

/// Yield of the pilot paths.
pub struct PilotYield {
    /// Yield by cell of [`Aims`]; empty if photons are not to be traced.
    cells: Vec<CellYield>,
    /// Number of paths.
    pub paths: u32,
    /// Number of closest-hit queries.
    pub rays: u64,
}

/// Returns the number of tasks of pilot paths for a film of so many pixels.
pub fn pilot_tasks(film_pixels: u64) -> u32 {
    let wanted = film_pixels.saturating_mul(PILOT_PATHS_PER_PIXEL) / u64::from(CHUNK);
    wanted.clamp(MIN_PILOT_TASKS, MAX_PILOT_TASKS.into()) as u32
}

/// Tracing of caustic photons in a scene.
pub struct CausticTracer<'a, 'w> {
    world: &'w World,
    emitter: &'a PhotonEmitter<'w>,
    seed: u32,
    max_edges: u32,
    control: &'a Control,
}

impl<'a, 'w> CausticTracer<'a, 'w> {
    /// Traces from `emitter` paths of at most `max_edges` edges, fewer of them if `control` is cancelled.
    pub fn new(
        world: &'w World,
        emitter: &'a PhotonEmitter<'w>,
        seed: u32,
        max_edges: u32,
        control: &'a Control,
    ) -> CausticTracer<'a, 'w> {
        CausticTracer { world, emitter, seed, max_edges: max_edges.min(MAX_EDGES), control }
    }

    /// Traces the pilot paths of so many tasks. Their photons are only counted.
    pub fn pilot(&self, tasks: u32) -> PilotYield {
        let even = Aims::even(self.emitter);
        let (paths, mut cells, mut rays) = (tasks * CHUNK, vec![CellYield::default(); even.cells()], 0);
        let (mut flux, mut count) = (0.0, 0);
        for chunk in self.chunks(&even, hash(self.seed, 0xca57), 0..tasks) {
            rays += chunk.rays;
            count += chunk.photons.len();
            flux += chunk.photons.iter().map(|photon| luminance(photon.flux)).sum::<f32>();
            for (cell, photons) in chunk.cells {
                cells[cell].aimed += 1.0;
                cells[cell].photons += photons as f32;
            }
        }
        let share = flux / (paths as f32 * self.emitter.power());
        let paths_suffice = !(share >= MIN_FLUX) && !self.world.scene.has_small_lights();
        if count * (MAX_PILOT_TASKS as usize) < MIN_FOUND * tasks as usize || paths_suffice {
            cells.clear();
        }
        PilotYield { cells, paths, rays }
    }

    /// Traces photons, `factor` times the standard number; none if the pilot paths advise against it.
    pub fn photons(&self, pilot: &PilotYield, factor: f32) -> CausticTrace {
        let mut traced = CausticTrace::default();
        if pilot.cells.is_empty() {
            return traced;
        }
        let [photons, paths, rays] =
            [PHOTONS, MAX_PATHS, MAX_RAYS].map(|standard| (standard * factor) as u64);
        let aims = Aims::even(self.emitter).learned(&pilot.cells, pilot.paths as f32);
        let (mut wave, mut evenly) = (0, 0.0);
        while (traced.photons.len() as u64) < photons
            && traced.paths < paths
            && traced.rays < rays
            && !self.control.is_cancelled()
        {
            for chunk in self.chunks(&aims, hash(self.seed, 0xca58), wave * WAVE..(wave + 1) * WAVE) {
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

    /// Traces the paths of some tasks, which begin as `aims` say.
    fn chunks(&self, aims: &Aims, seed: u32, tasks: Range<u32>) -> Vec<CausticChunk> {
        let trace = |task: u32| {
            let mut chunk = CausticChunk::default();
            for path in task * CHUNK..(task + 1) * CHUNK {
                if self.control.is_cancelled() {
                    break;
                }
                let sampler = &mut Sampler::new(seed, path);
                let Some(Aimed { emission, cell, boost }) = aims.sample(sampler) else { continue };
                if !self.world.specular.may_meet_delta_lobes(&emission.ray) {
                    continue;
                }
                let before = chunk.photons.len();
                chunk.rays += self.follow(emission, sampler, &mut chunk.photons);
                let left = chunk.photons.len() - before;
                chunk.evenly += left as f32 / boost;
                chunk.cells.push((cell, left));
            }
            chunk
        };
        tasks.into_par_iter().one_by_one().map(trace).collect()
    }

    /// Follows a path by delta lobes. Behind the first mirror or glass, keeps a photon at every surface with other
    /// lobes. Returns the number of rays.
    fn follow(&self, first: EmissionSample, sampler: &mut Sampler, photons: &mut Vec<CausticPhoton>) -> u64 {
        let EmissionSample { ray, flux, radiance } = first;
        let (world, max_edges) = (self.world, self.max_edges);
        let walk = Walk { world, carried: Carried::Flux, max_edges, by_delta: true };
        walk.follow(ray, flux, sampler, |at, _| {
            let (position, flux) = (at.surface.position, at.weight);
            if at.is_bent && at.bsdf.has_smooth() && flux.is_finite() && position.is_finite() {
                let (towards_light, edges) = (at.back, at.edges);
                photons.push(CausticPhoton { position, towards_light, flux, radiance, edges, radius: 0.0 });
            }
            ControlFlow::Continue(())
        })
    }
}
