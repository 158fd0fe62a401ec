//! Transforms that put shapes in their places.

use glam::{Affine3A, Quat, Vec3};

/// A translation.
pub fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

/// A turn about the y axis by `degrees`, then a translation to `position`.
pub fn turned(degrees: f32, position: Vec3) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_rotation_y(degrees.to_radians()), position)
}

/// The transform that takes the origin to `from` and the y axis to the direction of `to`, for shapes that
/// are turned on the lathe.
pub fn standing_on(from: Vec3, to: Vec3) -> Affine3A {
    let axis = (to - from).normalize_or(Vec3::Y);
    Affine3A::from_rotation_translation(Quat::from_rotation_arc(Vec3::Y, axis), from)
}

/// Reflection in the plane x = `x`.
pub fn mirror_x(x: f32) -> Affine3A {
    at(2.0 * x, 0.0, 0.0) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))
}

/// Reflection in the plane z = `z`.
pub fn mirror_z(z: f32) -> Affine3A {
    at(0.0, 0.0, 2.0 * z) * Affine3A::from_scale(Vec3::new(1.0, 1.0, -1.0))
}
