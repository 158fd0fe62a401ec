//! Delta lights (point, spot and directional lights, projectors), distant discs, and the environment.
//!
//! For light from surfaces see [`super::Emission`].

use super::projector::Projector;
use super::texture::TextureId;
use base::math::Rgb;
use glam::{Mat3, Vec3};

/// A light that no ray can hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeltaLight {
    /// A point light: equal intensity in all directions.
    Point {
        /// Position relative to the scene's centre.
        position: Vec3,
        /// Radiant intensity, W/sr.
        intensity: Rgb,
    },
    /// A spot light. The intensity falls linearly in angle from `inner_angle` to `outer_angle`, as in Mitsuba:
    /// `(outer_angle - angle) / (outer_angle - inner_angle)`.
    Spot {
        /// Position relative to the scene's centre.
        position: Vec3,
        /// Unit axis of the cone, away from the light.
        direction: Vec3,
        /// Radiant intensity on the axis, W/sr.
        intensity: Rgb,
        /// Half angle of the cone of full intensity, radians.
        inner_angle: f32,
        /// Half angle beyond which the intensity is zero, radians.
        outer_angle: f32,
        /// Image that the intensity is a multiple of, if any; `outer_angle` is then below π/2.
        image: Option<SpotImage>,
    },
    /// An image that is projected from a point.
    Projector {
        /// Position relative to the scene's centre.
        position: Vec3,
        /// The image and its rays.
        projector: Projector,
    },
    /// Parallel light from infinitely far.
    Directional {
        /// Unit direction in which the light travels.
        direction: Vec3,
        /// Irradiance on a surface facing the light, W/m².
        irradiance: Rgb,
    },
}

/// Image before a spot light. The cone of `outer_angle` meets its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotImage {
    /// The image.
    pub texture: TextureId,
    /// Rotation of world directions to the light's frame: z along the axis, x to the right of the image, y down.
    pub to_local: Mat3,
}

/// An evenly emitting disc at infinite distance, such as the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantDisc {
    /// Unit direction towards the centre.
    pub direction: Vec3,
    /// Angle from the centre to the rim, radians.
    pub half_angle: f32,
    /// Radiance, W/(sr m²), added to the radiance of the environment.
    pub radiance: Rgb,
}

/// Light from infinitely far, in all directions.
#[derive(Clone, Debug)]
pub enum Environment {
    /// Constant radiance from all directions.
    Constant(Rgb),
    /// A latitude-longitude map.
    Map(EnvironmentMap),
}

/// Latitude-longitude map of radiance, in Mitsuba's convention.
///
/// Let `d` be the direction in the map's own frame. Then `u = atan2(d.x, -d.z) / 2π`, wrapped to [0, 1), and `v =
/// acos(d.y) / π`. Texels are interpolated bilinearly. Column i lies at `u = (i + 0.5) / width`, also across the seam.
/// Row j lies at `v = j / (height - 1)`, so the first row is the pole +y and the last -y.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    /// Columns of the image.
    pub width: usize,
    /// Rows of the image.
    pub height: usize,
    /// Radiance in W/(sr m²), row-major, `scale` applied.
    pub radiance: Vec<Rgb>,
    /// Transform of world directions to the map's frame.
    pub to_local: Mat3,
}
