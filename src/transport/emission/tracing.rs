//! Photon paths: a photon is stored at every hit that reflects diffusely.

use super::plan::EmitterPlan;
use super::walk::{Carried, Walk, WalkVertex};
use super::{EmissionSample, Photon, PhotonEmitter, PhotonHit};
use base::math::Rgb;
use base::sampling::Sampler;
use glam::Vec3;
use std::ops::ControlFlow;

/// Number of paths traced by one task.
pub(super) const CHUNK: u32 = 1024;

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
        let Some(EmissionSample { ray, flux, .. }) = self.plan.sample(self.emitter, sampler) else {
            return 0;
        };
        let (world, max_edges) = (self.emitter.world, self.max_edges);
        let walk = Walk { world, carried: Carried::Flux, max_edges, by_delta: false };
        walk.follow(ray, flux, sampler, |at, _| {
            let WalkVertex { surface, bsdf, back, wo, weight: flux, edges, .. } = *at;
            let albedo = bsdf.diffuse_albedo(wo);
            if albedo != Rgb::ZERO {
                let normal: Vec3 =
                    if surface.normal.dot(back) > 0.0 { surface.normal } else { -surface.normal };
                let photon = Photon { position: surface.position, normal, towards_light: back, flux, albedo };
                let shading_normal = surface.frame.normal * wo.z.signum();
                met(&PhotonHit { photon, bsdf, wi: wo, shading_normal, edges });
            }
            ControlFlow::Continue(())
        })
    }
}
