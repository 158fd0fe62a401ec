//! Point, spot and directional lights, and projectors.

use super::image::{ImageLight, spot_falloff};
use base::math::{Rgb, luminance};
use glam::Vec3;
use scene::{DeltaLight, Projector, Textures};
use std::f32::consts::PI;
use std::sync::Arc;

/// A light that no ray can hit.
#[derive(Clone, Debug)]
pub struct DeltaEmitter {
    /// The light.
    pub light: DeltaLight,
    /// The image that it projects, if any.
    pub image: Option<Arc<ImageLight>>,
}

impl DeltaEmitter {
    /// Prepares a light, whose image is one of the `textures`.
    pub fn new(light: DeltaLight, textures: &Textures) -> DeltaEmitter {
        DeltaEmitter { light, image: ImageLight::new(&light, textures).map(Arc::new) }
    }

    /// Returns direction and distance from `x` to the light, and its irradiance on a surface that faces it.
    #[inline]
    pub fn irradiance(&self, x: Vec3) -> (Vec3, f32, Rgb) {
        match self.light {
            DeltaLight::Point { position, intensity } => {
                let offset = position - x;
                let distance = offset.length();
                (offset / distance, distance, intensity / (distance * distance))
            }
            DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle, image: None } => {
                let offset = position - x;
                let distance = offset.length();
                let to_light = offset / distance;
                let falloff = spot_falloff(direction.dot(-to_light), inner_angle, outer_angle);
                (to_light, distance, intensity * (falloff / (distance * distance)))
            }
            DeltaLight::Spot { position, .. } | DeltaLight::Projector { position, .. } => {
                let offset = position - x;
                let distance = offset.length();
                let to_light = offset / distance;
                let intensity = self.image.as_ref().map_or(Rgb::ZERO, |image| image.intensity(-to_light));
                (to_light, distance, intensity / (distance * distance))
            }
            DeltaLight::Directional { direction, irradiance } => (-direction, f32::INFINITY, irradiance),
        }
    }

    /// Returns the flux as luminance; for a directional light, the flux through a disk of the given radius.
    pub fn power(&self, scene_radius: f32) -> f32 {
        if let Some(image) = &self.image {
            return image.power;
        }
        match self.light {
            DeltaLight::Point { intensity, .. } => 4.0 * PI * luminance(intensity),
            DeltaLight::Spot { intensity, inner_angle, outer_angle, .. } => {
                // The falloff between both cones is linear in angle. The mean of their solid angles approximates it.
                let cone = |a: f32| 2.0 * PI * (1.0 - a.cos());
                0.5 * (cone(inner_angle) + cone(outer_angle)) * luminance(intensity)
            }
            DeltaLight::Projector { projector: Projector { intensity, .. }, .. } => luminance(intensity),
            DeltaLight::Directional { irradiance, .. } => {
                PI * scene_radius * scene_radius * luminance(irradiance)
            }
        }
    }
}
