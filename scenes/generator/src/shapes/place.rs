//! Transforms that put shapes in their places.

use glam::{Affine3A, Quat, Vec3};

/// Translation.
pub fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

/// Rotation, then a translation to `position`.
pub fn posed(rotation: Quat, position: impl Into<Vec3>) -> Affine3A {
    Affine3A::from_rotation_translation(rotation, position.into())
}

/// Turn about the y axis by `degrees`, then a translation to `position`.
pub fn turned(degrees: f32, position: impl Into<Vec3>) -> Affine3A {
    posed(Quat::from_rotation_y(degrees.to_radians()), position)
}

/// Transform that takes the origin to `from` and the y axis to the direction of `to`, for shapes that are turned on
/// the lathe.
pub fn standing_on(from: impl Into<Vec3>, to: impl Into<Vec3>) -> Affine3A {
    let from = from.into();
    let axis = (to.into() - from).normalize_or(Vec3::Y);
    posed(Quat::from_rotation_arc(Vec3::Y, axis), from)
}

/// Frame at `origin` whose x axis is `right`, y axis `up` and z axis `right` x `up`, for outlines that stand upright.
pub fn upright(origin: impl Into<Vec3>, right: Vec3, up: Vec3) -> Affine3A {
    Affine3A::from_mat3_translation(glam::Mat3::from_cols(right, up, right.cross(up)), origin.into())
}

/// Reflection in the plane x = 0.
pub fn mirror_x() -> Affine3A {
    Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))
}

/// Reflection in the plane z = 0.
pub fn mirror_z() -> Affine3A {
    Affine3A::from_scale(Vec3::new(1.0, 1.0, -1.0))
}

/// South or east side of a building as built, and its mirror image.
pub fn both_sides() -> [Affine3A; 2] {
    [Affine3A::IDENTITY, mirror_x()]
}

/// Points of `path` moved by `frame`.
pub fn moved(path: &[[f32; 3]], frame: Affine3A) -> Vec<Vec3> {
    path.iter().map(|&p| frame.transform_point3(p.into())).collect()
}

/// `count` equal turns about the y axis.
pub fn turns(count: usize) -> impl Iterator<Item = Affine3A> {
    (0..count).map(move |k| turned(360.0 / count as f32 * k as f32, Vec3::ZERO))
}

/// Places of four feet, at x = ±`half_width` and two values of z.
pub fn feet(half_width: f32, z: [f32; 2]) -> [Affine3A; 4] {
    let [near, far] = z;
    [(-half_width, near), (half_width, near), (-half_width, far), (half_width, far)]
        .map(|(x, z)| at(x, 0.0, z))
}
