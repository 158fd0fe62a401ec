//! Work that indirect light is expected to take, before anything is known of it.

/// Rays of records and cuts at the default's samples in a film of so many pixels: points that no record reaches, times
/// the rays of a cut. 1 million (a smooth object on a plane) to 30 million (clutter), whatever the contrast.
const RAYS: f64 = 5.5e6;
const PIXELS: f64 = 65536.0;
const SPP: f64 = 16.0;
/// Exponents by which they grow with the pixels, and with the samples along the levels of quality, which make cuts
/// finer.
const BY_PIXELS: f64 = 0.6;
const BY_SPP: f64 = 0.5;

/// Rays that take as long as a virtual light in the light pass and the tree.
const RAYS_A_VPL: f64 = 5.0;

/// Rays of records and cuts for a film of so many pixels, of so many samples each.
pub fn indirect_rays(film_pixels: f64, spp: f64) -> f64 {
    RAYS * (film_pixels / PIXELS).powf(BY_PIXELS) * (spp / SPP).powf(BY_SPP)
}

/// The same with so many virtual lights, in rays.
pub fn rays_beside_samples(film_pixels: f64, spp: f64, vpls: f64) -> f64 {
    indirect_rays(film_pixels, spp) + RAYS_A_VPL * vpls
}
