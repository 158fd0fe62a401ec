//! Extent, directions and power of emitters and of sets of emitters.

use super::cone::{EmissionCone, angle_between};
use crate::light::{AreaLight, DeltaEmitter, TriangleShape};
use base::math::{Rgb, luminance};
use glam::Vec3;
use scene::DeltaLight;
use std::f32::consts::{FRAC_PI_2, PI};

/// Distance of the points that represent directional lights, over the scene's diagonal.
const FAR: f32 = 1e3;

/// Bounds of a set of emitters.
#[derive(Clone, Copy, Debug)]
pub struct EmitterBounds {
    /// Lowest corner of the box around the positions.
    pub low: Vec3,
    /// Highest corner.
    pub high: Vec3,
    /// Directions of the light.
    pub cone: EmissionCone,
    /// Flux as luminance, W.
    pub power: f32,
    /// π times the sum of the members' intensities in their main directions.
    pub peak: f32,
}

impl EmitterBounds {
    /// Bounds an emitting mesh.
    pub fn of_area(light: &AreaLight) -> EmitterBounds {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        // Sum of the triangles' normals times their areas.
        let mut facing = Vec3::ZERO;
        for TriangleShape { corner, edges: [e1, e2], .. } in light.shapes() {
            for position in [*corner, corner + e1, corner + e2] {
                (low, high) = (low.min(position), high.max(position));
            }
            facing += 0.5 * e1.cross(*e2);
        }
        let axis = facing.normalize_or_zero();
        let spread = light.shapes().iter().map(|shape| angle_between(axis, shape.normal)).fold(0.0, f32::max);
        let directed = !light.emission.two_sided && axis != Vec3::ZERO;
        let cone = EmissionCone { axis, normals: spread, emission: FRAC_PI_2 };
        // A surface that emits evenly into all directions has a quarter of a flat emitter's peak intensity.
        let share = if directed { (facing.length() / light.area).max(0.25) } else { 0.25 };
        EmitterBounds {
            low,
            high,
            cone: if directed { cone } else { EmissionCone::ALL },
            power: light.power,
            peak: share * light.power,
        }
    }

    /// Bounds a point, spot or directional light, or a projector, in a scene of the given diagonal.
    pub fn of_delta(delta: &DeltaEmitter, diagonal: f32) -> EmitterBounds {
        let power = delta.power(0.5 * diagonal);
        let at = |position, cone, intensity| EmitterBounds {
            low: position,
            high: position,
            cone,
            power,
            peak: PI * luminance(intensity),
        };
        if let (Some(image), DeltaLight::Spot { position, .. } | DeltaLight::Projector { position, .. }) =
            (&delta.image, delta.light)
        {
            let cone = EmissionCone { axis: image.axis(), normals: 0.0, emission: image.angle };
            return at(position, cone, Rgb::splat(image.mean_intensity()));
        }
        match delta.light {
            DeltaLight::Point { position, intensity } => at(position, EmissionCone::ALL, intensity),
            DeltaLight::Spot { position, direction, intensity, outer_angle, .. } => {
                let cone = EmissionCone { axis: direction, normals: 0.0, emission: outer_angle };
                at(position, cone, intensity)
            }
            DeltaLight::Projector { position, .. } => at(position, EmissionCone::ALL, Rgb::ZERO),
            // A point at a distance at which direction and distance hardly vary within the scene.
            DeltaLight::Directional { direction, irradiance } => {
                let distance = FAR * diagonal;
                let bounds = at(-direction * distance, EmissionCone::ALL, irradiance * (distance * distance));
                let reach = Vec3::splat(diagonal);
                EmitterBounds { low: bounds.low - reach, high: bounds.high + reach, ..bounds }
            }
        }
    }

    /// Bounds both sets.
    pub fn union(&self, other: &EmitterBounds) -> EmitterBounds {
        EmitterBounds {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            cone: self.cone.union(&other.cone),
            power: self.power + other.power,
            peak: self.peak + other.peak,
        }
    }

    /// Returns the cost of sampling the set as one: power times the extents of positions and directions (Conty Estevez
    /// & Kulla 2018, section 4.4, with the squared diagonal instead of the surface area).
    pub fn cost(&self) -> f32 {
        self.power * self.cone.measure() * self.low.distance_squared(self.high)
    }
}
