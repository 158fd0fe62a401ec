//! Rays that keep a surface from shadowing itself.
//!
//! A ray that starts on a surface is moved off it along the geometric normal, to the side it leaves towards,
//! by 8 units in the last place of the position's largest coordinate. The offset scales with the rounding of
//! the position itself, so it holds for any scene size or offset, where a constant would not. The far end of a segment
//! is known no better than a part of its length, which counts as a coordinate there.

use crate::World;
use base::math::Rgb;
use embree::Ray;
use glam::Vec3;

/// Offset in units of the last place of the largest coordinate.
pub const ULPS: f32 = 8.0;

/// Part of a segment's extent along an axis that counts as a coordinate of its far end.
pub const FAR_END: f32 = 0.25;

/// Returns `position` moved off its surface towards the side of `direction`.
#[inline]
pub fn offset(position: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    offset_from(position, normal, direction, f32::MIN_POSITIVE)
}

/// The same by the units of the coordinate `least` at least.
#[inline]
fn offset_from(position: Vec3, normal: Vec3, direction: Vec3, least: f32) -> Vec3 {
    let step = position.abs().max_element().max(least) * (ULPS * f32::EPSILON);
    let side = if normal.dot(direction) < 0.0 { -step } else { step };
    position + normal * side
}

/// The ray from a surface point in a direction, unbounded.
#[inline]
pub fn ray_from(position: Vec3, normal: Vec3, direction: Vec3) -> Ray {
    Ray { origin: offset(position, normal, direction), t_near: 0.0, direction, t_far: f32::INFINITY }
}

/// The segment between two surface points, both ends moved off their surfaces; `t` runs from 0 to 1.
#[inline]
pub fn segment(a: Vec3, a_normal: Vec3, b: Vec3, b_normal: Vec3) -> Ray {
    let direction = b - a;
    let origin = offset(a, a_normal, direction);
    let extent = (FAR_END * direction.abs().max_element()).max(f32::MIN_POSITIVE);
    let target = offset_from(b, b_normal, -direction, extent);
    Ray { origin, t_near: 0.0, direction: target - origin, t_far: 1.0 }
}

/// Share of the light that arrives along the segment between two surface points. A zero normal marks a point that lies
/// on no surface.
#[inline]
pub fn between(world: &World, a: Vec3, a_normal: Vec3, b: Vec3, b_normal: Vec3) -> Rgb {
    arriving(world, &segment(a, a_normal, b, b_normal))
}

/// Share of the light that arrives along a segment: 0 where it is occluded, else the transmittance of the sheets on it.
#[inline]
pub fn arriving(world: &World, segment: &Ray) -> Rgb {
    if world.accel.occluded(segment) { Rgb::ZERO } else { world.transmittance(segment) }
}
