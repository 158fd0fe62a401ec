//! Photon paths from the emitters, with a photon stored at every hit that reflects diffusely.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996; Keller, *Instant Radiosity*, 1997.
//! Deviations: paths end by Russian roulette on the luminance they would lose, which keeps the powers of
//! photons similar; with interpolated normals, flux is corrected as for importance (Veach 1997, section 5.3).
//!
//! Paths run in chunks of fixed size and are kept in order, so the photons are the same for any number of
//! threads.
//! Units: flux in watts, to be divided by the number of paths.

use super::{EmissionSample, PhotonEmitter};
use base::math::{Rgb, luminance};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::sampling::{Sampler, hash};
use glam::Vec3;
use rayon::prelude::*;
use world::material::Bsdf;
use world::shadow;
use world::{SurfacePoint, World};

/// Number of paths traced by one task.
const CHUNK: u32 = 1024;
/// Number of chunks in the first wave, from which the yield of the others is estimated.
const FIRST_WAVE: u32 = 16;
/// Maximum number of paths for each photon asked for; reached where most light misses the scene.
const PATHS_PER_PHOTON: u32 = 32;
/// Maximum number of edges of a path: only a closed scene of mirrors reaches it.
const MAX_EDGES: u32 = 256;
/// Maximum probability of survival, so that a path ends even if nothing absorbs.
const MAX_SURVIVAL: f32 = 0.98;
/// Number of chunks of aimed paths, and of others, that tell how many photons they leave.
const TRIED: u32 = 4;
/// Gain from which on paths are aimed; that from which on fewer photons do, in inverse proportion; and the least number
/// of those that go anywhere, over that of all photons if none is aimed.
///
/// Rare photons that were not aimed bring more noise than the gain says. With an eighth of them instead of a quarter,
/// what a class room's windows show is up to a fifth too dark, since much of their light is clamped.
const LEAST_GAIN: f32 = 1.5;
const ENOUGH: f32 = 2.0;
const LEAST_ANYWHERE: f32 = 0.25;
/// Maximum correction for the difference between shading and geometric normal; a grazing photon would
/// otherwise leave a VPL brighter than all others together.
pub const MAX_CORRECTION: f32 = 8.0;

/// Counts of tracing photons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhotonCounts {
    /// Number of paths, by which flux is divided.
    pub paths: u64,
    /// Number of closest-hit queries.
    pub rays: u64,
    /// Photons that would be as good if none were aimed, over their number; 0 if none is.
    pub gain: f32,
}

/// A photon: light arriving at a surface.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal on the side it arrives at.
    pub normal: Vec3,
    /// Unit vector back along its path.
    pub towards_light: Vec3,
    /// Flux, to be divided by the number of paths.
    pub flux: Rgb,
    /// Diffusely reflected share of it; not 0.
    pub albedo: Rgb,
}

/// A photon, and how the surface reflects it.
pub struct PhotonHit<'a> {
    /// The photon.
    pub photon: Photon,
    /// Reflection of the surface.
    pub bsdf: &'a Bsdf<'a>,
    /// Direction back along its path in the shading frame.
    pub wi: Vec3,
    /// Unit shading normal on the side it arrives at.
    pub shading_normal: Vec3,
}

/// Settings of photon tracing.
#[derive(Clone, Copy, Debug)]
pub struct PhotonSettings<'a> {
    /// Approximate number of photons (whole chunks of paths, so a few more), or fewer where few paths hit a surface, or
    /// where they are aimed.
    pub photons: u32,
    /// Points whose indirect light is wanted; if there are none, photons are not aimed.
    pub seen: &'a [SurfacePoint],
    /// Maximum number of edges of a path.
    pub max_edges: u32,
    /// Seed of the paths.
    pub seed: u32,
}

/// Photons of one chunk.
struct Chunk<T> {
    kept: Vec<T>,
    rays: u64,
}

/// Traces photons, maps what is known of each by `keep`, and returns the results in order.
pub fn trace_photons<T: Send>(
    world: &World,
    settings: &PhotonSettings,
    control: &Control,
    keep: impl Fn(&PhotonHit) -> T + Sync,
) -> (Vec<T>, PhotonCounts) {
    let mut counts = PhotonCounts::default();
    let max_edges = settings.max_edges.min(MAX_EDGES);
    let mut source = match PhotonEmitter::new(world) {
        Some(source) if settings.photons > 0 && max_edges > 0 => source,
        _ => return (Vec::new(), counts),
    };
    let mut wanted = settings.photons as usize;
    let aimed = aim(world, &mut source, settings, max_edges, &mut counts);
    let far = source.share_by_worth(settings.seen, settings.seed);
    if let Some((gain, anywhere)) = aimed {
        counts.gain = gain;
        let fewer = (ENOUGH / gain).max(LEAST_ANYWHERE / anywhere).min(1.0);
        // Lamps are not aimed: where they count, they have as many as without aims.
        wanted = (wanted as f32 * (1.0 - far.unwrap_or(1.0) * (1.0 - fewer))) as usize;
    }
    let seed = hash(settings.seed, 0x1d1d);
    let chunks_limit = (settings.photons.saturating_mul(PATHS_PER_PHOTON) / CHUNK).max(FIRST_WAVE);
    let mut photons: Vec<T> = Vec::with_capacity(wanted + wanted / 8);
    let mut chunks = 0;
    while photons.len() < wanted && chunks < chunks_limit && !control.is_cancelled() {
        let wave = next_wave(chunks, photons.len(), wanted).min(chunks_limit - chunks);
        let traced: Vec<Chunk<T>> = (chunks..chunks + wave)
            .into_par_iter()
            .one_by_one()
            .map(|chunk| match control.is_cancelled() {
                true => Chunk { kept: Vec::new(), rays: 0 },
                false => trace_chunk(world, &source, chunk, seed, max_edges, &keep),
            })
            .collect();
        for chunk in traced {
            // Some of the wave may not have been traced.
            if control.is_cancelled() {
                break;
            }
            counts.rays += chunk.rays;
            // Chunks beyond the one that fills the quota are dropped, so that the result does not depend on
            // the waves.
            if photons.len() < wanted {
                chunks += 1;
                control.advance(chunk.kept.len() as u64);
                photons.extend(chunk.kept);
            }
        }
    }
    counts.paths = u64::from(chunks) * u64::from(CHUNK);
    (photons, counts)
}

/// Aims the paths of a source; returns the gain and the share of paths that go anywhere, or `None` if aims were not
/// worth it and none are set. Gain is the mean flux of photons that bring light to points seen if paths are not aimed,
/// over that of as many photons of paths that are: most of the former leave fewer photons, outside.
fn aim(
    world: &World,
    source: &mut PhotonEmitter,
    settings: &PhotonSettings,
    max_edges: u32,
    counts: &mut PhotonCounts,
) -> Option<(f32, f32)> {
    let aims = source.aims(settings.seen, settings.seed)?;
    let seed = hash(settings.seed, 0xa14d);
    let mut photons = |source: &PhotonEmitter| -> f32 {
        let trace = |chunk| trace_chunk(world, source, chunk, seed, max_edges, &|_| ());
        let traced: Vec<Chunk<()>> = (0..TRIED).into_par_iter().one_by_one().map(trace).collect();
        counts.rays += traced.iter().map(|chunk| chunk.rays).sum::<u64>();
        traced.iter().map(|chunk| chunk.kept.len() as f32).sum()
    };
    let (gain, share, not_aimed) = (aims.gain(), aims.anywhere(), photons(source));
    source.aims = Some(aims);
    let gain = gain * not_aimed / photons(source).max(1.0);
    if gain >= LEAST_GAIN {
        return Some((gain, share));
    }
    source.aims = None;
    None
}

/// Number of chunks to trace next, according to the yield so far, less a tenth, so that little is discarded.
fn next_wave(chunks: u32, found: usize, wanted: usize) -> u32 {
    if chunks == 0 {
        return FIRST_WAVE;
    }
    let yield_per_chunk = found as f64 / f64::from(chunks);
    let missing = (wanted - found) as f64;
    let guess = if yield_per_chunk > 0.0 { 0.9 * missing / yield_per_chunk } else { f64::from(chunks) };
    (guess as u32).clamp(4, 4096)
}

fn trace_chunk<T>(
    world: &World,
    source: &PhotonEmitter,
    chunk: u32,
    seed: u32,
    max_edges: u32,
    keep: &impl Fn(&PhotonHit) -> T,
) -> Chunk<T> {
    let mut kept = Vec::new();
    let mut rays = 0;
    for path in chunk * CHUNK..(chunk + 1) * CHUNK {
        let sampler = &mut Sampler::new(seed, path);
        rays += trace_path(world, source, sampler, max_edges, &mut |hit| kept.push(keep(hit)));
    }
    Chunk { kept, rays }
}

/// Follows a path; returns the number of rays traced.
fn trace_path(
    world: &World,
    source: &PhotonEmitter,
    sampler: &mut Sampler,
    max_edges: u32,
    met: &mut impl FnMut(&PhotonHit),
) -> u64 {
    let Some(EmissionSample { mut ray, mut flux, .. }) = source.sample(sampler) else { return 0 };
    for edge in 1..=max_edges {
        let rays = u64::from(edge);
        let Some(surface) = world.intersect(&ray) else { return rays };
        let towards_light = -ray.direction;
        let wi = surface.frame.to_local(towards_light);
        let cos_g = surface.normal.dot(towards_light);
        if wi.z * cos_g <= 0.0 {
            return rays; // the two normals disagree on which side this is
        }
        let correction = (wi.z / cos_g).min(MAX_CORRECTION);
        let bsdf = world.bsdf(&surface);
        let albedo = bsdf.diffuse_albedo(wi);
        if albedo != Rgb::ZERO {
            let normal: Vec3 = if cos_g > 0.0 { surface.normal } else { -surface.normal };
            let (position, flux) = (surface.position, flux * correction);
            let photon = Photon { position, normal, towards_light, flux, albedo };
            let shading_normal = surface.frame.normal * wi.z.signum();
            met(&PhotonHit { photon, bsdf: &bsdf, wi, shading_normal });
        }
        if edge == max_edges {
            return rays;
        }
        let (u_lobe, u_direction, u_survival) = (sampler.next_1d(), sampler.next_2d(), sampler.next_1d());
        let Some(s) = bsdf.sample(wi, u_lobe, u_direction) else { return rays };
        let direction = surface.frame.to_world(s.wi);
        let out_g = surface.normal.dot(direction);
        if out_g * s.wi.z <= 0.0 {
            return rays;
        }
        let back = (out_g / s.wi.z).min(MAX_CORRECTION);
        // A delta lobe transforms the whole pencil of rays, normals included.
        let corrected = if s.delta { 1.0 } else { correction * back };
        let next = flux * s.weight * (s.eta * s.eta * corrected);
        let survival = (luminance(next) / luminance(flux)).min(MAX_SURVIVAL);
        if !next.is_finite() || u_survival >= survival {
            return rays;
        }
        flux = next / survival;
        ray = shadow::ray_from(surface.position, surface.normal, direction);
    }
    u64::from(max_edges)
}
