//! Prices that turn counts of work into time, and the constants of the choice between methods.
//!
//! Values are in [`crate::calibration`].

use oidn::Quality;
use serde::Serialize;

/// Prices of the parts of a render. Numbers without a unit are ratios.
#[derive(Clone, Copy, Debug, Serialize)]
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
    /// Number of paths that replace a sample of the cache, with its extra samples, if both have the same variance.
    pub paths_per_sample: f64,
    /// Exponent by which that number grows with the quotient of the variances. A denoiser removes most noise, whatever
    /// its variance, and leaves edges.
    pub by_variance: f64,
}

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
