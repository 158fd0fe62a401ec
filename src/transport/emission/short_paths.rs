//! Short paths from surfaces that the eye sees, which find by what light these are lit.

use base::math::{Frame, Rgb};
use base::sampling::{Sampler, cosine_hemisphere};
use embree::Ray;
use glam::Vec3;
use world::material::Bsdf;
use world::shadow;
use world::{Surface, SurfacePoint, World};

/// Number of surfaces that a path finds.
const SURFACES: u32 = 2;

/// Maximum number of edges, mirrors and glass included.
const MAX_EDGES: u32 = 8;

/// A surface that a path has found.
pub(super) struct Met<'a> {
    pub surface: &'a Surface,
    pub bsdf: &'a Bsdf<'a>,
    /// Unit vector back along the path in the shading frame.
    pub wo: Vec3,
    /// Light at the path's beginning for a radiance of 1 from here, up to a factor.
    pub throughput: Rgb,
}

impl Met<'_> {
    /// Light at the path's beginning for a radiance, or irradiance across its direction, from the unit vector
    /// `towards`, up to a factor.
    pub fn reflected(&self, towards: Vec3, radiance: Rgb) -> Rgb {
        let wi = self.surface.frame.to_local(towards);
        self.throughput * self.bsdf.eval(self.wo, wi) * radiance * wi.z.abs()
    }
}

/// Follows a path from a point that reflects diffusely.
pub(super) fn follow(
    world: &World,
    start: &SurfacePoint,
    sampler: &mut Sampler,
    mut met: impl FnMut(&Met, &mut Sampler),
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
            met(&Met { surface: &surface, bsdf: &bsdf, wo, throughput }, sampler);
            if surfaces == SURFACES {
                return;
            }
        }
        let Some(s) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d()) else { return };
        throughput *= s.weight;
        ray = shadow::ray_from(surface.position, surface.normal, surface.frame.to_world(s.wi));
    }
}

/// True if light may come straight along a ray, also through glass as if it did not bend light.
pub(super) fn is_free(world: &World, mut ray: Ray) -> bool {
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
