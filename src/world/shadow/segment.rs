//! Rays whose ends are offset, so that no surface shadows itself.
//!
//! The origin of a ray is moved off its surface along the geometric normal, to the side of the ray's direction, by 8
//! units in the last place of its largest coordinate. The offset scales with the rounding of the position, so that it
//! fits scenes of any size and position. The far end of a segment is only as precise as the segment is long, so that a
//! part of the length counts as a coordinate there.

use crate::World;
use crate::light::DirectSamples16;
use base::math::{Lane, Rgb, V3, f32x16};
use embree::{Ray, Rays16};
use glam::Vec3;

/// Offset in units of the last place of the largest coordinate.
const ULPS: f32 = 8.0;

/// Part of a segment's largest extent along an axis that counts as a coordinate of the far end.
const FAR_END: f32 = 0.25;

/// A segment or ray, or sixteen.
#[derive(Clone, Copy, Debug)]
pub struct Segment<L> {
    origin: V3<L>,
    direction: V3<L>,
    /// End in units of the direction.
    t_far: f32,
}

impl<L: Lane> Segment<L> {
    /// Returns the unbounded ray from a surface point in a direction.
    #[inline(always)]
    pub fn from(position: V3<L>, normal: V3<L>, direction: V3<L>) -> Segment<L> {
        let origin = moved(position, normal, direction, L::from(f32::MIN_POSITIVE));
        Segment { origin, direction, t_far: f32::INFINITY }
    }

    /// Returns the segment between two surface points, with both ends moved off their surfaces. Its parameter is from 0
    /// to 1.
    #[inline(always)]
    pub fn between(a: V3<L>, a_normal: V3<L>, b: V3<L>, b_normal: V3<L>) -> Segment<L> {
        let least = L::from(f32::MIN_POSITIVE);
        let direction = b - a;
        let origin = moved(a, a_normal, direction, least);
        let target = moved(b, b_normal, -direction, (largest(direction) * FAR_END).max(least));
        Segment { origin, direction: target - origin, t_far: 1.0 }
    }
}

/// Returns `position` moved off its surface towards the side of `direction`, as if its largest coordinate was at least
/// `least`.
#[inline(always)]
fn moved<L: Lane>(position: V3<L>, normal: V3<L>, direction: V3<L>, least: L) -> V3<L> {
    let step = largest(position).max(least) * (ULPS * f32::EPSILON);
    let is_behind = L::from(0.0).gt(normal.dot(direction));
    position + normal.times(L::pick(is_behind, -step, step))
}

#[inline(always)]
fn largest<L: Lane>(v: V3<L>) -> L {
    let V3 { x, y, z } = v.abs();
    x.max(y).max(z)
}

impl From<Segment<f32>> for Ray {
    #[inline(always)]
    fn from(Segment { origin, direction, t_far }: Segment<f32>) -> Ray {
        Ray { origin: origin.into(), t_near: 0.0, direction: direction.into(), t_far }
    }
}

impl From<Segment<f32x16>> for Rays16 {
    #[inline(always)]
    fn from(Segment { origin, direction, t_far }: Segment<f32x16>) -> Rays16 {
        Rays16 {
            origin_x: origin.x.to_array(),
            origin_y: origin.y.to_array(),
            origin_z: origin.z.to_array(),
            t_near: [0.0; 16],
            direction_x: direction.x.to_array(),
            direction_y: direction.y.to_array(),
            direction_z: direction.z.to_array(),
            t_far: [t_far; 16],
        }
    }
}

/// Returns [`Segment::from`] of one point.
#[inline]
pub fn ray_from(position: Vec3, normal: Vec3, direction: Vec3) -> Ray {
    Segment::<f32>::from(V3::splat(position), V3::splat(normal), V3::splat(direction)).into()
}

/// Returns [`Segment::between`] two points.
#[inline]
pub fn segment(a: Vec3, a_normal: Vec3, b: Vec3, b_normal: Vec3) -> Ray {
    Segment::<f32>::between(V3::splat(a), V3::splat(a_normal), V3::splat(b), V3::splat(b_normal)).into()
}

/// Returns the segment from a surface point to the light sampled in a lane; a ray if the light is infinitely far.
#[inline(always)]
pub fn to_light(position: Vec3, normal: Vec3, lights: &DirectSamples16, lane: usize) -> Ray {
    let (direction, distance) = (lights.direction.get(lane), lights.distance[lane]);
    if distance < f32::INFINITY {
        return segment(position, normal, position + direction * distance, lights.normal.get(lane));
    }
    ray_from(position, normal, direction)
}

/// Returns the share of the light that arrives along a segment: 0 if it is occluded or passes more than `most` sheets,
/// else the transmittance of its sheets.
#[inline]
pub fn arriving(world: &World, segment: &Ray, most: u32) -> Rgb {
    if world.accel.occluded(segment) { Rgb::ZERO } else { world.transmittance_of(segment, most) }
}
