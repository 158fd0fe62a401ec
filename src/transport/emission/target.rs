//! EmissionTarget of light from outside the scene: photons of emitters that are far from all surfaces are sent towards
//! it.
//!
//! Units: lengths in the scene's unit.

use base::math::{Frame, luminance};
use base::sampling::uniform_disk;
use embree::Ray;
use glam::{Vec2, Vec3};
use scene::DeltaLight;
use std::f32::consts::{PI, TAU};
use world::World;
use world::light::{DeltaEmitter, ImageLight};

/// Radius of the core of the target, relative to the size of the camera's surroundings.
const CORE: f32 = 8.0;

/// Minimum distance of an emitter for a cone towards the target, in radii of the target.
pub(super) const MIN_CONE_DISTANCE: f32 = 2.0;

/// EmissionTarget of light from outside the scene: a disc for emitters that are infinitely far, a sphere for others.
pub(super) struct EmissionTarget {
    pub centre: Vec3,
    /// Radius of a disc or sphere that covers all surfaces.
    pub radius: f32,
    /// Radius of the core, which receives half of the photons evenly. The other half has a density in proportion to the
    /// inverse square of the distance, so that surfaces around the camera have light however far other surfaces reach.
    /// In ordinary scenes the core is the whole target.
    pub core: f32,
}

impl EmissionTarget {
    /// Creates the target around the surfaces of a scene; `None` if there are none.
    pub fn new(world: &World) -> Option<EmissionTarget> {
        let (low, high) = world.accel.bounds()?;
        let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        let core = CORE * world.scene.vicinity;
        if core > 0.0 && core < radius {
            // The centre is the camera, the local origin.
            return Some(EmissionTarget { centre: Vec3::ZERO, radius: radius + centre.length(), core });
        }
        Some(EmissionTarget { centre, radius, core: radius })
    }

    /// Density by area, on a plane across the unit vector `towards` a light, with which [`EmissionTarget::ray`] samples
    /// a line of light through `place`.
    pub fn density(&self, place: Vec3, towards: Vec3) -> f32 {
        let EmissionTarget { centre, radius, core } = *self;
        let area = if core == radius {
            PI * radius * radius
        } else {
            let distance_sq = (place - centre).cross(towards).length_squared();
            let is_in_core = distance_sq < core * core;
            if is_in_core { 2.0 * PI * core * core } else { 4.0 * PI * (radius / core).ln() * distance_sq }
        };
        area.recip()
    }

    /// Returns a point on the line from `place` `towards` a light that lies beyond all surfaces.
    pub fn before(&self, place: Vec3, towards: Vec3) -> Vec3 {
        place + towards * (1.01 * self.radius + (self.centre - place).dot(towards))
    }

    /// Returns a ray along `direction` through a point of the disc that faces it, and the inverse of the point's
    /// density by area.
    pub fn ray(&self, direction: Vec3, u: Vec2) -> (Ray, f32) {
        let EmissionTarget { centre, radius, core } = *self;
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

/// Cone of directions from an emitter outside the target to the target.
pub(super) struct TowardsTarget {
    /// Unit vector to the target's centre.
    pub axis: Vec3,
    /// Distance to the target's centre.
    distance: f32,
    /// 1 less the cosine of the cone's half angle, which may be far below the rounding of 1.
    pub one_minus_cos: f32,
}

impl TowardsTarget {
    /// Solid angle of the cone, sr.
    pub fn solid_angle(&self) -> f32 {
        TAU * self.one_minus_cos
    }
}

impl EmissionTarget {
    /// Returns the cone from an emitter at `position` to the target; `None` if the emitter is inside or near.
    pub fn towards(&self, position: Vec3) -> Option<TowardsTarget> {
        let to_centre = self.centre - position;
        let distance = to_centre.length();
        if distance.is_nan() || distance < MIN_CONE_DISTANCE * self.radius {
            return None;
        }
        let sin_sq = (self.radius / distance).powi(2);
        let one_minus_cos = sin_sq / (1.0 + (1.0 - sin_sq).sqrt());
        Some(TowardsTarget { axis: to_centre / distance, distance, one_minus_cos })
    }

    /// Returns a ray of an emitter `towards` the target. Directions are uniform in the cone.
    pub fn ray_in(&self, towards: &TowardsTarget, u: Vec2) -> Ray {
        let TowardsTarget { axis, distance, one_minus_cos } = *towards;
        let down = u.x * one_minus_cos;
        let sin = (down * (2.0 - down)).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        // Difference of the direction from the axis. For very far emitters only the difference is precise.
        let off_axis = Frame::from_normal(axis).to_world(Vec3::new(sin * cos_phi, sin * sin_phi, -down));
        let direction = (axis + off_axis).normalize();
        let origin = self.centre + off_axis * distance - direction * (1.01 * self.radius);
        Ray { origin, t_near: 0.0, direction, t_far: f32::INFINITY }
    }

    /// Flux that photons of a point, spot or directional light or a projector carry, as luminance.
    pub fn power(&self, delta: &DeltaEmitter) -> f32 {
        let all = delta.power(self.core);
        let towards = |position, intensity| {
            let towards = |towards: TowardsTarget| TAU * towards.one_minus_cos * luminance(intensity);
            all.min(self.towards(position).map_or(f32::INFINITY, towards))
        };
        match (delta.light, &delta.image) {
            (DeltaLight::Spot { position, .. } | DeltaLight::Projector { position, .. }, Some(image)) => {
                towards(position, image.peak)
            }
            (DeltaLight::Point { position, intensity } | DeltaLight::Spot { position, intensity, .. }, _) => {
                towards(position, intensity)
            }
            (DeltaLight::Projector { .. } | DeltaLight::Directional { .. }, _) => all,
        }
    }

    /// Returns the cone from an emitter at `position` to the target, if photons carry less flux in the cone than in the
    /// whole image that the emitter projects.
    pub fn towards_by_image(&self, position: Vec3, image: &ImageLight) -> Option<TowardsTarget> {
        let less = |towards: &TowardsTarget| towards.solid_angle() * luminance(image.peak) < image.power;
        self.towards(position).filter(less)
    }
}
