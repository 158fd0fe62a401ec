//! Short pilot paths from surfaces that the eye sees, to the surfaces that light them.

use base::math::{Frame, Rgb};
use base::sampling::{Sampler, cosine_hemisphere};
use embree::Ray;
use glam::Vec3;
use world::material::Bsdf;
use world::shadow;
use world::{Surface, SurfacePoint, World};

/// Maximum number of diffuse or glossy surfaces of a path.
const SURFACES: u32 = 2;

/// Maximum number of edges of a path, mirrors and glass included.
const MAX_EDGES: u32 = 8;

/// Vertex of a path at a diffuse or glossy surface.
pub(super) struct PilotVertex<'a> {
    pub surface: &'a Surface,
    pub bsdf: &'a Bsdf<'a>,
    /// Unit vector back along the path in the shading frame.
    pub wo: Vec3,
    /// Radiance at the beginning of the path for a radiance of 1 from this vertex, up to a constant factor.
    pub throughput: Rgb,
}

impl PilotVertex<'_> {
    /// Returns the radiance at the beginning of the path for light from the unit vector `towards`, up to a constant
    /// factor. The light is given as `radiance`, or as irradiance on a facing surface.
    pub fn reflected(&self, towards: Vec3, radiance: Rgb) -> Rgb {
        let wi = self.surface.frame.to_local(towards);
        self.throughput * self.bsdf.eval(self.wo, wi) * radiance * wi.z.abs()
    }
}

/// Follows a path from a point that reflects diffusely, and passes every diffuse or glossy vertex to `met`.
pub(super) fn follow(
    world: &World,
    start: &SurfacePoint,
    sampler: &mut Sampler,
    mut met: impl FnMut(&PilotVertex, &mut Sampler),
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
            met(&PilotVertex { surface: &surface, bsdf: &bsdf, wo, throughput }, sampler);
            if surfaces == SURFACES {
                return;
            }
        }
        let Some(s) = bsdf.sample(wo, sampler.next_1d(), sampler.next_2d()) else { return };
        throughput *= s.weight;
        ray = shadow::ray_from(surface.position, surface.normal, surface.frame.to_world(s.wi));
    }
}

/// True if nothing blocks a ray. Mirrors and glass count as if they transmitted light straight.
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
