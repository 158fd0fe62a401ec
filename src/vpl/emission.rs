//! Photons leaving the emitters.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use super::target::{LitSphere, Target};
use crate::embree::Ray;
use crate::light::{DiscreteDistribution, spot_falloff};
use crate::math::{Frame, Rgb};
use crate::sampling::{Sampler, uniform_sphere};
use crate::scene::DeltaLight;
use crate::shadow;
use crate::world::World;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// The flux of a scene's emitters, sampled in proportion to power.
pub struct PhotonEmitter<'w> {
    world: &'w World,
    by_power: DiscreteDistribution,
    target: Target,
    lit: LitSphere,
}

impl<'w> PhotonEmitter<'w> {
    /// Prepares sampling; `None` if there is no emitter or no surface.
    pub fn new(world: &'w World) -> Option<PhotonEmitter<'w>> {
        let target = Target::new(world)?;
        let emitters = &world.emitters;
        let lit = LitSphere::new(world, &target);
        let areas = emitters.areas_and_spheres().map(|(light, sphere)| lit.power(light, sphere));
        let deltas = emitters.deltas.iter().map(|light| target.power(light));
        let disk = PI * target.core * target.core;
        let environment = emitters.environment.iter().map(|e| 4.0 * PI * disk * e.mean_luminance());
        let by_power = DiscreteDistribution::new(areas.chain(deltas).chain(environment));
        (!by_power.is_empty()).then_some(PhotonEmitter { world, by_power, target, lit })
    }

    /// Samples the first ray of a path and its flux; `None` where an emitter is dark.
    pub fn sample(&self, sampler: &mut Sampler) -> Option<(Ray, Rgb)> {
        let (index, _) = self.by_power.sample(sampler.next_1d());
        let (u_place, u_direction, u_side) = (sampler.next_2d(), sampler.next_2d(), sampler.next_1d());
        let inv_probability = 1.0 / self.by_power.probability(index);
        let emitters = &self.world.emitters;
        if let Some(light) = emitters.areas.get(index) {
            let point = light.sample(u_place);
            let (direction, projected) = self.lit.direction(light, &point, (u_direction, u_side))?;
            let flux = light.radiance(&self.world.scene, &point, point.normal)
                * (projected * light.area * inv_probability);
            return carrying(shadow::ray_from(point.position, point.normal, direction), flux);
        }
        if let Some(light) = emitters.deltas.get(index - emitters.areas.len()) {
            return match *light {
                DeltaLight::Point { position, intensity } => {
                    if let Some(towards) = self.target.towards(position) {
                        let ray = self.target.ray_in(&towards, u_direction);
                        return carrying(ray, intensity * (towards.solid_angle() * inv_probability));
                    }
                    let ray = shadow::ray_from(position, Vec3::ZERO, uniform_sphere(u_direction));
                    carrying(ray, intensity * (4.0 * PI * inv_probability))
                }
                DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle } => {
                    let one_minus_cos = 1.0 - outer_angle.cos();
                    let towards = self.target.towards(position);
                    if let Some(towards) = towards.filter(|towards| towards.one_minus_cos < one_minus_cos) {
                        let ray = self.target.ray_in(&towards, u_direction);
                        let falloff = spot_falloff(ray.direction.dot(direction), inner_angle, outer_angle);
                        let angle = towards.solid_angle();
                        return carrying(ray, intensity * (falloff * angle * inv_probability));
                    }
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
                    let (ray, area) = self.target.ray(direction, u_place);
                    carrying(ray, irradiance * (area * inv_probability))
                }
            };
        }
        let s = emitters.environment.as_ref()?.sample(u_direction)?;
        let (ray, area) = self.target.ray(-s.direction, u_place);
        carrying(ray, s.radiance * (area * inv_probability / s.pdf))
    }
}

fn carrying(ray: Ray, flux: Rgb) -> Option<(Ray, Rgb)> {
    (flux.is_finite() && flux.max_element() > 0.0).then_some((ray, flux))
}
