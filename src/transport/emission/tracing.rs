//! Photon paths: a photon is stored at every hit that reflects diffusely.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996; Keller, *Instant Radiosity*, 1997.
//! Deviations: paths end by Russian roulette on the luminance they would lose, which keeps the powers of
//! photons similar. With interpolated normals, flux is corrected as for importance (Veach 1997, section 5.3).

use super::plan::EmitterPlan;
use super::{EmissionSample, Photon, PhotonEmitter, PhotonHit};
use base::math::{Rgb, luminance};
use base::sampling::Sampler;
use glam::Vec3;
use world::{Interior, shadow};

/// Number of paths traced by one task.
pub(super) const CHUNK: u32 = 1024;

/// Maximum number of edges of a path: only a closed scene of mirrors reaches it.
pub(super) const MAX_EDGES: u32 = 256;

/// Maximum probability of survival, so that a path ends even if nothing absorbs.
const MAX_SURVIVAL: f32 = 0.98;

/// Maximum correction for the difference between shading and geometric normal. Without it, a grazing photon could leave
/// a VPL brighter than all others together.
pub const MAX_CORRECTION: f32 = 8.0;

/// Photons of one chunk of paths.
pub(super) struct PhotonChunk<T> {
    pub photons: Vec<T>,
    /// Number of closest-hit queries.
    pub rays: u64,
}

/// Paths of one plan.
#[derive(Clone, Copy)]
pub(super) struct PathTracer<'a, 'w> {
    pub emitter: &'a PhotonEmitter<'w>,
    pub plan: &'a EmitterPlan<'w>,
    pub seed: u32,
    /// Maximum number of edges of a path.
    pub max_edges: u32,
}

impl PathTracer<'_, '_> {
    /// Traces the paths of one chunk and maps every photon by `keep`.
    pub fn chunk<T>(&self, chunk: u32, keep: &impl Fn(&PhotonHit) -> T) -> PhotonChunk<T> {
        let (mut photons, mut rays) = (Vec::new(), 0);
        for path in chunk * CHUNK..(chunk + 1) * CHUNK {
            let sampler = &mut Sampler::new(self.seed, path);
            rays += self.path(sampler, &mut |hit| photons.push(keep(hit)));
        }
        // Chunks wait for all others.
        photons.shrink_to_fit();
        PhotonChunk { photons, rays }
    }

    /// Follows a path and passes every photon to `met`; returns the number of rays traced.
    fn path(&self, sampler: &mut Sampler, met: &mut impl FnMut(&PhotonHit)) -> u64 {
        let Some(EmissionSample { mut ray, mut flux, .. }) = self.plan.sample(self.emitter, sampler) else {
            return 0;
        };
        let world = self.emitter.world;
        let mut interior = Interior::NONE;
        for edge in 1..=self.max_edges {
            let rays = u64::from(edge);
            let Some(surface) = world.intersect(&ray) else { return rays };
            if world.absorbs() {
                flux *= world.edge_shares(interior, &surface, ray.direction, ray.t_near)[1];
            }
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
            if edge == self.max_edges {
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
            interior = world.interior_after(interior, &surface, direction, s.straight);
            ray = shadow::ray_from(surface.position, surface.normal, direction);
        }
        u64::from(self.max_edges)
    }
}
