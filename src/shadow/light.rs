//! Shadow rays towards virtual lights: the one place that knows what kinds of lights there are.

use super::segment::ULPS;
use super::{ray_from, segment};
use crate::embree::{ALL_GEOMETRY, Ray, Rays16};
use crate::vpl::{Vpl, VplKind};
use glam::Vec3;

/// Three numbers for each of sixteen points.
type Vec3Lanes = [[f32; 16]; 3];

/// The ray from the surface point `x` with geometric normal `normal` (zero on no surface) to a virtual light.
#[inline]
pub fn to_vpl(x: Vec3, normal: Vec3, vpl: &Vpl, kind: VplKind) -> Ray {
    match kind {
        VplKind::Oriented => segment(x, normal, vpl.position, vpl.normal()),
        VplKind::Omni => segment(x, normal, vpl.position, Vec3::ZERO),
        VplKind::Directional => ray_from(x, normal, vpl.position),
    }
}

/// [`to_vpl`] from sixteen points at once, bit for bit. Rays start at the points: a coherent packet that fans
/// out from the light loses hits.
#[inline]
pub fn to_vpl16(x: &Vec3Lanes, normal: &Vec3Lanes, vpl: &Vpl, kind: VplKind) -> Rays16 {
    let mut rays = Rays16 { mask: [ALL_GEOMETRY; 16], ..Rays16::default() };
    let light = vpl.position;
    if kind == VplKind::Directional {
        for l in 0..16 {
            let (o, n) = (lane(x, l), lane(normal, l));
            set_origin(&mut rays, l, moved(o, n, light));
            (rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]) = (light.x, light.y, light.z);
            rays.t_far[l] = f32::INFINITY;
        }
        return rays;
    }
    let light_normal = if kind == VplKind::Oriented { vpl.normal() } else { Vec3::ZERO };
    for l in 0..16 {
        let (o, n) = (lane(x, l), lane(normal, l));
        let direction = light - o;
        let origin = moved(o, n, direction);
        let direction = moved(light, light_normal, -direction) - origin;
        set_origin(&mut rays, l, origin);
        (rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]) =
            (direction.x, direction.y, direction.z);
        rays.t_far[l] = 1.0;
    }
    rays
}

#[inline(always)]
fn lane(v: &Vec3Lanes, l: usize) -> Vec3 {
    Vec3::new(v[0][l], v[1][l], v[2][l])
}

#[inline(always)]
fn set_origin(rays: &mut Rays16, l: usize, origin: Vec3) {
    (rays.origin_x[l], rays.origin_y[l], rays.origin_z[l]) = (origin.x, origin.y, origin.z);
}

/// [`super::offset`] by comparisons that vector code has.
#[inline(always)]
fn moved(p: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let largest = larger(larger(p.x.abs(), p.y.abs()), larger(p.z.abs(), f32::MIN_POSITIVE));
    let step = largest * (ULPS * f32::EPSILON);
    let facing = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
    let side = if facing < 0.0 { -step } else { step };
    Vec3::new(p.x + normal.x * side, p.y + normal.y * side, p.z + normal.z * side)
}
