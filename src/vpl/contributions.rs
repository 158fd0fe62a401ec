//! Parts that emitters have of the indirect light that the eye sees, and the numbers of photons by them.
//!
//! By their power alone, a hall beside a dim room has nearly all photons, and so has a sky over a plain of which a
//! window shows a little: the lamp in the room has a few virtual lights, each so bright that it is clamped.
//!
//! Deviations: emitters share paths by what these bring to the eye, where Keller's *Instant Radiosity* and the paper
//! have them in proportion to power. What an emitter gives is estimated by short paths from some of the points seen.

use crate::embree::Rays16;
use crate::light::{DiscreteDistribution, Receivers16};
use crate::math::{Frame, LANES, Rgb, Vec2x16, Vec3x16, lanes_in, luminance};
use crate::parallel::ShortRuns;
use crate::sampling::{Sampler, cosine_hemisphere, hash};
use crate::shadow;
use crate::world::{Surface, SurfacePoint, World};
use rayon::prelude::*;

/// Number of the points seen for each that a path begins at.
const POINTS_A_PATH: usize = 4;

/// Number of points below which they say too little.
const FEW: usize = 256;

/// Number of surfaces that a path finds, each lit by sixteen samples, and the maximum number of its edges.
const SURFACES: u32 = 2;
const MAX_EDGES: u32 = 8;

/// Share of the paths that emitters have by power as before, since few paths say nothing of what rarely lights.
const BY_POWER: f32 = 0.25;

/// Factor on the variance of the light from which on sharing by power is worth a change.
const LEAST_GAIN: f64 = 1.5;

/// Luminances that emitters give to points seen, found by one path from each.
type Found = Vec<(u32, f64)>;

/// Paths by emitter, if those `by_power` are a bad choice for the indirect light of the points `seen`.
pub(super) fn shares(
    world: &World,
    by_power: &DiscreteDistribution,
    seen: &[SurfacePoint],
    seed: u32,
) -> Option<DiscreteDistribution> {
    let starts: Vec<SurfacePoint> = seen.iter().step_by(POINTS_A_PATH).copied().collect();
    if by_power.len() < 2 || starts.len() < FEW {
        return None;
    }
    let seed = hash(seed, 0x5ea2);
    let from = |(number, start): (usize, &SurfacePoint)| {
        let mut found = Vec::new();
        follow(world, start, &mut Sampler::new(seed, number as u32), &mut found);
        found
    };
    let found: Vec<Found> = starts.par_iter().in_short_runs().enumerate().map(from).collect();
    let all = parts(&found, by_power.len(), |_| true)?;
    // Measured by other paths than those by which the shares are chosen, and no path by itself.
    let chosen = mixed(by_power, &parts(&found, by_power.len(), |path| path % 2 == 0)?);
    let [a, b] = [1, 3].map(|rest| parts(&found, by_power.len(), |path| path % 4 == rest));
    let (a, b) = (a?, b?);
    let variance = |paths: &DiscreteDistribution| -> f64 {
        (0..paths.len()).map(|i| a[i] * b[i] / f64::from(paths.probability(i)).max(f64::MIN_POSITIVE)).sum()
    };
    let better = variance(by_power) >= LEAST_GAIN * variance(&chosen);
    better.then(|| mixed(by_power, &all))
}

/// Parts of all light by emitter, of some of the paths; errors are as visible in places with less light. `None` if they
/// found none.
fn parts(found: &[Found], emitters: usize, is_wanted: impl Fn(usize) -> bool) -> Option<Vec<f64>> {
    let light = |found: &Found| found.iter().map(|(_, y)| y).sum::<f64>();
    let mean = found.iter().map(light).sum::<f64>() / found.len() as f64;
    let mut parts = vec![0.0; emitters];
    for (_, found) in found.iter().enumerate().filter(|(path, _)| is_wanted(*path)) {
        let scale = 1.0 / (light(found) + mean);
        found.iter().for_each(|(emitter, y)| parts[*emitter as usize] += y * scale);
    }
    let all: f64 = parts.iter().sum();
    parts.iter_mut().for_each(|part| *part /= all);
    (all > 0.0 && all.is_finite()).then_some(parts)
}

/// Paths in proportion to parts of the light, some by power.
fn mixed(by_power: &DiscreteDistribution, parts: &[f64]) -> DiscreteDistribution {
    let share =
        |(i, part): (usize, &f64)| (1.0 - BY_POWER) * *part as f32 + BY_POWER * by_power.probability(i);
    DiscreteDistribution::new(parts.iter().enumerate().map(share))
}

/// Follows a path from a point, and finds the light that emitters bring to it by one more reflection.
fn follow(world: &World, start: &SurfacePoint, sampler: &mut Sampler, found: &mut Found) {
    let direction = Frame::from_normal(start.normal).to_world(cosine_hemisphere(sampler.next_2d()));
    let mut ray = shadow::ray_from(start.position, start.geometric_normal, direction);
    let (mut throughput, mut surfaces) = (Rgb::ONE, 0);
    for _ in 0..MAX_EDGES {
        let Some(surface) = world.intersect(&ray) else { return };
        let bsdf = world.bsdf(&surface);
        let wo = surface.frame.to_local(-ray.direction);
        if bsdf.has_smooth() {
            surfaces += 1;
            let reflected = |direction, radiance| {
                let wi = surface.frame.to_local(direction);
                luminance(throughput * bsdf.eval(wo, wi) * radiance * wi.z.abs())
            };
            look(world, &surface, -ray.direction, sampler, reflected, found);
            if surfaces == SURFACES {
                return;
            }
        }
        let Some(s) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d()) else { return };
        throughput *= s.weight;
        ray = shadow::ray_from(surface.position, surface.normal, surface.frame.to_world(s.wi));
    }
}

/// Adds what sixteen samples of the emitters give at a surface, by the luminance `reflected` of radiance from a
/// direction.
fn look(
    world: &World,
    surface: &Surface,
    out: glam::Vec3,
    sampler: &mut Sampler,
    reflected: impl Fn(glam::Vec3, Rgb) -> f32,
    found: &mut Found,
) {
    let (mut choices, mut places) = ([0.0; LANES], Vec2x16::default());
    for (lane, choice) in choices.iter_mut().enumerate() {
        *choice = sampler.next_1d();
        places.set(lane, sampler.next_2d());
    }
    let (x, normal) = (surface.position, surface.frame.normal);
    let (position, normals) =
        (Vec3x16::splat(x), Vec3x16::splat(if out.dot(normal) < 0.0 { -normal } else { normal }));
    let at = Receivers16 { position: &position, normal: &normals, learned: None };
    let (chosen, samples) = world.emitters.sample_all(&world.scene, at, &choices, &places);
    let (mut segments, mut lit, mut light) = (Rays16::default(), 0u16, [0.0; LANES]);
    for lane in lanes_in(samples.useful()) {
        let (direction, distance) = (samples.direction.get(lane), samples.distance[lane]);
        let y = reflected(direction, samples.radiance.get(lane)) / samples.pdf[lane];
        if !(y > 0.0 && y.is_finite()) {
            continue;
        }
        let segment = match distance < f32::INFINITY {
            true => shadow::segment(x, surface.normal, x + direction * distance, samples.normal.get(lane)),
            false => shadow::ray_from(x, surface.normal, direction),
        };
        segments.set(lane, &segment);
        light[lane] = y;
        lit |= 1 << lane;
    }
    let free = lit & !world.accel.occluded16(&segments, lit, false);
    found.extend(lanes_in(free).map(|lane| (chosen[lane], f64::from(light[lane]))));
}
