//! VPLs where light is reflected: photon paths from the emitters, a VPL at every hit that reflects diffusely.
//!
//! Paper: Keller, *Instant Radiosity*, 1997; Herzog et al. 2009, section 3: the first hit's reflected light is
//! already indirect, and moderately glossy reflection counts as diffuse where light is deposited.
//! Deviations: paths end by Russian roulette on the luminance they would lose, which keeps VPLs alike in
//! intensity; with interpolated normals, flux is corrected as importance demands (Veach 1997, section 5.3).
//!
//! Paths run in chunks of fixed size and are kept in order, so the VPLs are the same for any number of threads.

use super::emission::PhotonSource;
use super::{LightPassSettings, Origin, Vpl, VplKind, VplSet};
use crate::math::{Rgb, luminance};
use crate::method::Control;
use crate::sampling::{Sampler, hash};
use crate::shadow;
use crate::world::World;
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::FRAC_1_PI;

/// Paths traced by one task.
const CHUNK: u32 = 1024;
/// Chunks in the first wave, from which the yield of the others is guessed.
const FIRST_WAVE: u32 = 16;
/// No more paths are shot for each VPL wanted; reached where most light misses the scene.
const PATHS_PER_VPL: u32 = 32;
/// Edges after which a path is given up: only a closed scene of mirrors gets there.
const MAX_EDGES: u32 = 256;
/// Most a path's survival is worth, so that it ends even where nothing absorbs.
const MAX_SURVIVAL: f32 = 0.98;
/// Largest correction for the difference between shading and geometric normal; a grazing photon would
/// otherwise leave a VPL brighter than all others together.
const MAX_CORRECTION: f32 = 8.0;

/// What tracing photons took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhotonCounts {
    /// Paths shot, by which flux is divided.
    pub paths: u64,
    /// Closest-hit queries.
    pub rays: u64,
}

/// Photons of one chunk: flux not yet divided by the number of paths.
#[derive(Default)]
struct Chunk {
    vpls: Vec<(Vpl, Rgb)>,
    rays: u64,
}

/// About `settings.indirect` indirect VPLs (whole chunks of paths, so a few more), or fewer where light is hard to catch.
pub fn indirect_vpls(
    world: &World,
    settings: &LightPassSettings,
    max_depth: u32,
    control: &Control,
) -> (VplSet, PhotonCounts) {
    let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
    let mut counts = PhotonCounts::default();
    // One edge is the eye's, one joins VPL and receiver.
    let max_edges = max_depth.saturating_sub(2).min(MAX_EDGES);
    let wanted = settings.indirect as usize;
    let source = match PhotonSource::new(world) {
        Some(source) if wanted > 0 && max_edges > 0 => source,
        _ => return (set, counts),
    };
    let seed = hash(settings.seed, 0x1d1d);
    let chunks_limit = (settings.indirect.saturating_mul(PATHS_PER_VPL) / CHUNK).max(FIRST_WAVE);
    let mut photons: Vec<(Vpl, Rgb)> = Vec::with_capacity(wanted + wanted / 8);
    let mut chunks = 0;
    while photons.len() < wanted && chunks < chunks_limit && !control.is_cancelled() {
        let wave = next_wave(chunks, photons.len(), wanted).min(chunks_limit - chunks);
        let traced: Vec<Chunk> = (chunks..chunks + wave)
            .into_par_iter()
            .map(|chunk| trace_chunk(world, &source, chunk, seed, max_edges))
            .collect();
        for chunk in traced {
            counts.rays += chunk.rays;
            // Chunks beyond the one that fills the quota are dropped, so that waves leave no trace.
            if photons.len() < wanted {
                chunks += 1;
                control.advance(chunk.vpls.len() as u64);
                photons.extend(chunk.vpls);
            }
        }
    }
    counts.paths = u64::from(chunks) * u64::from(CHUNK);
    let share = 1.0 / counts.paths.max(1) as f32;
    for (vpl, flux) in photons {
        set.push(vpl, flux * share);
    }
    (set, counts)
}

/// Chunks to trace next: as many as the yield so far suggests, a tenth fewer, so that little is thrown away.
fn next_wave(chunks: u32, found: usize, wanted: usize) -> u32 {
    if chunks == 0 {
        return FIRST_WAVE;
    }
    let yield_per_chunk = found as f64 / f64::from(chunks);
    let missing = (wanted - found) as f64;
    let guess = if yield_per_chunk > 0.0 { 0.9 * missing / yield_per_chunk } else { f64::from(chunks) };
    (guess as u32).clamp(4, 4096)
}

fn trace_chunk(world: &World, source: &PhotonSource, chunk: u32, seed: u32, max_edges: u32) -> Chunk {
    let mut result = Chunk::default();
    for path in chunk * CHUNK..(chunk + 1) * CHUNK {
        trace_path(world, source, &mut Sampler::new(seed, path), max_edges, &mut result);
    }
    result
}

fn trace_path(
    world: &World,
    source: &PhotonSource,
    sampler: &mut Sampler,
    max_edges: u32,
    result: &mut Chunk,
) {
    let Some((mut ray, mut flux)) = source.sample(sampler) else { return };
    for edge in 1..=max_edges {
        result.rays += 1;
        let Some(surface) = world.intersect(&ray) else { return };
        let towards_light = -ray.direction;
        let wi = surface.frame.to_local(towards_light);
        let cos_g = surface.normal.dot(towards_light);
        if wi.z * cos_g <= 0.0 {
            return; // the two normals disagree on which side this is
        }
        let correction = (wi.z / cos_g).min(MAX_CORRECTION);
        let bsdf = world.bsdf(&surface);
        let albedo = bsdf.diffuse_albedo(wi);
        if albedo != Rgb::ZERO {
            let normal: Vec3 = if cos_g > 0.0 { surface.normal } else { -surface.normal };
            let intensity = flux * albedo * (correction * FRAC_1_PI);
            result.vpls.push((Vpl::oriented(surface.position, normal), intensity));
        }
        if edge == max_edges {
            return;
        }
        let (u_lobe, u_direction, u_survival) = (sampler.next_1d(), sampler.next_2d(), sampler.next_1d());
        let Some(s) = bsdf.sample(wi, u_lobe, u_direction) else { return };
        let direction = surface.frame.to_world(s.wi);
        let out_g = surface.normal.dot(direction);
        if out_g * s.wi.z <= 0.0 {
            return;
        }
        let back = (out_g / s.wi.z).min(MAX_CORRECTION);
        // Delta lobes turn the whole pencil of rays, normals and all.
        let corrected = if s.delta { 1.0 } else { correction * back };
        let next = flux * s.weight * (s.eta * s.eta * corrected);
        let survival = (luminance(next) / luminance(flux)).min(MAX_SURVIVAL);
        if !next.is_finite() || u_survival >= survival {
            return;
        }
        flux = next / survival;
        ray = shadow::ray_from(surface.position, surface.normal, direction);
    }
}
