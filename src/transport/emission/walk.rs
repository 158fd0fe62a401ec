//! Walks through a scene, from surface to surface: those of photons, and those of importance from visible points.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996; Keller, *Instant Radiosity*, 1997; Veach, *Robust
//! Monte Carlo Methods for Light Transport Simulation*, 1997, section 5.3 (flux under interpolated normals).
//! Deviations: a photon survives Russian roulette with the luminance that it keeps, so that powers stay similar.

use base::math::{Rgb, luminance};
use base::sampling::Sampler;
use embree::Ray;
use glam::Vec3;
use std::ops::ControlFlow;
use world::material::{Bsdf, BsdfSample};
use world::{Interior, Surface, World, beyond, shadow};

/// Maximum number of edges of a photon's walk: only a closed scene of mirrors reaches it.
pub const MAX_EDGES: u32 = 256;

/// Maximum probability of survival, so that a walk ends even if nothing absorbs.
const MAX_SURVIVAL: f32 = 0.98;

/// Maximum correction for the difference between shading and geometric normal. Without it, a grazing photon could leave
/// a VPL brighter than all others together.
const MAX_CORRECTION: f32 = 8.0;

/// Quantity that a walk carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// Flux from emitters, in watts.
    Flux,
    /// Importance from the eye. The walk is too short for Russian roulette.
    Importance,
}

/// Rules of a walk.
#[derive(Clone, Copy)]
pub struct Walk<'w> {
    /// Scene.
    pub world: &'w World,
    /// Quantity that it carries.
    pub carried: Carried,
    /// Maximum number of edges.
    pub max_edges: u32,
    /// True if it continues by delta lobes alone.
    pub by_delta: bool,
}

/// Surface that a walk has met.
pub struct WalkVertex<'a> {
    /// Surface.
    pub surface: &'a Surface,
    /// BSDF of the surface.
    pub bsdf: &'a Bsdf<'a>,
    /// Unit vector back along the walk.
    pub back: Vec3,
    /// Unit vector back along the walk in the shading frame.
    pub wo: Vec3,
    /// Flux that arrives, or importance of radiance that leaves towards `back`.
    pub weight: Rgb,
    /// Number of edges so far.
    pub edges: u32,
    /// True if a lobe has turned the walk.
    pub is_bent: bool,
}

impl Walk<'_> {
    /// Follows a walk of the given `weight` along `ray`. Passes every surface to `meet`, which may end the walk.
    /// Returns the number of rays.
    pub fn follow(
        &self,
        mut ray: Ray,
        mut weight: Rgb,
        sampler: &mut Sampler,
        mut meet: impl FnMut(&WalkVertex, &mut Sampler) -> ControlFlow<()>,
    ) -> u64 {
        let world = self.world;
        let (mut interior, mut is_bent) = (Interior::NONE, false);
        for edges in 1..=self.max_edges {
            let rays = u64::from(edges);
            // Arrive: the medium absorbs, and interpolated normals tilt the surface.
            let Some(surface) = world.intersect(&ray) else { return rays };
            if world.absorbs() {
                weight *= world.edge_shares(interior, &surface, ray.direction, ray.t_near)[1];
            }
            let back = -ray.direction;
            let wo = surface.frame.to_local(back);
            let Some(tilt) = self.tilt(wo.z, surface.normal.dot(back)) else { return rays };
            let bsdf = world.bsdf(&surface);
            let vertex = WalkVertex {
                surface: &surface,
                bsdf: &bsdf,
                back,
                wo,
                weight: weight * tilt,
                edges,
                is_bent,
            };
            let is_over = meet(&vertex, sampler).is_break() || edges == self.max_edges;
            if is_over || self.by_delta && !bsdf.has_delta() {
                return rays;
            }
            // Choose a direction and go on, if Russian roulette permits.
            let Some(sample) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d()) else { return rays };
            if self.by_delta && !sample.delta {
                return rays;
            }
            let direction = surface.frame.to_world(sample.wi);
            let Some(back_tilt) = self.tilt(surface.normal.dot(direction), sample.wi.z) else { return rays };
            // A delta lobe transforms the whole pencil of rays, normals included.
            let tilt = if sample.delta { 1.0 } else { tilt * back_tilt };
            let Some(next) = self.next(weight, &sample, tilt, sampler) else { return rays };
            weight = next;
            interior = world.interior_after(interior, &surface, direction, sample.straight);
            is_bent |= !sample.straight;
            ray = match sample.straight {
                true => beyond(&ray, surface.position, surface.normal, surface.t),
                false => shadow::ray_from(surface.position, surface.normal, direction),
            };
        }
        u64::from(self.max_edges)
    }

    /// Returns the correction of flux for a ratio of two cosines, one by the shading normal and one by the geometric
    /// normal; `None` if the normals disagree on which side this is. Importance needs none.
    fn tilt(&self, cos: f32, by: f32) -> Option<f32> {
        match self.carried {
            Carried::Importance => Some(1.0),
            Carried::Flux => (cos * by > 0.0).then(|| (cos / by).min(MAX_CORRECTION)),
        }
    }

    /// Returns the weight of the next edge; `None` if Russian roulette ends the walk.
    fn next(&self, weight: Rgb, sample: &BsdfSample, tilt: f32, sampler: &mut Sampler) -> Option<Rgb> {
        if self.carried == Carried::Importance {
            return Some(weight * sample.weight);
        }
        let next = weight * sample.weight * (sample.eta * sample.eta * tilt);
        let survival = (luminance(next) / luminance(weight)).min(MAX_SURVIVAL);
        (next.is_finite() && sampler.next_1d() < survival).then(|| next / survival)
    }
}
