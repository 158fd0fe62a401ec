//! Expected work of indirect light, before the image is known.

/// Rays of records and cuts, by default settings, in a film of `PIXELS` pixels: points that no record reaches, times
/// the rays of a cut.
const RAYS: f64 = 5.5e6;

/// Number of film pixels to which `RAYS` refers.
const PIXELS: f64 = 65536.0;

/// Number of samples per pixel to which `RAYS` refers.
const SPP: f64 = 16.0;

/// Exponent of the number of film pixels in the rays of records and cuts.
const PIXEL_EXPONENT: f64 = 0.6;

/// Exponent of the samples per pixel in the rays of records and cuts. Cuts become finer with them along the levels of
/// quality.
const SPP_EXPONENT: f64 = 0.5;

/// Cost of a virtual light in the light pass and the tree, in rays.
const RAYS_PER_VPL: f64 = 5.0;

/// Returns the expected rays of records and cuts for a film of `film_pixels` pixels with `spp` samples each.
pub fn indirect_rays(film_pixels: f64, spp: f64) -> f64 {
    RAYS * (film_pixels / PIXELS).powf(PIXEL_EXPONENT) * (spp / SPP).powf(SPP_EXPONENT)
}

/// Returns the expected cost of all work besides samples, in rays: records, cuts, and `vpls` virtual lights.
pub fn rays_beside_samples(film_pixels: f64, spp: f64, vpls: f64) -> f64 {
    indirect_rays(film_pixels, spp) + RAYS_PER_VPL * vpls
}
