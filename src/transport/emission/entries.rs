//! Places where light from infinitely far reaches surfaces that contribute indirect light to the image. Short pilot
//! paths from visible points find them.

use super::far::FarLights;
use super::short_paths::{follow, is_free};
use base::math::luminance;
use base::parallel::ShortRuns;
use base::sampling::{Sampler, hash};
use glam::Vec3;
use rayon::prelude::*;
use world::shadow;
use world::{SurfacePoint, World};

/// Number of light samples per vertex of a path.
const LIGHT_SAMPLES: u32 = 12;

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
    let from = |(number, start): (usize, &SurfacePoint)| {
        let mut found = Vec::new();
        follow(world, start, &mut Sampler::new(seed, number as u32), |met, sampler| {
            for _ in 0..LIGHT_SAMPLES {
                let source = lights.source(sampler.next_1d());
                let Some(light) = lights.sample(source, sampler.next_2d()) else { continue };
                let weight =
                    luminance(met.reflected(light.towards, light.irradiance)) / lights.probability(source);
                let (place, normal) = (met.surface.position, met.surface.normal);
                let is_free = || is_free(world, shadow::ray_from(place, normal, light.towards));
                if weight > 0.0 && weight.is_finite() && is_free() {
                    found.push(LightEntry { place, source, towards: light.towards, weight });
                }
            }
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
