//! Places where light from infinitely far reaches surfaces that contribute indirect light to the image. Short pilot
//! paths from visible points find them.

use super::far::FarLights;
use super::walk::{Carried, Walk, WalkVertex};
use base::math::{Frame, Rgb, luminance};
use base::parallel::ShortRuns;
use base::sampling::{Sampler, cosine_hemisphere, hash};
use embree::Ray;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::ControlFlow;
use world::shadow;
use world::{SurfacePoint, World};

/// Number of light samples per vertex of a path.
const LIGHT_SAMPLES: u32 = 12;

/// Maximum number of diffuse or glossy surfaces of a path.
const SURFACES: u32 = 2;

/// Maximum number of edges of a path, mirrors and glass included.
const MAX_EDGES: u32 = 8;

/// Place where light reaches a surface.
pub(super) struct LightEntry {
    /// Position on the surface.
    pub place: Vec3,
    /// Source of the light.
    pub source: usize,
    /// Unit vector to the source.
    pub towards: Vec3,
    /// Luminance that the light adds to the indirect light of a visible point, up to a constant factor. It is relative
    /// to the light of this point plus that of the mean point, since errors are as visible in darker places.
    pub weight: f32,
}

/// Finds entries by one path from each of the points `seen` by the eye.
pub(super) fn entries(
    world: &World,
    lights: &FarLights,
    seen: &[SurfacePoint],
    seed: u32,
) -> Vec<LightEntry> {
    let seed = hash(seed, 0x51c1);
    let walk = Walk { world, carried: Carried::Importance, max_edges: MAX_EDGES, by_delta: false };
    let from = |(number, start): (usize, &SurfacePoint)| {
        let (mut found, mut surfaces) = (Vec::new(), 0);
        let sampler = &mut Sampler::new(seed, number as u32);
        let direction = Frame::from_normal(start.normal).to_world(cosine_hemisphere(sampler.next_2d()));
        let ray = shadow::ray_from(start.position, start.geometric_normal, direction);
        walk.follow(ray, Rgb::ONE, sampler, |met, sampler| {
            if met.bsdf.has_smooth() {
                surfaces += 1;
                sample_light(world, lights, met, sampler, &mut found);
            }
            if surfaces == SURFACES { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        found
    };
    let mut found: Vec<Vec<LightEntry>> = seen.par_iter().in_short_runs().enumerate().map(from).collect();
    let light = |entries: &Vec<LightEntry>| entries.iter().map(|entry| f64::from(entry.weight)).sum::<f64>();
    let mean = found.iter().map(light).sum::<f64>() / found.len().max(1) as f64;
    for entries in &mut found {
        let scale = 1.0 / (light(entries) + mean);
        entries.iter_mut().for_each(|entry| entry.weight = (f64::from(entry.weight) * scale) as f32);
    }
    found.into_iter().flatten().collect()
}

/// Samples light at a vertex of a path and adds the light that arrives.
fn sample_light(
    world: &World,
    lights: &FarLights,
    met: &WalkVertex,
    sampler: &mut Sampler,
    found: &mut Vec<LightEntry>,
) {
    let (place, normal) = (met.surface.position, met.surface.normal);
    for _ in 0..LIGHT_SAMPLES {
        let source = lights.source(sampler.next_1d());
        let Some(light) = lights.sample(source, sampler.next_2d()) else { continue };
        let wi = met.surface.frame.to_local(light.towards);
        let reflected = met.weight * met.bsdf.eval(met.wo, wi) * light.irradiance * wi.z.abs();
        let weight = luminance(reflected) / lights.probability(source);
        let is_free = || is_free(world, shadow::ray_from(place, normal, light.towards));
        if weight > 0.0 && weight.is_finite() && is_free() {
            found.push(LightEntry { place, source, towards: light.towards, weight });
        }
    }
}

/// True if nothing blocks a ray. Mirrors and glass count as if they transmitted light straight.
fn is_free(world: &World, mut ray: Ray) -> bool {
    if !world.specular.has_delta_lobes() {
        return !world.accel.occluded(&ray);
    }
    for _ in 0..MAX_EDGES {
        let Some(surface) = world.intersect(&ray) else { return true };
        if !world.bsdf(&surface).has_delta() {
            return false;
        }
        let rest = ray.t_far - surface.t;
        ray = Ray { t_far: rest, ..shadow::ray_from(surface.position, surface.normal, ray.direction) };
    }
    false
}
