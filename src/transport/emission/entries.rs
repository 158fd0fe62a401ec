//! Places where light from infinitely far comes to surfaces whose reflected light the eye may see, found by short paths
//! from surfaces that it sees.

use super::far::FarLights;
use super::short_paths::{follow, is_free};
use base::math::luminance;
use base::parallel::ShortRuns;
use base::sampling::{Sampler, hash};
use glam::Vec3;
use rayon::prelude::*;
use world::shadow;
use world::{SurfacePoint, World};

/// Number of looks from each surface that a path finds to the lights.
const LOOKS: u32 = 12;

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
        follow(world, start, &mut Sampler::new(seed, number as u32), |met, sampler| {
            for _ in 0..LOOKS {
                let source = lights.source(sampler.next_1d());
                let Some(light) = lights.sample(source, sampler.next_2d()) else { continue };
                let weight =
                    luminance(met.reflected(light.towards, light.irradiance)) / lights.probability(source);
                let (place, normal) = (met.surface.position, met.surface.normal);
                let is_free = || is_free(world, shadow::ray_from(place, normal, light.towards));
                if weight > 0.0 && weight.is_finite() && is_free() {
                    found.push(Entry { place, source, towards: light.towards, weight });
                }
            }
        });
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
