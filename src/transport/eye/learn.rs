//! Learning which emitters are visible from where, by rays from points that the eye sees. The points are spread over
//! the whole film, so that a crop learns the same as the full image.

use super::EyeCounts;
use super::tracer::{PixelSamples, Tracer};
use base::math::{LANES, Vec2x16, Vec3x16, lanes_in};
use base::parallel::{ShortRuns, Workspaces};
use base::sampling::{Sampler, hash, owen_sobol_2d};
use embree::Rays16;
use glam::Vec3;
use rayon::prelude::*;
use world::light::{EmitterObservations, EnvironmentLight, Learned, Receivers16, SkyObservations};
use world::shadow;

/// Maximum number of eye paths.
const MAX_PATHS: u32 = 16384;

/// Number of film pixels per eye path.
const PIXELS_PER_PATH: u64 = 8;

/// Number of ray packets per point.
const PACKETS: usize = 2;

/// Number of paths per task.
const CHUNK: usize = 256;

/// Seed of the rays to the environment, combined with the paths' seed.
const RAY_SEED: u32 = 0x9d7b_2c41;

/// Seed of the rays to lamps, combined with the paths' seed.
const LAMP_SEED: u32 = 0x51ed_270b;

/// Step from one ray's tile to the next, coprime to the number of tiles.
const STRIDE: usize = 97;

/// Returns the film pixels through which paths go: `fewer` times fewer than for a full image.
fn places(film: [u32; 2], fewer: u64) -> Vec<[u32; 2]> {
    let pixels = u64::from(film[0]) * u64::from(film[1]);
    let count = ((pixels / PIXELS_PER_PATH).min(MAX_PATHS.into()) / fewer).max(64) as u32;
    let place = |i| {
        let at = owen_sobol_2d(i, RAY_SEED);
        [0, 1].map(|axis| ((at[axis] * film[axis] as f32) as u32).min(film[axis] - 1))
    };
    (0..count).map(place).collect()
}

impl Tracer<'_, '_> {
    /// Learns from one path through each of the pilot's pixels, and from fewer if cancelled. Returns the rays too, or
    /// `None` if there is nothing to learn. The number of paths is `fewer` times smaller than for a full image.
    pub(super) fn learn(&self, seed: u32, fewer: u64) -> Option<(Learned, EyeCounts)> {
        let emitters = &self.world.emitters;
        let (environment, lamps) = (emitters.environment.as_ref(), emitters.may_hide());
        if environment.is_none() && !lamps {
            return None;
        }
        let works = Workspaces::new(|| self.workspace(None));
        let look = |(chunk, pixels): (usize, &[[u32; 2]])| {
            let (mut sky, mut seen) = (SkyObservations::default(), EmitterObservations::default());
            if self.control.is_cancelled() {
                return (sky, seen, EyeCounts::default());
            }
            let mut points = 0;
            let each = |found: PixelSamples<'_, '_>, _: &mut Vec<_>| {
                for end in found.ends() {
                    let number = (chunk * CHUNK + points) as u32;
                    points += 1;
                    let x = end.geometry.position;
                    let normals = [end.geometry.normal, end.surface.geometric_normal];
                    if let Some(environment) = environment {
                        sky.points.push(x);
                        self.trace_sky(environment, x, normals, number, seed, &mut sky.rays);
                    }
                    if lamps {
                        seen.points.push(x);
                        self.trace_lamps(x, normals, number, seed, &mut seen.rays);
                    }
                }
            };
            let mut chains = works.with(|work| self.sample(pixels, 0..1, seed, work, each));
            chains.shadow_rays += (sky.rays.len() + seen.rays.iter().flatten().count()) as u64;
            (sky, seen, chains)
        };
        let places = places(self.view.window.film, fewer);
        let found: Vec<(SkyObservations, EmitterObservations, EyeCounts)> =
            places.par_chunks(CHUNK).one_by_one().enumerate().map(look).collect();
        let (mut all, mut seen, mut chains) =
            (SkyObservations::default(), EmitterObservations::default(), EyeCounts::default());
        for (mut looks, mut lamp_looks, traced) in found {
            chains += traced;
            all.points.append(&mut looks.points);
            all.rays.append(&mut looks.rays);
            seen.points.append(&mut lamp_looks.points);
            seen.rays.append(&mut lamp_looks.rays);
        }
        let learned = Learned {
            sky: environment.map(|environment| environment.learn(&all)),
            emitters: emitters.learn_emitters(&seen),
        };
        Some((learned, chains))
    }

    /// Traces rays from a point with the given shading and geometric normals to lamps, chosen as without learning.
    fn trace_lamps(
        &self,
        x: Vec3,
        [normal, geometric_normal]: [Vec3; 2],
        number: u32,
        seed: u32,
        rays: &mut Vec<Option<(u32, bool)>>,
    ) {
        let mut sampler = Sampler::new(hash(seed, LAMP_SEED), number);
        for _ in 0..PACKETS {
            let (mut choices, mut u) = ([0.0; LANES], Vec2x16::default());
            for (lane, choice) in choices.iter_mut().enumerate() {
                *choice = sampler.next_1d();
                u.set(lane, sampler.next_2d());
            }
            let (position, normals) = (Vec3x16::splat(x), Vec3x16::splat(normal));
            let at = Receivers16 { position: &position, normal: &normals, learned: None };
            let (chosen, samples) = self.world.emitters.sample_without_environment(at, &choices, &u);
            let (mut segments, mut lit) = (Rays16::default(), 0u16);
            for lane in lanes_in(samples.useful()) {
                let (direction, distance) = (samples.direction.get(lane), samples.distance[lane]);
                let end = x + direction * distance;
                let segment = match distance < f32::INFINITY {
                    true => shadow::segment(x, geometric_normal, end, samples.normal.get(lane)),
                    false => shadow::ray_from(x, geometric_normal, direction),
                };
                segments.set(lane, &segment);
                lit |= u16::from(normal.dot(direction) > 0.0) << lane;
            }
            let free = lit & !self.world.accel.occluded16(&segments, lit, false);
            rays.extend(
                (0..LANES)
                    .map(|lane| (lit >> lane & 1 != 0).then_some((chosen[lane], free >> lane & 1 != 0))),
            );
        }
    }

    /// Traces rays from a point with the given shading and geometric normals to some tiles of the environment.
    /// Successive points use different tiles.
    fn trace_sky(
        &self,
        environment: &EnvironmentLight,
        x: Vec3,
        [normal, geometric_normal]: [Vec3; 2],
        number: u32,
        seed: u32,
        rays: &mut Vec<(u16, f32)>,
    ) {
        let mut sampler = Sampler::new(hash(seed, RAY_SEED), number);
        for packet in 0..PACKETS {
            let first = (number as usize * PACKETS + packet) * LANES;
            let tiles = std::array::from_fn(|lane| (first + lane) * STRIDE % environment.tile_count());
            let mut u = Vec2x16::default();
            (0..LANES).for_each(|lane| u.set(lane, sampler.next_2d()));
            let directions = environment.directions_of_tiles(&tiles, &u);
            let (mut segments, mut cos) = (Rays16::default(), [0.0; LANES]);
            for (lane, direction) in directions.iter().enumerate() {
                if let Some(direction) = *direction {
                    cos[lane] = normal.dot(direction).max(0.0);
                    segments.set(lane, &shadow::ray_from(x, geometric_normal, direction));
                }
            }
            let lit = (0..LANES).filter(|lane| cos[*lane] > 0.0).fold(0, |lit, lane| lit | 1u16 << lane);
            let free = lit & !self.world.accel.occluded16(&segments, lit, false);
            rays.extend(
                (0..LANES)
                    .map(|lane| (tiles[lane] as u16, if (free >> lane) & 1 != 0 { cos[lane] } else { 0.0 })),
            );
        }
    }
}
