//! Local coordinates, in f32, of a scene or of a group of meshes.

use base::math::{Placement, Rgb};
use glam::{Affine3, DMat3, DMat4, DVec3, Vec3};

/// Local coordinates of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalCoordinates {
    /// World position of the local origin.
    pub centre: DVec3,
    /// Binary logarithm of the local unit of length in world units.
    pub exponent: i32,
    /// Local distance from the camera that contains a tenth of all corners, if the scene is more than
    /// [`scene::MAX_RATIO`] times larger; else 0.
    pub vicinity: f32,
}

impl LocalCoordinates {
    /// Returns the local length of a world unit.
    pub fn scale(&self) -> f64 {
        f64::from(-self.exponent).exp2()
    }

    /// Returns the local position of a point.
    pub fn local(&self, world: DVec3) -> Vec3 {
        ((world - self.centre) * self.scale()).as_vec3()
    }

    /// Returns the local intensity of a light. Intensities scale with the square of lengths.
    pub fn local_intensity(&self, intensity: Rgb) -> Rgb {
        (intensity.as_dvec3() * (self.scale() * self.scale())).as_vec3()
    }

    /// Returns the coordinates of a group between two corners: its middle is the origin, and its diagonal is from 1 to
    /// 2.
    pub fn of_group(low: DVec3, high: DVec3) -> LocalCoordinates {
        let exponent = (high - low).length().log2().floor();
        let exponent = if exponent.is_finite() { exponent.clamp(-500.0, 500.0) as i32 } else { 0 };
        LocalCoordinates { centre: 0.5 * low + 0.5 * high, exponent, vicinity: 0.0 }
    }

    /// Returns the placement from these coordinates, of a group that `to_world` places, to those of a scene.
    pub fn placed(&self, to_world: &DMat4, scene: &LocalCoordinates) -> Placement {
        let linear = DMat3::from_mat4(*to_world) * (scene.scale() / self.scale());
        let middle = scene.local(to_world.transform_point3(self.centre));
        Placement(Affine3::from_mat3_translation(linear.as_mat3(), middle))
    }
}
