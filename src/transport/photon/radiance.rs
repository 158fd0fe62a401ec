//! Indirect light along rays of a final gathering.
//!
//! Units: radiance, and distance to the first surface.

use super::indirect_light::{GatherCounts, IndirectLight, facing};
use super::near::NearHits;
use base::math::{LANES, Rgb, lanes_in};
use base::sampling::Sampler;
use embree::{Hits16, Rays16};
use glam::Vec3;

/// Indirect light along a ray, and the surface from which it comes.
#[derive(Clone, Copy, Debug)]
pub struct IncomingRadiance {
    /// Indirect radiance arriving along the ray.
    pub radiance: Rgb,
    /// Distance to the first surface; infinite if there is none.
    pub distance: f32,
    /// Unit geometric normal of the first surface on the side of the ray; zero if there is none.
    pub normal: Vec3,
}

impl IndirectLight<'_> {
    /// Computes the radiance along the rays of `valid` lanes, and the surfaces hit. `seed` determines the random
    /// numbers of continued paths. `coherent` is true for rays of neighbouring strata.
    pub fn along16(
        &self,
        rays: &Rays16,
        valid: u16,
        coherent: bool,
        seed: u32,
        counts: &mut GatherCounts,
    ) -> [IncomingRadiance; LANES] {
        let nothing = IncomingRadiance { radiance: Rgb::ZERO, distance: f32::INFINITY, normal: Vec3::ZERO };
        let mut found = [nothing; LANES];
        let mut hits = Hits16::default();
        let met = self.world.accel.closest_hit16(rays, valid, coherent, &mut hits);
        let mut radiance = [Rgb::ZERO; LANES];
        let mut near = NearHits::default();
        for lane in lanes_in(met) {
            let hit = hits.get(lane);
            let surface = self.world.surface(&hit);
            let direction = rays.get(lane).direction;
            let mut sampler = Sampler::new(seed, lane as u32);
            let (sent, albedo) = self.sent(&surface, direction, hit.t, &mut sampler, counts, |_, _| {});
            radiance[lane] = sent;
            if albedo != Rgb::ZERO {
                near.set(lane, &surface, direction, albedo);
            }
            found[lane] =
                IncomingRadiance { distance: hit.t, normal: facing(&surface, direction), ..nothing };
        }
        match coherent {
            true => self.follow_shared(near, seed, &mut radiance, counts),
            false => self.follow(near, seed, &mut radiance, counts),
        }
        for (seen, radiance) in found.iter_mut().zip(radiance) {
            seen.radiance = radiance;
        }
        found
    }
}
