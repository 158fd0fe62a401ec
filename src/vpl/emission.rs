//! Photons leaving the emitters.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use crate::embree::Ray;
use crate::light::spot_falloff;
use crate::light::{DiscreteDistribution, delta_power};
use crate::math::Frame;
use crate::math::Rgb;
use crate::sampling::{Sampler, cosine_hemisphere, uniform_disk, uniform_sphere};
use crate::scene::DeltaLight;
use crate::shadow;
use crate::world::World;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// The flux of a scene's emitters, sampled in proportion to power.
pub struct PhotonEmitter<'w> {
    world: &'w World,
    by_power: DiscreteDistribution,
    /// Sphere around all surfaces: the target of light from infinitely far.
    centre: Vec3,
    radius: f32,
}

impl<'w> PhotonEmitter<'w> {
    /// Prepares sampling; `None` if there is no emitter or no surface.
    pub fn new(world: &'w World) -> Option<PhotonEmitter<'w>> {
        let (low, high) = world.accel.bounds()?;
        let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        let emitters = &world.emitters;
        let areas = emitters.areas.iter().map(|a| a.power);
        let deltas = emitters.deltas.iter().map(|d| delta_power(d, radius));
        let disk = PI * radius * radius;
        let environment = emitters.environment.iter().map(|e| 4.0 * PI * disk * e.mean_luminance());
        let by_power = DiscreteDistribution::new(areas.chain(deltas).chain(environment));
        (!by_power.is_empty()).then_some(PhotonEmitter { world, by_power, centre, radius })
    }

    /// Samples the first ray of a path and its flux; `None` where an emitter is dark.
    pub fn sample(&self, sampler: &mut Sampler) -> Option<(Ray, Rgb)> {
        let (index, _) = self.by_power.sample(sampler.next_1d());
        let (u_place, u_direction, u_side) = (sampler.next_2d(), sampler.next_2d(), sampler.next_1d());
        let inv_probability = 1.0 / self.by_power.probability(index);
        let emitters = &self.world.emitters;
        if let Some(light) = emitters.areas.get(index) {
            let point = light.sample(u_place);
            let (sides, normal) = match light.emission.two_sided {
                true if u_side < 0.5 => (2.0, -point.normal),
                true => (2.0, point.normal),
                false => (1.0, point.normal),
            };
            let direction = Frame::from_normal(normal).to_world(cosine_hemisphere(u_direction));
            let flux = light.radiance(&self.world.scene, &point, normal)
                * (PI * light.area * sides * inv_probability);
            return carrying(shadow::ray_from(point.position, point.normal, direction), flux);
        }
        if let Some(light) = emitters.deltas.get(index - emitters.areas.len()) {
            return match *light {
                DeltaLight::Point { position, intensity } => {
                    let ray = shadow::ray_from(position, Vec3::ZERO, uniform_sphere(u_direction));
                    carrying(ray, intensity * (4.0 * PI * inv_probability))
                }
                DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle } => {
                    let one_minus_cos = 1.0 - outer_angle.cos();
                    let cos = 1.0 - u_direction.x * one_minus_cos;
                    let sin = (1.0 - cos * cos).max(0.0).sqrt();
                    let (sin_phi, cos_phi) = (TAU * u_direction.y).sin_cos();
                    let local = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
                    let ray =
                        shadow::ray_from(position, Vec3::ZERO, Frame::from_normal(direction).to_world(local));
                    let falloff = spot_falloff(cos, inner_angle, outer_angle);
                    carrying(ray, intensity * (falloff * TAU * one_minus_cos * inv_probability))
                }
                DeltaLight::Directional { direction, irradiance } => {
                    let flux = irradiance * (self.disk_area() * inv_probability);
                    carrying(self.ray_through_disk(direction, u_place), flux)
                }
            };
        }
        let s = emitters.environment.as_ref()?.sample(u_direction)?;
        let flux = s.radiance * (self.disk_area() * inv_probability / s.pdf);
        carrying(self.ray_through_disk(-s.direction, u_place), flux)
    }

    fn disk_area(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// Returns a ray along `direction` through a point of the disk that faces it and covers all surfaces.
    fn ray_through_disk(&self, direction: Vec3, u: glam::Vec2) -> Ray {
        let d = uniform_disk(u) * self.radius;
        let frame = Frame::from_normal(direction);
        // Starts a little beyond the sphere's surface: rounding must not put the origin inside the scene.
        let origin = self.centre + frame.to_world(Vec3::new(d.x, d.y, -1.01 * self.radius));
        Ray { origin, t_near: 0.0, direction, t_far: f32::INFINITY }
    }
}

fn carrying(ray: Ray, flux: Rgb) -> Option<(Ray, Rgb)> {
    (flux.is_finite() && flux.max_element() > 0.0).then_some((ray, flux))
}
