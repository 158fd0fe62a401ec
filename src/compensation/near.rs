//! Short rays from up to sixteen points at once, and what they meet.

use super::Compensation;
use crate::embree::{Hit, Hits16, Ray, Rays16};
use crate::math::{Frame, Rgb, lanes_in, luminance};
use crate::sampling::{cosine_hemisphere, owen_sobol_2d};
use crate::shadow;
use crate::world::Surface;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Seed of the directions.
const SEED: u32 = 0x5eed;

/// A point whose virtual lights are limited.
#[derive(Clone, Copy, Debug)]
pub struct Clamped {
    /// Where.
    pub position: Vec3,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
    /// Shading frame, z on the side of the light.
    pub frame: Frame,
    /// Largest geometry term of an indirect virtual light; none is clamped where it is not positive and finite.
    pub bound: f32,
    /// Whether it lacks light from area lights too.
    pub direct: bool,
}

/// A point that a ray met, and what light from it would weigh.
#[derive(Clone, Copy)]
pub struct Near {
    /// What it met.
    pub surface: Surface,
    /// How far away.
    pub distance: f32,
    /// Cosine of the ray to the normal it started at.
    pub cos: f32,
    /// Unit shading normal on the side of the ray.
    pub normal: Vec3,
    /// Radiance back along the ray for an irradiance of 1, times max(0, 1 - b/G).
    pub weight: Rgb,
    /// Radiance emitted back along the ray, times max(0, 1 - r²/A).
    pub emitted: Rgb,
}

/// Calls `met` with the number of a point and what one of its `count` rays met that virtual lights lack; ray by ray, and
/// within that in order of the points, of which only sixteen count. Returns how many rays were traced.
pub fn trace(c: &Compensation, points: &[Clamped], count: u32, mut met: impl FnMut(usize, Near)) -> u64 {
    let points = &points[..points.len().min(16)];
    let reach_sq = |p: &Clamped| {
        let clamped = if p.bound > 0.0 && p.bound.is_finite() { p.bound.recip() } else { 0.0 };
        clamped.max(if p.direct { c.furthest_sq } else { 0.0 })
    };
    let valid = (0..points.len()).filter(|&l| reach_sq(&points[l]) > 0.0).fold(0u16, |mask, l| mask | 1 << l);
    if valid == 0 {
        return 0;
    }
    let mut rays = Rays16::default();
    let mut hits = Hits16::default();
    for index in 0..count {
        let local = cosine_hemisphere(owen_sobol_2d(index, SEED));
        for lane in lanes_in(valid) {
            let p = &points[lane];
            let start = shadow::ray_from(p.position, p.geometric_normal, p.frame.to_world(local));
            rays.set(lane, &Ray { t_far: reach_sq(p).sqrt(), ..start });
        }
        // Alike as far as the points' frames are.
        for lane in lanes_in(c.world.accel.closest_hit16(&rays, valid, true, &mut hits)) {
            let hit = Hit {
                t: hits.t[lane],
                u: hits.u[lane],
                v: hits.v[lane],
                geometry: hits.geometry[lane],
                primitive: hits.primitive[lane],
            };
            let p = &points[lane];
            if let Some(near) = weighed(c, &hit, p.frame.to_world(local), local.z, p) {
                met(lane, near);
            }
        }
    }
    u64::from(valid.count_ones() * count)
}

/// The point hit, unless it gives nothing that is lacking.
fn weighed(c: &Compensation, hit: &Hit, direction: Vec3, cos: f32, point: &Clamped) -> Option<Near> {
    let bound = point.bound;
    let distance = hit.t;
    let dist_sq = distance * distance;
    let lit_sq = if point.direct { c.near_sq[hit.geometry as usize] } else { 0.0 };
    // G is no more than this.
    if cos <= bound * dist_sq && lit_sq <= dist_sq {
        return None;
    }
    let world = c.world;
    let surface = world.surface(hit);
    let out = surface.frame.to_local(-direction);
    // Virtual lights radiate by the cosine to the geometric normal.
    let geometry = cos * surface.normal.dot(direction).abs() / dist_sq;
    let mut near =
        Near { surface, distance, cos, normal: surface.frame.normal, weight: Rgb::ZERO, emitted: Rgb::ZERO };
    if surface.frame.normal.dot(direction) > 0.0 {
        near.normal = -near.normal;
    }
    if geometry > bound {
        near.weight = world.bsdf(&surface).diffuse_albedo(out) * ((1.0 - bound / geometry) * FRAC_1_PI);
    }
    if lit_sq > dist_sq {
        near.emitted = world.emitted(&surface, -direction) * (1.0 - dist_sq / lit_sq);
    }
    let most = near.weight + near.emitted;
    (luminance(most) > 0.0 && most.is_finite()).then_some(near)
}
