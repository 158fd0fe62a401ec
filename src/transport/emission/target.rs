//! Targets of light from outside: photons of lamps far from all that they light are drawn to it.
//!
//! Units: those of the scene.

use base::math::{Frame, luminance};
use base::sampling::{Sampler, cosine_hemisphere, uniform_disk};
use embree::Ray;
use glam::{Vec2, Vec3};
use scene::DeltaLight;
use std::f32::consts::{PI, TAU};
use world::World;
use world::light::{AreaLight, AreaPoint, delta_power};

/// Radius of the middle of the target of light from infinitely far, over the distance of what is around the camera.
const CORE: f32 = 8.0;

/// Distance of a light in radii of a target from which on its cone towards that is worth it.
const WORTH_A_CONE: f32 = 2.0;

/// Number of points of a lamp by which its share of light for the target is estimated.
const LOOKS: u32 = 64;

/// Smallest cosine at which a lamp's points are taken to shine, so that no lamp is left out.
const MIN_COS: f32 = 0.05;

/// Target of light from outside the scene: discs that face what is infinitely far, a sphere for other lights.
pub(super) struct Target {
    centre: Vec3,
    /// Radius of a disc or sphere that covers all surfaces.
    radius: f32,
    /// Radius of its middle, which half of the light is drawn to; the other half is drawn in proportion to the inverse
    /// square of the distance, so that surfaces around the camera have light however far all others reach. In ordinary
    /// scenes it is that of the whole disc, to which all light is drawn evenly.
    pub core: f32,
}

impl Target {
    pub fn new(world: &World) -> Option<Target> {
        let (low, high) = world.accel.bounds()?;
        let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        let core = CORE * world.scene.vicinity;
        if core > 0.0 && core < radius {
            // About the camera, the local origin.
            return Some(Target { centre: Vec3::ZERO, radius: radius + centre.length(), core });
        }
        Some(Target { centre, radius, core: radius })
    }

    /// Density by area, across the unit vector `towards` a light, with which [`Target::ray`] draws lines of its light
    /// through a place.
    pub fn density(&self, place: Vec3, towards: Vec3) -> f32 {
        let Target { centre, radius, core } = *self;
        let area = if core == radius {
            PI * radius * radius
        } else {
            let distance_sq = (place - centre).cross(towards).length_squared();
            let is_in_core = distance_sq < core * core;
            if is_in_core { 2.0 * PI * core * core } else { 4.0 * PI * (radius / core).ln() * distance_sq }
        };
        area.recip()
    }

    /// The point on the line from a place `towards` a light that is a little before all surfaces.
    pub fn before(&self, place: Vec3, towards: Vec3) -> Vec3 {
        place + towards * (1.01 * self.radius + (self.centre - place).dot(towards))
    }

    /// Returns a ray along `direction` through a point of the disc that faces it, and the inverse of its density by
    /// area.
    pub fn ray(&self, direction: Vec3, u: Vec2) -> (Ray, f32) {
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
pub(super) struct TowardsTarget {
    /// Unit vector to the target's centre.
    axis: Vec3,
    /// Distance to it.
    distance: f32,
    /// 1 less the cosine of the cone's half angle, which may be far below the rounding of 1.
    pub one_minus_cos: f32,
}

impl TowardsTarget {
    pub fn solid_angle(&self) -> f32 {
        TAU * self.one_minus_cos
    }
}

impl Target {
    /// The cone in which a light at `position` shines on the target; `None` if it is inside, or so near that the cone
    /// is not worth it.
    pub fn towards(&self, position: Vec3) -> Option<TowardsTarget> {
        let to_centre = self.centre - position;
        let distance = to_centre.length();
        if distance.is_nan() || distance < WORTH_A_CONE * self.radius {
            return None;
        }
        let sin_sq = (self.radius / distance).powi(2);
        let one_minus_cos = sin_sq / (1.0 + (1.0 - sin_sq).sqrt());
        Some(TowardsTarget { axis: to_centre / distance, distance, one_minus_cos })
    }

    /// Returns a ray of a light that is `towards` the target, even in the cone.
    pub fn ray_in(&self, towards: &TowardsTarget, u: Vec2) -> Ray {
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
    pub fn power(&self, light: &DeltaLight) -> f32 {
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

/// A sphere around what lamps that are surfaces are to light: surfaces that do not shine, of which there may be none;
/// only around the camera where those reach very far.
pub(super) struct LitSphere(Option<Target>);

impl LitSphere {
    pub fn new(world: &World, target: &Target) -> LitSphere {
        if world.emitters.areas.is_empty() {
            return LitSphere(None);
        }
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for position in world.scene.meshes.iter().filter(|m| m.emission.is_none()).flat_map(|m| &m.positions)
        {
            (low, high) = (low.min(*position), high.max(*position));
        }
        let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        if target.core < target.radius && !(radius < target.core) {
            return LitSphere(Some(Target { radius: target.core, ..*target }));
        }
        LitSphere(radius.is_finite().then_some(Target { centre, radius, core: radius }))
    }

    /// The sphere, and the cone in which a point outside it shines on it.
    fn towards(&self, point: &AreaPoint) -> Option<(&Target, TowardsTarget)> {
        let sphere = self.0.as_ref()?;
        sphere.towards(point.position).map(|towards| (sphere, towards))
    }

    /// Flux of a lamp that photons are drawn for, as luminance: twice what reaches the sphere, for half of the photons
    /// of points outside go anywhere. `around` are centre and squared radius of a sphere around the lamp.
    pub fn power(&self, light: &AreaLight, around: (Vec3, f32)) -> f32 {
        let is_inside =
            |lit: &Target| around.0.distance(lit.centre) + around.1.sqrt() < WORTH_A_CONE * lit.radius;
        if self.0.as_ref().is_none_or(is_inside) {
            return light.power;
        }
        let share = |look: u32| {
            let sampler = &mut Sampler::new(LOOKS, look);
            let point = light.sample(sampler.next_2d());
            self.towards(&point).map_or(1.0, |(_, towards)| {
                let cos = towards.axis.dot(point.normal);
                let cos = if light.emission.two_sided { 0.5 * cos.abs() } else { cos };
                (2.0 * towards.solid_angle() * cos.max(MIN_COS) / PI).min(1.0)
            })
        };
        light.power * ((0..LOOKS).map(share).sum::<f32>() / LOOKS as f32)
    }

    /// Samples a direction from a point of a lamp; returns it and cosine by density. Half of the directions from
    /// outside are drawn to the sphere.
    pub fn direction(
        &self,
        light: &AreaLight,
        point: &AreaPoint,
        (u, u_side): (Vec2, f32),
    ) -> Option<(Vec3, f32)> {
        let two_sided = light.emission.two_sided;
        let sides = if two_sided { 2.0 } else { 1.0 };
        let by_cosine = |u_side: f32| {
            let normal = if two_sided && u_side < 0.5 { -point.normal } else { point.normal };
            Frame::from_normal(normal).to_world(cosine_hemisphere(u))
        };
        let Some((sphere, towards)) = self.towards(point) else {
            return Some((by_cosine(u_side), sides * PI));
        };
        let is_drawn_there = u_side < 0.5;
        let direction = match is_drawn_there {
            true => sphere.ray_in(&towards, u).direction,
            false => by_cosine(2.0 * u_side - 1.0),
        };
        let cos = point.normal.dot(direction);
        let cos = if two_sided { cos.abs() } else { cos };
        // By the square of the difference from the axis, which rounds less than a cosine. Directions drawn into cones
        // so narrow that even this rounds count as inside.
        let off_axis_sq = (direction - towards.axis).length_squared();
        let is_inside = is_drawn_there || off_axis_sq <= 2.0 * towards.one_minus_cos;
        let to_sphere = if is_inside { 1.0 / towards.solid_angle() } else { 0.0 };
        (cos > 0.0).then(|| (direction, cos / (0.5 * to_sphere + 0.5 * cos / (sides * PI))))
    }
}
