//! Sphere around all surfaces that do not emit: half of the photons of area lights outside it are sent towards it.

use super::EmissionNumbers;
use super::target::{EmissionTarget, MIN_CONE_DISTANCE, TowardsTarget};
use base::math::Frame;
use base::sampling::{Sampler, cosine_hemisphere};
use glam::Vec3;
use std::f32::consts::PI;
use world::World;
use world::light::{AreaLight, AreaPoint};

/// Number of points of an area light for the estimate of its share of light towards the sphere.
const POINTS: u32 = 64;

/// Minimum cosine of emission in that estimate, so that no area light is left out.
const MIN_COS: f32 = 0.05;

/// Sphere around the surfaces that do not emit, or around the camera if these surfaces reach very far. `None` if there
/// are no such surfaces or no area lights.
pub(super) struct LitSphere(Option<EmissionTarget>);

impl LitSphere {
    /// Creates the sphere for a scene with this `target`.
    pub fn new(world: &World, target: &EmissionTarget) -> LitSphere {
        if world.emitters.areas.is_empty() {
            return LitSphere(None);
        }
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for [a, b] in world.scene.seen_bounds(|mesh| mesh.emission.is_none()) {
            (low, high) = (low.min(a), high.max(b));
        }
        let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        if target.core < target.radius && !(radius < target.core) {
            return LitSphere(Some(EmissionTarget { radius: target.core, ..*target }));
        }
        LitSphere(radius.is_finite().then_some(EmissionTarget { centre, radius, core: radius }))
    }

    /// Returns the sphere, and the cone from a point outside it towards it.
    fn towards(&self, point: &AreaPoint) -> Option<(&EmissionTarget, TowardsTarget)> {
        let sphere = self.0.as_ref()?;
        sphere.towards(point.position).map(|towards| (sphere, towards))
    }

    /// Flux that photons of an area light carry, as luminance: twice the flux that reaches the sphere, since half of
    /// the photons of points outside go anywhere. `around` is the centre and the squared radius of a sphere around the
    /// light.
    pub fn power(&self, light: &AreaLight, around: (Vec3, f32)) -> f32 {
        let is_inside = |lit: &EmissionTarget| {
            around.0.distance(lit.centre) + around.1.sqrt() < MIN_CONE_DISTANCE * lit.radius
        };
        if self.0.as_ref().is_none_or(is_inside) {
            return light.power;
        }
        let share = |number: u32| {
            let sampler = &mut Sampler::new(POINTS, number);
            let point = light.sample(sampler.next_2d());
            self.towards(&point).map_or(1.0, |(_, towards)| {
                let cos = towards.axis.dot(point.normal);
                let cos = if light.emission.two_sided { 0.5 * cos.abs() } else { cos };
                (2.0 * towards.solid_angle() * cos.max(MIN_COS) / PI).min(1.0)
            })
        };
        light.power * ((0..POINTS).map(share).sum::<f32>() / POINTS as f32)
    }

    /// Samples a direction from a point of an area light; returns it and its cosine over its density. Half of the
    /// directions from outside go towards the sphere.
    pub fn direction(
        &self,
        light: &AreaLight,
        point: &AreaPoint,
        numbers: &EmissionNumbers,
    ) -> Option<(Vec3, f32)> {
        let EmissionNumbers { direction: u, side: u_side, .. } = *numbers;
        let two_sided = light.emission.two_sided;
        let sides = if two_sided { 2.0 } else { 1.0 };
        let by_cosine = |u_side: f32| {
            let normal = if two_sided && u_side < 0.5 { -point.normal } else { point.normal };
            Frame::from_normal(normal).to_world(cosine_hemisphere(u))
        };
        let Some((sphere, towards)) = self.towards(point) else {
            return Some((by_cosine(u_side), sides * PI));
        };
        let is_aimed = u_side < 0.5;
        let direction = match is_aimed {
            true => sphere.ray_in(&towards, u).direction,
            false => by_cosine(2.0 * u_side - 1.0),
        };
        let cos = point.normal.dot(direction);
        let cos = if two_sided { cos.abs() } else { cos };
        // The square of the difference from the axis rounds less than a cosine. Cones may be so narrow that even the
        // square rounds, so aimed directions always count as inside.
        let off_axis_sq = (direction - towards.axis).length_squared();
        let is_inside = is_aimed || off_axis_sq <= 2.0 * towards.one_minus_cos;
        let to_sphere = if is_inside { 1.0 / towards.solid_angle() } else { 0.0 };
        (cos > 0.0).then(|| (direction, cos / (0.5 * to_sphere + 0.5 * cos / (sides * PI))))
    }
}
