//! Shadow rays towards VPLs. Only this file distinguishes kinds of VPLs for shadow rays.

use crate::lights::{Vpl, VplKind};
use base::math::{LANES, Vec3x16};
use embree::{Ray, Rays16};
use glam::Vec3;
use world::shadow::{FAR_END, ULPS, ray_from, segment};

/// Returns the ray to a VPL from the point `x` with geometric normal `normal`, which is zero if `x` lies on no surface.
#[inline]
pub fn to_vpl(x: Vec3, normal: Vec3, vpl: &Vpl, kind: VplKind) -> Ray {
    match kind {
        VplKind::Oriented => segment(x, normal, vpl.position, vpl.normal()),
        VplKind::Omni | VplKind::Lobed => segment(x, normal, vpl.position, Vec3::ZERO),
        VplKind::Directional => ray_from(x, normal, vpl.position),
    }
}

/// Returns the rays of [`to_vpl`] from sixteen points, bit for bit. Rays start at the points, since a packet that fans
/// out from the light would lose hits.
#[inline]
pub fn to_vpl16(x: &Vec3x16, normal: &Vec3x16, vpl: &Vpl, kind: VplKind) -> Rays16 {
    let mut rays = Rays16::default();
    let light = vpl.position;
    if kind == VplKind::Directional {
        for l in 0..LANES {
            let (o, n) = (x.get(l), normal.get(l));
            set_origin(&mut rays, l, moved(o, n, light, f32::MIN_POSITIVE));
            (rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]) = (light.x, light.y, light.z);
            rays.t_far[l] = f32::INFINITY;
        }
        return rays;
    }
    let light_normal = if kind == VplKind::Oriented { vpl.normal() } else { Vec3::ZERO };
    for l in 0..LANES {
        let (o, n) = (x.get(l), normal.get(l));
        let direction = light - o;
        let origin = moved(o, n, direction, f32::MIN_POSITIVE);
        let extent = larger(FAR_END * largest(direction), f32::MIN_POSITIVE);
        let direction = moved(light, light_normal, -direction, extent) - origin;
        set_origin(&mut rays, l, origin);
        (rays.direction_x[l], rays.direction_y[l], rays.direction_z[l]) =
            (direction.x, direction.y, direction.z);
        rays.t_far[l] = 1.0;
    }
    rays
}

#[inline(always)]
fn set_origin(rays: &mut Rays16, l: usize, origin: Vec3) {
    (rays.origin_x[l], rays.origin_y[l], rays.origin_z[l]) = (origin.x, origin.y, origin.z);
}

/// Returns the larger number, by a comparison that compiles to vector code.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn largest(v: Vec3) -> f32 {
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}

/// Returns `shadow::offset` by comparisons that compile to vector code. The step is at least that of the coordinate
/// `least`.
#[inline(always)]
fn moved(p: Vec3, normal: Vec3, direction: Vec3, least: f32) -> Vec3 {
    let step = larger(largest(p), least) * (ULPS * f32::EPSILON);
    let facing = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
    let side = if facing < 0.0 { -step } else { step };
    Vec3::new(p.x + normal.x * side, p.y + normal.y * side, p.z + normal.z * side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::{hash, owen_sobol_2d};
    use proptest::prelude::*;

    fn bits(ray: &Ray) -> [u32; 8] {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.to_array());
        [ox, oy, oz, ray.t_near, dx, dy, dz, ray.t_far].map(f32::to_bits)
    }

    proptest! {
        #[test]
        fn sixteen_rays_to_a_light_are_those_of_each_point(seed in any::<u32>(), exponent in -20i32..20) {
            let scale = 2f32.powi(exponent);
            let point = |i: u32| {
                let (a, b) = (owen_sobol_2d(i, seed), owen_sobol_2d(i, hash(seed, 1)));
                2.0 * Vec3::new(a.x, a.y, b.x) - 1.0
            };
            let unit = |i: u32| point(i).normalize_or(Vec3::Z);
            // Every third point lies on no surface.
            let place: Vec<(Vec3, Vec3)> = (0..16)
                .map(|i| (scale * point(i), if i % 3 == 0 { Vec3::ZERO } else { unit(i + 16) }))
                .collect();
            let (mut x, mut n) = (Vec3x16::ZERO, Vec3x16::default());
            for (lane, &(position, normal)) in place.iter().enumerate() {
                x.set(lane, position);
                n.set(lane, normal);
            }
            let towards = unit(40);
            for (vpl, kind) in [
                (Vpl::oriented(scale * point(41), towards), VplKind::Oriented),
                (Vpl::omni(scale * point(41)), VplKind::Omni),
                (Vpl::omni(place[3].0), VplKind::Omni),
                (Vpl::directional(towards), VplKind::Directional),
            ] {
                let rays = to_vpl16(&x, &n, &vpl, kind);
                for (lane, (x, n)) in place.iter().enumerate() {
                    prop_assert_eq!(bits(&rays.get(lane)), bits(&to_vpl(*x, *n, &vpl, kind)));
                }
            }
        }
    }
}
