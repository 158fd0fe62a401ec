//! Learning how much light arrives from which emitters, by rays from points on paths from the eye. The paths are spread
//! over the whole film, so that a crop learns what the full image does.
//!
//! Rays are traced in waves: the first anywhere, the second where the first has found light. The result depends on
//! no image's random seed, so that the pilots of a plan, the image and its other methods share it.

use crate::emission::{Carried, Walk, WalkVertex};
use crate::paths::RayCounts;
use base::math::{LANES, Rgb, Vec2x16, Vec3x16, lanes_in};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::sampling::{Sampler, hash};
use base::stats::add_fields;
use embree::Rays16;
use glam::Vec3;
use rayon::prelude::*;
use scene::Camera;
use std::ops::ControlFlow;
use world::light::{DirectSamples16, EnvironmentLight, Learned, LightRays, Receivers16};
use world::view::View;
use world::{SurfacePoint, World, shadow};

/// Maximum number of paths.
const MAX_PATHS: u64 = 8192;

/// Minimum number of paths.
const MIN_PATHS: u64 = 64;

/// Number of eye samples per path.
const SAMPLES_PER_PATH: u64 = 256;

/// Number of samples per pixel beyond which no more is learned, so that an image can be resumed for more samples.
const MAX_SPP: u32 = 16;

/// Number of ray packets per point of each wave.
const WAVES: [usize; 2] = [4, 8];

/// Minimum share of occluded rays in the first wave for another wave.
const MIN_OCCLUDED: f32 = 0.25;

/// Maximum number of points on a path: a visible surface, and one that lights it.
const POINTS: u32 = 2;

/// Maximum number of edges of a path.
const MAX_EDGES: u32 = 16;

/// Number of paths or points per task.
const CHUNK: usize = 256;

/// Seed of the paths.
const PATH_SEED: u32 = 0x9d7b_2c41;

/// Seed of the rays to the environment.
const SKY_SEED: u32 = 0x3c6e_f372;

/// Seed of the rays to lamps.
const LAMP_SEED: u32 = 0x51ed_270b;

/// Step from one ray's tile to the next, coprime to the number of tiles.
const STRIDE: usize = 97;

/// Order to learn light for the points that a view sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learning {
    camera: Camera,
    film: [u32; 2],
    /// Number of paths from the eye.
    paths: u32,
}

/// Light that was learned, and the rays that it took.
pub struct LearnedLight {
    /// The light; `None` if there is nothing to learn.
    pub light: Option<Learned>,
    /// Rays traced.
    pub counts: RayCounts,
}

/// Numbers of visibility tests.
#[derive(Clone, Copy, Default)]
struct Tests {
    all: u64,
    occluded: u64,
}
add_fields!(Tests { all, occluded });

impl Tests {
    /// Counts the tests in the lanes of `lit`, of which those of `free` are unoccluded.
    fn new(lit: u16, free: u16) -> Tests {
        Tests { all: lit.count_ones().into(), occluded: (lit & !free).count_ones().into() }
    }
}

/// A wave of rays from points.
#[derive(Clone, Copy)]
struct Wave<'a> {
    world: &'a World,
    number: usize,
    /// Light that earlier waves found.
    learned: Option<&'a Learned>,
}

impl Learning {
    /// Makes the order for an image of a view with `spp` samples per pixel.
    pub fn new(view: &View, spp: u32) -> Learning {
        let samples = view.window.film_pixel_count() * u64::from(spp.clamp(1, MAX_SPP));
        let paths = (samples / SAMPLES_PER_PATH).clamp(MIN_PATHS, MAX_PATHS) as u32;
        Learning { camera: view.camera, film: view.window.film, paths }
    }

    /// Traces the rays and learns from them; learns from fewer once cancelled.
    pub fn learn(&self, world: &World, view: &View, control: &Control) -> LearnedLight {
        let mut found = LearnedLight { light: None, counts: RayCounts::default() };
        let (environment, lamps) = (world.emitters.environment.as_ref(), world.emitters.may_hide());
        if environment.is_none() && !lamps {
            return found;
        }
        let points = self.points_on_paths(world, view, control, &mut found.counts);
        let positions: Vec<Vec3> = points.iter().map(|point| point.position).collect();
        let mut observed = world.emitters.observed_from(&positions);
        for number in 0..WAVES.len() {
            let wave = Wave { world, number, learned: found.light.as_ref() };
            let look = |(chunk, points): (usize, &[SurfacePoint])| {
                let (mut rays, mut tests) = (LightRays::default(), Tests::default());
                for (i, point) in points.iter().enumerate() {
                    if let Some(environment) = environment {
                        tests += wave.trace_sky(environment, point, chunk * CHUNK + i, &mut rays.sky);
                    }
                    if lamps {
                        tests += wave.trace_lamps(point, chunk * CHUNK + i, &mut rays.emitters);
                    }
                }
                (rays, tests)
            };
            let chunks = points.par_chunks(CHUNK).one_by_one().enumerate();
            let rays: Vec<(LightRays, Tests)> = chunks.map(look).collect();
            let (mut all, mut tests) = (LightRays::default(), Tests::default());
            for (mut rays, of_chunk) in rays {
                tests += of_chunk;
                all.sky.append(&mut rays.sky);
                all.emitters.append(&mut rays.emitters);
            }
            found.counts.shadow_rays += tests.all;
            observed.add(all);
            found.light = Some(world.emitters.learn(&observed));
            if tests.occluded as f32 <= MIN_OCCLUDED * tests.all as f32 || control.is_cancelled() {
                break;
            }
        }
        found
    }

    /// Finds the points from which rays are traced; none once cancelled.
    fn points_on_paths(
        &self,
        world: &World,
        view: &View,
        control: &Control,
        counts: &mut RayCounts,
    ) -> Vec<SurfacePoint> {
        let walk = Walk { world, carried: Carried::Importance, max_edges: MAX_EDGES, by_delta: false };
        let follow = |number: u32, points: &mut Vec<SurfacePoint>| {
            let pixel = view.window.spread_pixel(number, PATH_SEED);
            let mut sampler = Sampler::new(PATH_SEED, number);
            let ray = view.sample_ray(pixel, sampler.next_2d(), PATH_SEED, number);
            let mut left = POINTS;
            walk.follow(world.behind_hidden(ray), Rgb::ONE, &mut sampler, |vertex, _| {
                if vertex.bsdf.has_smooth() {
                    points.push(receiving(vertex));
                    left -= 1;
                }
                if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
        };
        let chunk = |chunk: u32| {
            let (mut points, mut rays) = (Vec::new(), 0);
            let first = chunk * CHUNK as u32;
            for number in first..(first + CHUNK as u32).min(self.paths) {
                rays += if control.is_cancelled() { 0 } else { follow(number, &mut points) };
            }
            (points, rays)
        };
        let chunks = (0..self.paths.div_ceil(CHUNK as u32)).into_par_iter().one_by_one();
        let chunks: Vec<(Vec<SurfacePoint>, u64)> = chunks.map(chunk).collect();
        counts.rays += chunks.iter().map(|(_, rays)| rays).sum::<u64>();
        chunks.into_iter().flat_map(|(points, _)| points).collect()
    }
}

/// Returns the point on a surface that a path meets; its normal is zero if light from both sides counts.
fn receiving(vertex: &WalkVertex) -> SurfacePoint {
    let (surface, shading) = (vertex.surface, vertex.surface.frame.normal);
    let normal = match vertex.wo.z < 0.0 {
        _ if vertex.bsdf.scatters_across() => Vec3::ZERO,
        true => -shading,
        false => shading,
    };
    SurfacePoint { position: surface.position, normal, geometric_normal: surface.normal }
}

/// Returns the cosine that weights light from a direction; 0 if it does not count.
fn weight(point: &SurfacePoint, direction: Vec3) -> f32 {
    if point.normal == Vec3::ZERO { 1.0 } else { point.normal.dot(direction).max(0.0) }
}

/// Returns position and normal of a point in all lanes.
fn splat(point: &SurfacePoint) -> (Vec3x16, Vec3x16) {
    (Vec3x16::splat(point.position), Vec3x16::splat(point.normal))
}

impl Wave<'_> {
    /// Returns the number of ray packets per point.
    fn packets(&self) -> usize {
        WAVES[self.number]
    }

    /// Returns the random numbers of a point's rays.
    fn sampler(&self, kind: u32, point: usize) -> Sampler {
        Sampler::new(hash(kind, self.number as u32), point as u32)
    }

    /// Traces rays from the point of the given index to tiles of the environment. In the first wave, successive points
    /// use different tiles.
    fn trace_sky(
        &self,
        environment: &EnvironmentLight,
        point: &SurfacePoint,
        index: usize,
        rays: &mut Vec<(u16, f32)>,
    ) -> Tests {
        let (mut sampler, mut tests) = (self.sampler(SKY_SEED, index), Tests::default());
        let (position, normal) = splat(point);
        let at = Receivers16 { position: &position, normal: &normal, learned: self.learned };
        let (start, count) = (sampler.next_1d(), self.packets() * LANES);
        for packet in 0..self.packets() {
            let (mut u, first) = (Vec2x16::default(), packet * LANES);
            (0..LANES).for_each(|lane| u.set(lane, sampler.next_2d()));
            let tiles = match at.sky() {
                Some(sky) => environment.tiles_by(
                    &sky,
                    &std::array::from_fn(|lane| ((first + lane) as f32 + start) / count as f32),
                ),
                None => {
                    let number = |lane| index * count + first + lane;
                    std::array::from_fn(|lane| number(lane) * STRIDE % environment.tile_count())
                }
            };
            let directions = environment.directions_of_tiles(&tiles, &u);
            let (mut segments, mut cos) = (Rays16::default(), [0.0; LANES]);
            for (lane, direction) in directions.iter().enumerate() {
                if let Some(direction) = *direction {
                    cos[lane] = weight(point, direction);
                    segments.set(lane, &shadow::ray_from(point.position, point.geometric_normal, direction));
                }
            }
            let lit = (0..LANES).filter(|lane| cos[*lane] > 0.0).fold(0, |lit, lane| lit | 1u16 << lane);
            let free = lit & !self.world.accel.occluded16(&segments, lit, false);
            let light = |lane: usize| if free >> lane & 1 != 0 { cos[lane] } else { 0.0 };
            rays.extend((0..LANES).map(|lane| (tiles[lane] as u16, light(lane))));
            tests += Tests::new(lit, free);
        }
        tests
    }

    /// Traces rays from the point of the given index to lamps.
    fn trace_lamps(&self, point: &SurfacePoint, index: usize, rays: &mut Vec<Option<(u32, bool)>>) -> Tests {
        let (mut sampler, mut tests) = (self.sampler(LAMP_SEED, index), Tests::default());
        let (position, normal) = splat(point);
        let at = Receivers16 { position: &position, normal: &normal, learned: self.learned };
        for _ in 0..self.packets() {
            let (mut choices, mut u) = ([0.0; LANES], Vec2x16::default());
            for (lane, choice) in choices.iter_mut().enumerate() {
                *choice = sampler.next_1d();
                u.set(lane, sampler.next_2d());
            }
            let (chosen, samples) = self.world.emitters.sample_without_environment(at, &choices, &u);
            let (segments, lit) = segments(point, &samples);
            let free = lit & !self.world.accel.occluded16(&segments, lit, false);
            let ray = |lane| (lit >> lane & 1 != 0).then_some((chosen[lane], free >> lane & 1 != 0));
            rays.extend((0..LANES).map(ray));
            tests += Tests::new(lit, free);
        }
        tests
    }
}

/// Returns the segments from a point to sampled lamps, and the lanes whose light may arrive.
fn segments(point: &SurfacePoint, samples: &DirectSamples16) -> (Rays16, u16) {
    let (mut segments, mut lit) = (Rays16::default(), 0);
    for lane in lanes_in(samples.useful()) {
        let direction = samples.direction.get(lane);
        segments.set(lane, &shadow::to_light(point.position, point.geometric_normal, samples, lane));
        lit |= u16::from(weight(point, direction) > 0.0) << lane;
    }
    (segments, lit)
}
