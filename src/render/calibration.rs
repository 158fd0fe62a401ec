//! Prices of work, and constants of the choice between methods.
//!
//! `lightsplat bench calibrate` fits them to images and writes this file. A comment has the factor by which
//! single images differ from the value, as a root mean square. Values without a comment are not fitted.
//!
//! Values before the first fit: two cores of an AMD EPYC, November 2026.

use crate::prices::Prices;

/// The prices that all choices use.
pub const PRICES: Prices = Prices {
    balanced_denoising: 0.44,
    by_variance: 0.33,
    cached: 0.94,
    counted_ray_by_doubling: 0.03,
    counted_vpl: 1.9,
    denoised_pixel: 6.5,
    fast_denoising: 0.24,
    guided: 0.82,
    indirect_by_pixels: 0.6,
    indirect_by_spp: 0.5,
    indirect_pixels: 65536.0,
    indirect_rays: 5500000.0,
    indirect_spp: 16.0,
    paths_per_sample: 1.8,
    pilot: 1.9,
    ray: 0.08,
    ray_by_doubling: 0.018,
    rays_a_vpl: 5.0,
    sampled: 0.85,
    shadow: 0.5,
    smallest_scene: 32.0,
    vpl: 0.8,
    vpl_rays: 2.6,
};
