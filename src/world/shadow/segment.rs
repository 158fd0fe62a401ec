//! Rays whose ends are offset, so that no surface shadows itself.
//!
//! The origin of a ray is moved off its surface along the geometric normal, to the side of the ray's direction, by 8
//! units in the last place of its largest coordinate. The offset scales with the rounding of the position, so that it
//! fits scenes of any size and position. The far end of a segment is only as precise as the segment is long, so that a
//! part of the length counts as a coordinate there.

use crate::World;
use crate::light::DirectSamples16;
use base::math::Rgb;
use embree::Ray;
use glam::Vec3;

/// Offset in units of the last place of the largest coordinate.
pub const ULPS: f32 = 8.0;

/// Part of a segment's largest extent along an axis that counts as a coordinate of the far end.
pub const FAR_END: f32 = 0.25;

/// Returns `position` moved off its surface towards the side of `direction`.
#[inline]
pub fn offset(position: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    offset_from(position, normal, direction, f32::MIN_POSITIVE)
}

/// Returns `position` moved off its surface, as if its largest coordinate was at least `least`.
#[inline]
fn offset_from(position: Vec3, normal: Vec3, direction: Vec3, least: f32) -> Vec3 {
    let step = position.abs().max_element().max(least) * (ULPS * f32::EPSILON);
    let side = if normal.dot(direction) < 0.0 { -step } else { step };
    position + normal * side
}

/// Returns the unbounded ray from a surface point in a direction.
#[inline]
pub fn ray_from(position: Vec3, normal: Vec3, direction: Vec3) -> Ray {
    Ray { origin: offset(position, normal, direction), t_near: 0.0, direction, t_far: f32::INFINITY }
}

/// Returns the segment between two surface points, with both ends moved off their surfaces. Its parameter is from 0 to
/// 1.
#[inline]
pub fn segment(a: Vec3, a_normal: Vec3, b: Vec3, b_normal: Vec3) -> Ray {
    let direction = b - a;
    let origin = offset(a, a_normal, direction);
    let extent = (FAR_END * direction.abs().max_element()).max(f32::MIN_POSITIVE);
    let target = offset_from(b, b_normal, -direction, extent);
    Ray { origin, t_near: 0.0, direction: target - origin, t_far: 1.0 }
}

/// Returns the segment from a surface point to the light sampled in a lane; a ray if the light is infinitely far.
#[inline(always)]
pub fn to_light(position: Vec3, normal: Vec3, lights: &DirectSamples16, lane: usize) -> Ray {
    let (direction, distance) = (lights.direction.get(lane), lights.distance[lane]);
    let near = segment(position, normal, position + direction * distance, lights.normal.get(lane));
    let far = ray_from(position, normal, direction);
    if distance < f32::INFINITY { near } else { far }
}

/// Returns the share of the light that arrives along a segment: 0 if it is occluded or passes more than `most` sheets,
/// else the transmittance of its sheets.
#[inline]
pub fn arriving(world: &World, segment: &Ray, most: u32) -> Rgb {
    if world.accel.occluded(segment) { Rgb::ZERO } else { world.transmittance_of(segment, most) }
}
