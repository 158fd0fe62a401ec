//! Share of a disc that lies on the surface.
//!
//! Near edges and corners, part of the disc is beyond the surface, where there can be no photons. Rays from a point low
//! above the centre of the disc measure this part. They also test the visibility of photons: an occluded photon may lie
//! in the next room, whose floor continues under the wall.

use super::map::Site;
use crate::emission::Photon;
use base::math::{F32x16, Frame, LANES};
use base::sampling::{hash, owen_sobol_2d};
use embree::{Hits16, Ray, Rays16};
use glam::Vec3;
use std::f32::consts::TAU;
use world::World;
use world::shadow;

/// Height of the ray origin over the disc, in radii.
const HEIGHT: f32 = 0.3;

/// Maximum share by a single ray.
const MAX_SHARE: f32 = 4.0;

/// Factor on distances along the normal.
const NORMAL_SCALE: f32 = 3.0;

/// Minimum cosine between the normals of surfaces that count as one.
pub const MIN_COS: f32 = 0.7;

/// Seed of the points on the disc.
const SEED: u32 = 0xd15c;

/// Number of rays that probe a disc.
pub const RAYS: u64 = LANES as u64 + 1;

/// Returns the squared distance between points of a surface, larger off its plane.
#[inline]
pub fn surface_distance_sq(offset: Vec3, normal: Vec3) -> f32 {
    let height = offset.dot(normal) * NORMAL_SCALE;
    offset.length_squared() + height * height
}

/// Returns the mean of samples, raised so that a quotient by it has the right mean. By Jensen's inequality, quotients
/// by the means themselves are too large: to second order by the relative variance of the mean.
fn divisor(samples: &F32x16) -> f32 {
    let n = samples.len() as f32;
    let mean = samples.iter().sum::<f32>() / n;
    let squares: f32 = samples.iter().map(|x| (x - mean).powi(2)).sum();
    let variance = squares / (n * (n - 1.0));
    if mean > 0.0 { mean + variance / mean } else { 0.0 }
}

/// Disc on a surface, probed from above its centre.
pub struct SurfaceDisc {
    eye: Vec3,
    /// Area of the surface near the disc, weighted by the kernel, over that of a flat disc.
    pub share: f32,
}

impl SurfaceDisc {
    /// Probes the disc around a site.
    pub fn probe(world: &World, site: &Site, radius: f32) -> SurfaceDisc {
        let Site { position, normal } = *site;
        let frame = Frame::from_normal(normal);
        let up = shadow::ray_from(position, normal, normal);
        let free = world.accel.closest_hit(&Ray { t_far: 2.0 * HEIGHT * radius, ..up });
        let height = free.map_or(HEIGHT * radius, |hit| 0.5 * hit.t);
        let eye = position + normal * height;
        // The kernel ends at this depth below the plane.
        let reach = 1.0 + radius / (NORMAL_SCALE * height.max(f32::MIN_POSITIVE));
        let mut rays = Rays16::default();
        // Every disc has points of its own. The errors of a common set would be correlated along a whole edge.
        let seed = position.to_array().iter().fold(SEED, |seed, x| hash(x.to_bits(), seed));
        for lane in 0..LANES {
            let u = owen_sobol_2d(lane as u32, seed);
            // The share of the kernel within the radius ρ is 2ρ² - ρ⁴.
            let (sin, cos) = (TAU * u.x).sin_cos();
            let rho = (1.0 - (1.0 - u.y).sqrt()).max(0.0).sqrt() * radius;
            let target = position + frame.tangent * (rho * cos) + frame.bitangent * (rho * sin);
            rays.set(lane, &Ray { origin: eye, t_near: 0.0, direction: target - eye, t_far: reach });
        }
        let mut hits = Hits16::default();
        let met = world.accel.closest_hit16(&rays, u16::MAX, true, &mut hits);
        let kernel = |distance_sq: f32| 1.0 - distance_sq / (radius * radius);
        let share = |lane: usize| {
            let (to_disc, t) = (rays.get(lane).direction, hits.t[lane]);
            let normal_there = world.geometric_normal(hits.geometry[lane], hits.primitive[lane]);
            let there = kernel(surface_distance_sq(eye + to_disc * t - position, normal));
            if normal_there.dot(normal).abs() < MIN_COS || there <= 0.0 {
                return 0.0;
            }
            // Both areas fill the same solid angle.
            let area = t * t * (to_disc.dot(normal) / to_disc.dot(normal_there)).abs();
            let in_plane = kernel((eye + to_disc - position).length_squared());
            (area * there / in_plane.max(f32::MIN_POSITIVE)).min(MAX_SHARE)
        };
        let shares: F32x16 = std::array::from_fn(|lane| if met >> lane & 1 != 0 { share(lane) } else { 0.0 });
        SurfaceDisc { eye, share: divisor(&shares) }
    }

    /// True if a photon is visible from above.
    pub fn sees(&self, world: &World, photon: &Photon) -> bool {
        let segment = shadow::segment(photon.position, photon.normal, self.eye, Vec3::ZERO);
        !world.accel.occluded(&segment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_by_the_area_of_half_a_disc_have_the_right_mean() {
        let numbers = |i: u32| owen_sobol_2d(i, 9).x;
        let packets = 4096;
        let quotient = |packet: u32| {
            let of = |lane: usize| f32::from(numbers(hash(packet * 16 + lane as u32, 5) >> 8) < 0.5);
            1.0 / f64::from(divisor(&std::array::from_fn(of)))
        };
        let mean = (0..packets).map(quotient).sum::<f64>() / f64::from(packets);
        // Plain means give 2.14.
        assert!((mean - 2.0).abs() < 0.03, "{mean}");
        assert_eq!(divisor(&[1.0; LANES]), 1.0);
        assert_eq!(divisor(&[0.0; LANES]), 0.0);
    }
}
