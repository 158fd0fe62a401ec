//! Many paths traced together, an edge at a time, so that rays go to Embree sixteen at once.
//!
//! Deviations: Embree's packets change the last bits of a hit, never its meaning; since a batch always holds the
//! same paths in the same order, pictures do not depend on threads.

use super::vertex::{DirectLight, Draws, Path};
use crate::embree::{Hit, Hits16, Ray, Rays16};
use crate::math::Rgb;
use crate::sampling::Sampler;
use crate::world::World;

/// Rays traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
}

/// Paths in flight, and what they brought to the eye so far.
#[derive(Default)]
pub(super) struct Batch {
    paths: Vec<Path>,
    direct: Vec<DirectLight>,
    radiance: Vec<Rgb>,
}

impl Batch {
    /// Adds a path; its result has the index of the call.
    pub fn push(&mut self, ray: Ray, sampler: Sampler) {
        self.paths.push(Path::new(ray, sampler, self.radiance.len() as u32));
        self.radiance.push(Rgb::ZERO);
    }

    /// Traces all paths to their ends, at most `max_depth` edges, and empties the batch.
    /// Returns the radiance of each.
    pub fn trace(&mut self, world: &World, max_depth: u32, counts: &mut Counts) -> std::vec::Drain<'_, Rgb> {
        let mut depth = 1;
        while !self.paths.is_empty() {
            self.extend(world, depth, max_depth, counts);
            self.light(world, depth == 1, counts);
            depth += 1;
        }
        self.radiance.drain(..)
    }

    /// Traces every path's edge and shades where it ends; paths that end are dropped, the others stay in order.
    fn extend(&mut self, world: &World, depth: u32, max_depth: u32, counts: &mut Counts) {
        counts.rays += self.paths.len() as u64;
        let mut kept = 0;
        let mut rays = Rays16::default();
        let mut hits = Hits16::default();
        for begin in (0..self.paths.len()).step_by(16) {
            let count = (self.paths.len() - begin).min(16);
            for (lane, path) in self.paths[begin..begin + count].iter().enumerate() {
                rays.set(lane, &path.ray);
            }
            let found = world.accel.closest_hit16(&rays, lanes(count), depth == 1, &mut hits);
            self.escape(world, begin, lanes(count) & !found);
            let draws = self.draw(world, begin, count);
            for lane in (0..count).filter(|lane| (found >> lane) & 1 != 0) {
                let path = &mut self.paths[begin + lane];
                let hit = Hit {
                    t: hits.t[lane],
                    u: hits.u[lane],
                    v: hits.v[lane],
                    geometry: hits.geometry[lane],
                    primitive: hits.primitive[lane],
                };
                let surface = world.surface(&hit);
                self.radiance[path.slot as usize] += path.emitted(world, &surface);
                if depth < max_depth && path.scatter(world, &surface, depth, &draws[lane], &mut self.direct) {
                    if kept != begin + lane {
                        self.paths[kept] = self.paths[begin + lane];
                    }
                    kept += 1;
                }
            }
        }
        self.paths.truncate(kept);
    }

    /// Adds the environment's light to the paths of a packet that met nothing.
    fn escape(&mut self, world: &World, begin: usize, escaped: u16) {
        let Some(environment) = &world.emitters.environment else { return };
        // Four at a time, compacted: packets seldom lose all their rays at once.
        let mut lanes = (0..16).filter(|lane| (escaped >> lane) & 1 != 0);
        while let Some(first) = lanes.next() {
            let four = [Some(first), lanes.next(), lanes.next(), lanes.next()];
            let index = four.map(|lane| begin + lane.unwrap_or(first));
            let light = environment.radiance_pdf_many(&index.map(|i| self.paths[i].ray.direction));
            for (i, light) in index.into_iter().zip(light).take(four.iter().flatten().count()) {
                let path = &self.paths[i];
                self.radiance[path.slot as usize] += path.escaped(world, light);
            }
        }
    }

    /// The random numbers of a packet's vertices.
    fn draw(&mut self, world: &World, begin: usize, count: usize) -> [Draws; 16] {
        let mut draws = [Draws::default(); 16];
        for (draws, path) in draws.iter_mut().zip(&mut self.paths[begin..begin + count]) {
            *draws = path.draw();
        }
        if let Some(environment) = &world.emitters.environment {
            let samples = environment.sample_many(&draws.map(|d| d.light()));
            for (draws, sample) in draws.iter_mut().zip(samples) {
                draws.environment = sample;
            }
        }
        draws
    }

    /// Adds the direct light whose segments are free.
    fn light(&mut self, world: &World, coherent: bool, counts: &mut Counts) {
        counts.shadow_rays += self.direct.len() as u64;
        let mut rays = Rays16::default();
        for lights in self.direct.chunks(16) {
            for (lane, light) in lights.iter().enumerate() {
                rays.set(lane, &light.segment);
            }
            let occluded = world.accel.occluded16(&rays, lanes(lights.len()), coherent);
            for (lane, light) in lights.iter().enumerate() {
                if (occluded >> lane) & 1 == 0 {
                    self.radiance[light.slot as usize] += light.radiance;
                }
            }
        }
        self.direct.clear();
    }
}

/// Mask of the first `count` of sixteen lanes.
#[inline]
fn lanes(count: usize) -> u16 {
    (u32::MAX >> (32 - count.clamp(1, 16))) as u16
}
