//! Point, spot and directional lights.

use base::math::{Rgb, luminance};
use glam::Vec3;
use scene::DeltaLight;
use std::f32::consts::PI;

/// Returns direction and distance from `x` to a delta light, and its irradiance on a surface that faces it.
#[inline]
pub fn delta_irradiance(light: &DeltaLight, x: Vec3) -> (Vec3, f32, Rgb) {
    match *light {
        DeltaLight::Point { position, intensity } => {
            let offset = position - x;
            let distance = offset.length();
            (offset / distance, distance, intensity / (distance * distance))
        }
        DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle } => {
            let offset = position - x;
            let distance = offset.length();
            let to_light = offset / distance;
            let falloff = spot_falloff(direction.dot(-to_light), inner_angle, outer_angle);
            (to_light, distance, intensity * (falloff / (distance * distance)))
        }
        DeltaLight::Directional { direction, irradiance } => (-direction, f32::INFINITY, irradiance),
    }
}

/// Returns the share of a spot's axial intensity at the given cosine to its axis.
#[inline]
pub fn spot_falloff(cos: f32, inner_angle: f32, outer_angle: f32) -> f32 {
    let angle = cos.clamp(-1.0, 1.0).acos();
    if angle <= inner_angle {
        1.0
    } else if angle >= outer_angle {
        0.0
    } else {
        (outer_angle - angle) / (outer_angle - inner_angle)
    }
}

/// Returns the flux of a delta light as luminance; for a directional light, the flux through a disk of the given
/// radius.
pub fn delta_power(light: &DeltaLight, scene_radius: f32) -> f32 {
    match *light {
        DeltaLight::Point { intensity, .. } => 4.0 * PI * luminance(intensity),
        DeltaLight::Spot { intensity, inner_angle, outer_angle, .. } => {
            // The falloff between both cones is linear in angle. The mean of their solid angles approximates it.
            let cone = |a: f32| 2.0 * PI * (1.0 - a.cos());
            0.5 * (cone(inner_angle) + cone(outer_angle)) * luminance(intensity)
        }
        DeltaLight::Directional { irradiance, .. } => {
            PI * scene_radius * scene_radius * luminance(irradiance)
        }
    }
}
