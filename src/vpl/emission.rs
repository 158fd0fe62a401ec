//! Photons leaving the emitters.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use crate::embree::Ray;
use crate::light::spot_falloff;
use crate::light::{DiscreteDistribution, delta_power};
use crate::math::Frame;
use crate::math::{Rgb, luminance};
use crate::sampling::{Sampler, cosine_hemisphere, uniform_disk, uniform_sphere};
use crate::scene::DeltaLight;
use crate::shadow;
use crate::world::World;
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Radius of the middle of the target of light from infinitely far, over the distance of what is around the camera.
const CORE: f32 = 8.0;

/// The flux of a scene's emitters, sampled in proportion to power.
pub struct PhotonEmitter<'w> {
    world: &'w World,
    by_power: DiscreteDistribution,
    target: Target,
}

/// Target of light from outside the scene: discs that face what is infinitely far, a sphere for other lights.
struct Target {
    centre: Vec3,
    /// Radius of a disc or sphere that covers all surfaces.
    radius: f32,
    /// Radius of its middle, which half of the light is drawn to; the other half is drawn in proportion to the inverse
    /// square of the distance, so that surfaces around the camera have light however far all others reach. In ordinary
    /// scenes it is that of the whole disc, to which all light is drawn evenly.
    core: f32,
}

impl Target {
    fn new(world: &World) -> Option<Target> {
        let (low, high) = world.accel.bounds()?;
        let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        let core = CORE * world.scene.vicinity;
        if core > 0.0 && core < radius {
            // About the camera, the local origin.
            return Some(Target { centre: Vec3::ZERO, radius: radius + centre.length(), core });
        }
        Some(Target { centre, radius, core: radius })
    }

    /// Returns a ray along `direction` through a point of the disc that faces it, and the inverse of its density by
    /// area.
    fn ray(&self, direction: Vec3, u: Vec2) -> (Ray, f32) {
        let Target { centre, radius, core } = *self;
        let (d, area) = if core == radius {
            (uniform_disk(u) * radius, PI * radius * radius)
        } else if u.x < 0.5 {
            (uniform_disk(Vec2::new(2.0 * u.x, u.y)) * core, 2.0 * PI * core * core)
        } else {
            let octaves = (radius / core).ln();
            let (sin, cos) = (TAU * u.y).sin_cos();
            let distance = core * ((2.0 * u.x - 1.0) * octaves).exp();
            (Vec2::new(cos, sin) * distance, 4.0 * PI * octaves * distance * distance)
        };
        let frame = Frame::from_normal(direction);
        // Starts a little beyond the sphere's surface: rounding must not put the origin inside the scene.
        let origin = centre + frame.to_world(Vec3::new(d.x, d.y, -1.01 * radius));
        (Ray { origin, t_near: 0.0, direction, t_far: f32::INFINITY }, area)
    }
}

/// Cone of directions in which a light outside the target shines on it.
struct TowardsTarget {
    /// Unit vector to the target's centre.
    axis: Vec3,
    /// Distance to it.
    distance: f32,
    /// 1 less the cosine of the cone's half angle, which may be far below the rounding of 1.
    one_minus_cos: f32,
}

impl Target {
    /// The cone in which a light at `position` shines on the target; `None` if it is inside, or so near that the cone
    /// is not worth it.
    fn towards(&self, position: Vec3) -> Option<TowardsTarget> {
        let to_centre = self.centre - position;
        let distance = to_centre.length();
        if distance.is_nan() || distance < 2.0 * self.radius {
            return None;
        }
        let sin_sq = (self.radius / distance).powi(2);
        let one_minus_cos = sin_sq / (1.0 + (1.0 - sin_sq).sqrt());
        Some(TowardsTarget { axis: to_centre / distance, distance, one_minus_cos })
    }

    /// Returns a ray of a light that is `towards` the target, even in the cone.
    fn ray_in(&self, towards: &TowardsTarget, u: Vec2) -> Ray {
        let TowardsTarget { axis, distance, one_minus_cos } = *towards;
        let down = u.x * one_minus_cos;
        let sin = (down * (2.0 - down)).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        // The direction's difference from the axis: of very far lights it alone is precise.
        let off_axis = Frame::from_normal(axis).to_world(Vec3::new(sin * cos_phi, sin * sin_phi, -down));
        let direction = (axis + off_axis).normalize();
        let origin = self.centre + off_axis * distance - direction * (1.01 * self.radius);
        Ray { origin, t_near: 0.0, direction, t_far: f32::INFINITY }
    }

    /// Flux of a light that photons are drawn for, as luminance.
    fn power(&self, light: &DeltaLight) -> f32 {
        let all = delta_power(light, self.core);
        match *light {
            DeltaLight::Point { position, intensity } | DeltaLight::Spot { position, intensity, .. } => {
                let towards = |towards: TowardsTarget| TAU * towards.one_minus_cos * luminance(intensity);
                all.min(self.towards(position).map_or(f32::INFINITY, towards))
            }
            DeltaLight::Directional { .. } => all,
        }
    }
}

impl<'w> PhotonEmitter<'w> {
    /// Prepares sampling; `None` if there is no emitter or no surface.
    pub fn new(world: &'w World) -> Option<PhotonEmitter<'w>> {
        let target = Target::new(world)?;
        let emitters = &world.emitters;
        let areas = emitters.areas.iter().map(|a| a.power);
        let deltas = emitters.deltas.iter().map(|light| target.power(light));
        let disk = PI * target.core * target.core;
        let environment = emitters.environment.iter().map(|e| 4.0 * PI * disk * e.mean_luminance());
        let by_power = DiscreteDistribution::new(areas.chain(deltas).chain(environment));
        (!by_power.is_empty()).then_some(PhotonEmitter { world, by_power, target })
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
                    if let Some(towards) = self.target.towards(position) {
                        let ray = self.target.ray_in(&towards, u_direction);
                        return carrying(ray, intensity * (TAU * towards.one_minus_cos * inv_probability));
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
                        let angle = TAU * towards.one_minus_cos;
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
