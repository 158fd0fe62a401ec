//! Work of images, counted and priced, so that choices do not depend on the machine or its load.
//!
//! [`Work`] counts what an image took. [`PRICES`] turns counts into time. [`ScenePrices`] holds the prices that depend
//! on the scene, since a ray takes longer among more triangles. Predictions of work are in [`crate::plan`].
//!
//! Units: microseconds of one core of the machine on which the prices were measured. [`crate::plan::measure_prices`]
//! measures them on another.

use oidn::Quality;

/// Work that an image took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Virtual lights.
    pub vpls: u64,
    /// Eye samples besides the first ones.
    pub extra_samples: u64,
    /// Branches of eye paths that were dropped, because too many specular surfaces follow each other.
    pub dropped_branches: u64,
}

/// Prices of the parts of a render. Numbers without a unit are ratios.
#[derive(Clone, Copy, Debug)]
pub struct Prices {
    /// Price of a ray in a scene of [`Prices::smallest_scene`].
    pub ray: f64,
    /// Price that each doubling of the triangles adds to a ray.
    pub ray_by_doubling: f64,
    /// Price that each doubling of the triangles adds to a counted ray, with the work done between its rays.
    pub counted_ray_by_doubling: f64,
    /// Number of triangles up to which a ray costs the least.
    pub smallest_scene: f64,
    /// Price of a ray of the cache's eye samples over a ray of a path, with light samples, shading points and guides.
    pub sampled: f64,
    /// Price of a ray of records and cuts over a ray of a path.
    pub cached: f64,
    /// Price of a ray of the pilot over a ray of a path. The pilot traces few rays at a time.
    pub pilot: f64,
    /// Price of a ray of a path whose guides come with it, over one whose guides take further rays.
    pub guided: f64,
    /// Price of a shadow ray over a closest-hit ray.
    pub shadow: f64,
    /// Price of a virtual light in the light pass and the tree, without its rays.
    pub vpl: f64,
    /// Number of rays of a virtual light.
    pub vpl_rays: f64,
    /// Price of a counted virtual light, with its photon path.
    pub counted_vpl: f64,
    /// Number of rays of the eye pass that cost as much as a virtual light.
    pub rays_a_vpl: f64,
    /// Rays of records and cuts in an image of `indirect_pixels`, with `indirect_spp` samples per pixel.
    pub indirect_rays: f64,
    /// See [`Prices::indirect_rays`].
    pub indirect_pixels: f64,
    /// See [`Prices::indirect_rays`].
    pub indirect_spp: f64,
    /// Exponent by which the rays of records and cuts grow with the pixels.
    pub indirect_by_pixels: f64,
    /// Exponent by which the rays of records and cuts grow with the samples along the quality scale.
    pub indirect_by_spp: f64,
    /// Price of a pixel by the best denoising network.
    pub denoised_pixel: f64,
    /// Price of the balanced network over the best one.
    pub balanced_denoising: f64,
    /// Price of the fast network over the best one.
    pub fast_denoising: f64,
}

/// The prices that all choices use.
pub const PRICES: Prices = Prices {
    ray: 0.08,
    ray_by_doubling: 0.018,
    counted_ray_by_doubling: 0.03,
    smallest_scene: 32.0,
    sampled: 0.85,
    cached: 0.94,
    pilot: 1.9,
    guided: 0.82,
    shadow: 0.5,
    vpl: 0.8,
    vpl_rays: 2.6,
    counted_vpl: 1.9,
    rays_a_vpl: 5.0,
    indirect_rays: 5.5e6,
    indirect_pixels: 65536.0,
    indirect_spp: 16.0,
    indirect_by_pixels: 0.6,
    indirect_by_spp: 0.5,
    denoised_pixel: 6.5,
    balanced_denoising: 0.44,
    fast_denoising: 0.24,
};

impl Prices {
    /// Returns the price of denoising at `quality` over that at the best.
    pub fn denoising(&self, quality: Quality) -> f64 {
        match quality {
            Quality::Fast => self.fast_denoising,
            Quality::Balanced => self.balanced_denoising,
            Quality::High => 1.0,
        }
    }

    /// Returns the expected rays of records and cuts for a film of `film_pixels`, with `spp` samples per pixel.
    pub fn indirect_rays(&self, film_pixels: f64, spp: f64) -> f64 {
        self.indirect_rays
            * (film_pixels / self.indirect_pixels).powf(self.indirect_by_pixels)
            * (spp / self.indirect_spp).powf(self.indirect_by_spp)
    }

    /// Returns the expected work besides the eye samples, in rays, of an image with `vpls` virtual lights.
    pub fn rays_beside_samples(&self, film_pixels: f64, spp: f64, vpls: f64) -> f64 {
        self.indirect_rays(film_pixels, spp) + self.rays_a_vpl * vpls
    }
}

/// Prices of rays in a scene.
#[derive(Clone, Copy, Debug)]
pub struct ScenePrices {
    /// Price of a ray of a path.
    pub ray: f64,
    /// Price of a counted ray, with the work done between rays.
    pub counted_ray: f64,
}

impl ScenePrices {
    /// Returns the prices in a scene with so many triangles.
    pub fn new(triangles: usize) -> ScenePrices {
        let doublings = (triangles as f64 / PRICES.smallest_scene).max(1.0).log2();
        let ray = |by_doubling: f64| PRICES.ray + by_doubling * doublings;
        ScenePrices { ray: ray(PRICES.ray_by_doubling), counted_ray: ray(PRICES.counted_ray_by_doubling) }
    }

    /// Returns the time of counted work.
    pub fn time(&self, work: &Work) -> f64 {
        let rays = work.rays as f64 + PRICES.shadow * work.shadow_rays as f64;
        rays * self.counted_ray + work.vpls as f64 * PRICES.counted_vpl
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counted_work_is_that_of_all_rays_and_virtual_lights() {
        let prices = ScenePrices::new(32);
        let rays = Work { rays: 1_000_000, ..Work::default() };
        let of_rays = prices.time(&rays);
        assert_eq!(of_rays, 1e6 * PRICES.ray);
        let all = Work { shadow_rays: 3_000_000, vpls: 1000, extra_samples: 1 << 40, ..rays };
        assert!((prices.time(&all) - 2.5 * of_rays - 1000.0 * PRICES.counted_vpl).abs() < 1e-3);
    }

    #[test]
    fn rays_cost_more_among_more_triangles() {
        let prices = [1, 32, 64, 1 << 20].map(ScenePrices::new);
        assert_eq!(prices[0].ray, prices[1].ray);
        assert!(prices[1..].is_sorted_by(|a, b| a.ray < b.ray && a.counted_ray < b.counted_ray));
    }
}
