//! Expected work of images, by a pilot and the prices of [`crate::cost`].
//!
//! Denoising takes about as long for every method and is left out.

use super::pilot::Pilot;
use crate::calibration::PRICES;
use crate::cost::ScenePrices;
use crate::method::{Demand, Method};
use transport::eye::ExtraSamples;

/// Relative variance of a pixel's sampled light up to which all points have cuts.
///
/// Above it, more and more points have samples of cuts, which take less time.
const CALM: f64 = 0.005;
/// Exponent by which the time of cuts falls with that variance.
const BY_NOISE: f64 = -0.25;
/// Minimum factor of that variance on the time of cuts.
const MIN_BY_NOISE: f64 = 0.55;

/// Expected work for the film of a scene.
#[derive(Clone, Copy, Debug)]
pub struct ExpectedWork {
    prices: ScenePrices,
    pixels: f64,
}

impl ExpectedWork {
    /// Creates the model for so many pixels, in a scene with so many triangles.
    pub fn new(triangles: usize, pixels: u64) -> ExpectedWork {
        ExpectedWork { prices: ScenePrices::new(triangles), pixels: pixels as f64 }
    }

    /// Returns the work of `spp` paths per pixel.
    pub fn of_paths(&self, pilot: &Pilot, spp: f64) -> f64 {
        self.pixels * spp * pilot.rays_of_paths * self.prices.ray * PRICES.guided
    }

    /// Returns the work of the cache with the settings of `method`.
    pub fn of_cache(&self, pilot: &Pilot, method: &Method) -> f64 {
        let spp = f64::from(method.spp());
        let samples = self.pixels * spp * (1.0 + self.extra_samples(pilot, method));
        let lights = f64::from(method.demand().vpls) * (PRICES.vpl + PRICES.vpl_rays * self.prices.ray);
        let noise = pilot.variance_of_sampled / spp.max(1.0);
        let of_cuts = (noise / CALM).powf(BY_NOISE).clamp(MIN_BY_NOISE, 1.0);
        let indirect = PRICES.cached * of_cuts * PRICES.indirect_rays(self.pixels, spp);
        let rays = PRICES.sampled * samples * pilot.rays_of_sampled + indirect;
        rays * self.prices.ray + lights
    }

    /// Returns the expected share of extra samples of the cache, over the first ones.
    fn extra_samples(&self, pilot: &Pilot, method: &Method) -> f64 {
        let (spp, Demand { vpls, extra_samples, .. }) = (f64::from(method.spp()), method.demand());
        let other_rays = Some(PRICES.rays_beside_samples(self.pixels, spp, vpls.into()));
        let extra = ExtraSamples { most: extra_samples, other_rays };
        extra.share(self.pixels * spp * pilot.rays_of_sampled).into()
    }

    /// Returns the work of the pilot itself.
    pub fn of_pilot(&self, pilot: &Pilot) -> f64 {
        PRICES.pilot * pilot.rays as f64 * self.prices.ray
    }
}
