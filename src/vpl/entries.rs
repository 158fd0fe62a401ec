//! Places where light from infinitely far comes to surfaces whose reflected light the eye may see, found by short paths
//! from surfaces that it sees.

use super::far::FarLights;
use crate::math::{Frame, Rgb, luminance};
use crate::parallel::ShortRuns;
use crate::sampling::{Sampler, cosine_hemisphere, hash};
use crate::shadow;
use crate::world::{SurfacePoint, World};
use glam::Vec3;
use rayon::prelude::*;

/// Number of surfaces that a path finds, and of looks from each to the lights.
const SURFACES: u32 = 2;
const LOOKS: u32 = 12;

/// Maximum number of edges, mirrors and glass included.
const MAX_EDGES: u32 = 8;

/// A place where light comes to a surface.
pub(super) struct Entry {
    pub place: Vec3,
    /// Source of the light.
    pub source: usize,
    /// Unit vector to it.
    pub towards: Vec3,
    /// Luminance that it adds to the indirect light of a point that the eye sees, over the light of that point and of
    /// the mean one, up to a factor: errors are as visible in places with less of it.
    pub weight: f32,
}

/// Finds them by one path from each of the points `seen` by the eye.
pub(super) fn entries(world: &World, lights: &FarLights, seen: &[SurfacePoint], seed: u32) -> Vec<Entry> {
    let seed = hash(seed, 0x51c1);
    let from = |(number, start): (usize, &SurfacePoint)| {
        let mut found = Vec::new();
        follow(world, lights, start, &mut Sampler::new(seed, number as u32), &mut found);
        found
    };
    let mut found: Vec<Vec<Entry>> = seen.par_iter().in_short_runs().enumerate().map(from).collect();
    let light = |entries: &Vec<Entry>| entries.iter().map(|entry| f64::from(entry.weight)).sum::<f64>();
    let mean = found.iter().map(light).sum::<f64>() / found.len().max(1) as f64;
    for entries in &mut found {
        let scale = 1.0 / (light(entries) + mean);
        entries.iter_mut().for_each(|entry| entry.weight = (f64::from(entry.weight) * scale) as f32);
    }
    found.into_iter().flatten().collect()
}

fn follow(
    world: &World,
    lights: &FarLights,
    start: &SurfacePoint,
    sampler: &mut Sampler,
    found: &mut Vec<Entry>,
) {
    let direction = Frame::from_normal(start.normal).to_world(cosine_hemisphere(sampler.next_2d()));
    let mut ray = shadow::ray_from(start.position, start.geometric_normal, direction);
    let (mut throughput, mut surfaces) = (Rgb::ONE, 0);
    for _ in 0..MAX_EDGES {
        let Some(surface) = world.intersect(&ray) else { return };
        let bsdf = world.bsdf(&surface);
        let wo = surface.frame.to_local(-ray.direction);
        if bsdf.has_smooth() {
            surfaces += 1;
            for _ in 0..LOOKS {
                let source = lights.source(sampler.next_1d());
                let Some(light) = lights.sample(source, sampler.next_2d()) else { continue };
                let wi = surface.frame.to_local(light.towards);
                let reflected = throughput * bsdf.eval(wo, wi) * light.irradiance * wi.z.abs();
                let weight = luminance(reflected) / lights.probability(source);
                if weight > 0.0
                    && weight.is_finite()
                    && is_free(world, surface.position, surface.normal, light.towards)
                {
                    found.push(Entry { place: surface.position, source, towards: light.towards, weight });
                }
            }
            if surfaces == SURFACES {
                return;
            }
        }
        let Some(s) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d()) else { return };
        throughput *= s.weight;
        ray = shadow::ray_from(surface.position, surface.normal, surface.frame.to_world(s.wi));
    }
}

/// True if light may come straight to a point, also through glass as if it did not bend light.
fn is_free(world: &World, x: Vec3, normal: Vec3, towards: Vec3) -> bool {
    let mut ray = shadow::ray_from(x, normal, towards);
    if !world.specular.has_delta_lobes() {
        return !world.accel.occluded(&ray);
    }
    for _ in 0..MAX_EDGES {
        let Some(surface) = world.intersect(&ray) else { return true };
        if !world.bsdf(&surface).has_delta() {
            return false;
        }
        ray = shadow::ray_from(surface.position, surface.normal, towards);
    }
    false
}
