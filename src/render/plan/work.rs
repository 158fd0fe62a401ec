//! Work that a picture is expected to take, or took: rays, virtual lights and samples at fixed prices, so that choices
//! by it do not depend on the machine or its load.
//!
//! Units: microseconds of one core of the machine on which the prices were measured. Denoising takes about as long
//! whatever made the picture and is left out.

use super::pilot::Pilot;
use crate::method::Method;
use base::stats::{Counter, Stats};
use transport::eye::ExtraSamples;
use transport::radiance_cache::work::{indirect_rays, rays_beside_samples};

/// Price of a ray in the smallest scenes, and what every doubling of the triangles adds to it.
const RAY: f64 = 0.08;
const RAY_BY_DOUBLING: f64 = 0.018;
/// Price of a ray of the cache's samples over that of a path, for light samples, shading points and guides, and of rays
/// of its records and cuts.
const SAMPLED: f64 = 1.25;
const CACHED: f64 = 0.94;
/// Price of a ray of the pilot over that of a path: it is done by few rays at a time.
const PILOT: f64 = 1.9;
/// Price of a ray of a path over the same when guides were found by further rays: .71 to .89 in three scenes. The other
/// prices were measured against that.
const GUIDED: f64 = 0.82;
/// Price of a shadow ray over that of a ray that is traced to the surface it meets, which is looked at.
const SHADOW: f64 = 0.5;
/// Relative variance of a pixel's drawn light up to which points have cuts; exponent by which these take less time
/// beyond, as ever more points have samples of cuts; least share: 1 in a stairwell, .55 in a living room and a nave.
const CALM: f64 = 0.005;
const BY_NOISE: f64 = -0.25;
const LEAST_BY_NOISE: f64 = 0.55;
/// Number of triangles of the smallest scenes.
const FEW: f64 = 32.0;
/// Price of a virtual light in the light pass and the tree, and its rays.
const VPL: f64 = 0.8;
const VPL_RAYS: f64 = 2.6;
/// The same of a picture that is made: price added to a ray by every doubling of the triangles, for all that is done
/// between its rays, and price of a virtual light, its photon path included.
const COUNTED_RAY_BY_DOUBLING: f64 = 0.03;
const COUNTED_VPL: f64 = 1.9;

/// Prices in a scene, and the film.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    ray: f64,
    counted_ray: f64,
    pixels: f64,
}

impl Work {
    /// Work for so many pixels of a scene of so many triangles.
    pub fn new(triangles: usize, pixels: u64) -> Work {
        let doublings = (triangles as f64 / FEW).max(1.0).log2();
        let ray = |by_doubling: f64| RAY + by_doubling * doublings;
        let counted_ray = ray(COUNTED_RAY_BY_DOUBLING);
        Work { ray: ray(RAY_BY_DOUBLING), counted_ray, pixels: pixels as f64 }
    }

    /// Of `spp` paths a pixel.
    pub fn of_paths(&self, pilot: &Pilot, spp: f64) -> f64 {
        self.pixels * spp * pilot.rays_of_paths * self.ray * GUIDED
    }

    /// Of the cache with the settings of `method`.
    pub fn of_cache(&self, pilot: &Pilot, method: &Method) -> f64 {
        let number = |key| method.number(key).unwrap_or(0.0);
        let spp = number("spp");
        let samples = self.pixels * spp * (1.0 + self.extra_samples(pilot, method));
        let lights = number("vpls") * (VPL + VPL_RAYS * self.ray);
        let noise = pilot.variance_of_drawn / spp.max(1.0);
        let of_cuts = (noise / CALM).powf(BY_NOISE).clamp(LEAST_BY_NOISE, 1.0);
        let indirect = CACHED * of_cuts * indirect_rays(self.pixels, spp);
        let rays = SAMPLED * samples * pilot.rays_of_drawn + indirect;
        rays * self.ray + lights
    }

    /// Samples of the cache beside the first ones, as a share of these, if as many are needed as are worth their time.
    fn extra_samples(&self, pilot: &Pilot, method: &Method) -> f64 {
        let number = |key| method.number(key).unwrap_or(0.0);
        let other_rays = Some(rays_beside_samples(self.pixels, number("spp"), number("vpls")));
        let extra = ExtraSamples { most: number("extra_samples") as f32, other_rays };
        extra.share(self.pixels * number("spp") * pilot.rays_of_drawn).into()
    }

    /// Of a picture that is made, by the counters of its rays and virtual lights.
    pub fn of_counted(&self, stats: &Stats) -> f64 {
        let price = |name: &str| match name {
            "VPLs/total" => COUNTED_VPL,
            "Rays/shadow" => SHADOW * self.counted_ray,
            _ if name.ends_with("/shadow rays") => SHADOW * self.counted_ray,
            _ if name.ends_with("/closest hit") => self.counted_ray,
            _ => 0.0,
        };
        let work = |(name, counter)| match counter {
            Counter::Count(n) => n as f64 * price(name),
            Counter::Sum(_) | Counter::Distribution(_) => 0.0,
        };
        stats.counters().map(work).sum()
    }

    /// Of the pilot itself.
    pub fn of_pilot(&self, pilot: &Pilot) -> f64 {
        PILOT * pilot.rays as f64 * self.ray
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counted_work_is_that_of_all_rays_and_virtual_lights() {
        let work = Work::new(32, 1);
        let mut stats = Stats::new();
        stats.count("Rays/closest hit", 1_000_000);
        let of_rays = work.of_counted(&stats);
        assert_eq!(of_rays, 1e6 * RAY);
        for name in ["Eye/shadow rays", "Lightcut/shadow rays", "Rays/shadow"] {
            stats.count(name, 1_000_000);
        }
        stats.count("VPLs/total", 1000);
        stats.count("Cache/records, indirect", 1 << 40);
        assert!((work.of_counted(&stats) - 2.5 * of_rays - 1000.0 * COUNTED_VPL).abs() < 1e-3);
    }
}
