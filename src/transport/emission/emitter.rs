//! The emitters of a scene as sources of photons: beginnings of paths at a given emitter.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use super::lit_sphere::LitSphere;
use super::target::EmissionTarget;
use super::{EmissionNumbers, EmissionSample};
use base::math::{Frame, Rgb, luminance};
use base::sampling::uniform_sphere;
use embree::Ray;
use glam::{Vec2, Vec3};
use scene::DeltaLight;
use std::f32::consts::{PI, TAU};
use world::World;
use world::light::{
    AreaLight, DeltaEmitter, DiscreteDistribution, EnvironmentLight, ImageLight, spot_falloff,
};
use world::shadow;

/// The emitters of a scene: area lights, then point, spot and directional lights, then the environment.
pub struct PhotonEmitter<'w> {
    pub(super) world: &'w World,
    /// Emitters by flux, as luminance.
    pub(super) by_power: DiscreteDistribution,
    pub(super) target: EmissionTarget,
    lit: LitSphere,
}

impl<'w> PhotonEmitter<'w> {
    /// Prepares sampling; `None` if the scene has no emitter or no surface.
    pub fn new(world: &'w World) -> Option<PhotonEmitter<'w>> {
        let target = EmissionTarget::new(world)?;
        let emitters = &world.emitters;
        let lit = LitSphere::new(world, &target);
        let areas = emitters.areas_and_spheres().map(|(light, sphere)| lit.power(light, sphere));
        let deltas = emitters.deltas.iter().map(|light| target.power(light));
        let disk = PI * target.core * target.core;
        let environment = emitters.environment.iter().map(|e| 4.0 * PI * disk * e.mean_luminance());
        let by_power = DiscreteDistribution::new(areas.chain(deltas).chain(environment));
        (!by_power.is_empty()).then_some(PhotonEmitter { world, by_power, target, lit })
    }

    /// Flux of all emitters, as luminance.
    pub fn power(&self) -> f32 {
        self.by_power.total() as f32
    }

    /// Share of each emitter in the flux.
    pub fn shares(&self) -> impl ExactSizeIterator<Item = f32> {
        (0..self.by_power.len()).map(|index| self.by_power.probability(index))
    }

    /// True if emitter `index` is infinitely far. Its paths are directed by [`EmissionNumbers::place`], other paths by
    /// [`EmissionNumbers::direction`].
    pub fn is_far(&self, index: usize) -> bool {
        let emitters = &self.world.emitters;
        let delta = index.checked_sub(emitters.areas.len()).map(|delta| emitters.deltas.get(delta));
        let is_far = |delta: &DeltaEmitter| matches!(delta.light, DeltaLight::Directional { .. });
        delta.is_some_and(|delta| delta.is_none_or(is_far))
    }

    /// Begins a path at emitter `index`, with the flux of paths that choose emitters in proportion to power. Returns
    /// `None` if the emitter is dark there.
    pub fn sample_of(&self, index: usize, numbers: &EmissionNumbers) -> Option<EmissionSample> {
        self.begin(index, 1.0 / self.by_power.probability(index), numbers)
    }

    /// Begins a path at emitter `index`, which was chosen with the inverse of `inv_probability`.
    pub(super) fn begin(
        &self,
        index: usize,
        inv_probability: f32,
        numbers: &EmissionNumbers,
    ) -> Option<EmissionSample> {
        let emitters = &self.world.emitters;
        if let Some(light) = emitters.areas.get(index) {
            return self.begin_at_area(light, inv_probability, numbers);
        }
        match emitters.deltas.get(index - emitters.areas.len()) {
            Some(delta) => self.begin_at_delta(delta, inv_probability, numbers),
            None => self.begin_at_environment(emitters.environment.as_ref()?, inv_probability, numbers),
        }
    }

    fn begin_at_area(
        &self,
        light: &AreaLight,
        inv_probability: f32,
        numbers: &EmissionNumbers,
    ) -> Option<EmissionSample> {
        let point = light.sample(numbers.place);
        let (direction, projected) = self.lit.direction(light, &point, numbers)?;
        let radiance = light.radiance(&point, point.normal);
        let flux = radiance * (projected * light.area * inv_probability);
        let ray = shadow::ray_from(point.position, point.normal, direction);
        EmissionSample::new(ray, flux, Some(luminance(radiance)))
    }

    fn begin_at_delta(
        &self,
        delta: &DeltaEmitter,
        inv_probability: f32,
        numbers: &EmissionNumbers,
    ) -> Option<EmissionSample> {
        let u = numbers.direction;
        let (ray, flux) = match delta.light {
            DeltaLight::Spot { position, image: Some(_), .. } | DeltaLight::Projector { position, .. } => {
                let (ray, flux) = self.begin_at_image(position, delta.image.as_deref()?, u);
                (ray, flux * inv_probability)
            }
            DeltaLight::Point { position, intensity } => match self.target.towards(position) {
                Some(towards) => {
                    let solid_angle = towards.solid_angle();
                    (self.target.ray_in(&towards, u), intensity * (solid_angle * inv_probability))
                }
                None => {
                    let ray = shadow::ray_from(position, Vec3::ZERO, uniform_sphere(u));
                    (ray, intensity * (4.0 * PI * inv_probability))
                }
            },
            DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle, image: None } => {
                let one_minus_cos = 1.0 - outer_angle.cos();
                let towards = self.target.towards(position);
                if let Some(towards) = towards.filter(|towards| towards.one_minus_cos < one_minus_cos) {
                    let ray = self.target.ray_in(&towards, u);
                    let falloff = spot_falloff(ray.direction.dot(direction), inner_angle, outer_angle);
                    (ray, intensity * (falloff * towards.solid_angle() * inv_probability))
                } else {
                    let cos = 1.0 - u.x * one_minus_cos;
                    let sin = (1.0 - cos * cos).max(0.0).sqrt();
                    let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
                    let local = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
                    let towards = Frame::from_normal(direction).to_world(local);
                    let falloff = spot_falloff(cos, inner_angle, outer_angle);
                    let ray = shadow::ray_from(position, Vec3::ZERO, towards);
                    (ray, intensity * (falloff * TAU * one_minus_cos * inv_probability))
                }
            }
            DeltaLight::Directional { direction, irradiance } => {
                let (ray, area) = self.target.ray(direction, numbers.place);
                (ray, irradiance * (area * inv_probability))
            }
        };
        EmissionSample::new(ray, flux, None)
    }

    /// Begins a path at a light that projects an image. Returns its ray, and the flux of a path that chose this light.
    fn begin_at_image(&self, position: Vec3, image: &ImageLight, u: Vec2) -> (Ray, Rgb) {
        if let Some(towards) = self.target.towards_by_image(position, image) {
            let ray = self.target.ray_in(&towards, u);
            return (ray, image.intensity(ray.direction) * towards.solid_angle());
        }
        let (direction, solid_angle) = image.sample(u);
        (shadow::ray_from(position, Vec3::ZERO, direction), image.intensity(direction) * solid_angle)
    }

    fn begin_at_environment(
        &self,
        environment: &EnvironmentLight,
        inv_probability: f32,
        numbers: &EmissionNumbers,
    ) -> Option<EmissionSample> {
        let s = environment.sample(numbers.direction)?;
        let (ray, area) = self.target.ray(-s.direction, numbers.place);
        let flux = s.radiance * (area * inv_probability / s.pdf);
        EmissionSample::new(ray, flux, Some(luminance(s.radiance)))
    }
}
