//! Caustic photon count for a view, from a pilot with a sixteenth of the photons.
//!
//! If each lookup disc holds the same number of photons, the noise does not depend on their total number, and the blur
//! grows with the discs. With discs of optimal size the error falls with the number of photons to the power of 2/3.
//! The error is weighted by the square of the photons' part of the light. Hence the number with the least product of
//! error and time grows with the mean of these squares to the power of 3/5.

use super::tracer::Tracer;
use super::{DirectSampling, EyeCounts, EyePass, EyeSettings, adaptive};
use crate::caustics::Caustics;
use crate::paths::{LightSamples, ScatteredEdges};
use base::progress::Control;
use world::World;
use world::view::View;

/// Number of samples per pixel.
const SPP: u32 = 4;

/// Seed of the samples, combined with the image's seed.
const SEED: u32 = 0x1f83_d9ab;

/// Luminance that counts as dark, over the mean of all pixels.
const DARK: f64 = 0.1;

/// Mean square of the photons' part of the light for which the base number of photons is right.
const SQUARE_AT_BASE_COUNT: f64 = 0.01;

impl EyePass<'_> {
    /// Returns the photon count for a view as a multiple of the base count, and the rays traced. `few` is the light of
    /// the pilot's photons.
    pub fn photon_count_factor(
        world: &World,
        view: &View,
        settings: EyeSettings,
        few: &Caustics,
        control: &Control,
    ) -> (f64, EyeCounts) {
        let direct = DirectSampling::default();
        let (edges, light_samples) = (ScatteredEdges::default(), LightSamples::ONE);
        let settings = EyeSettings { spp: SPP, ..settings };
        let tracer = Tracer {
            world,
            view,
            settings,
            direct: &direct,
            caustics: Some(few),
            learned: None,
            path_ends: None,
            edges,
            light_samples,
            control,
        };
        let squares = adaptive::pilot(view.window.film);
        let pixels = squares.iter().map(|square| square.film_pixels().collect()).collect();
        let (_, found) = tracer.luminances(pixels, settings.seed ^ SEED);
        let mean = found.iter().map(|square| square.light).sum::<f64>() / found.len().max(1) as f64;
        let part = |square: &EyeCounts| square.by_photons / (square.light + DARK * mean);
        let squared = found.iter().map(part).filter(|part| part.is_finite()).map(|part| part * part);
        let relative = squared.sum::<f64>() / found.len().max(1) as f64 / SQUARE_AT_BASE_COUNT;
        (relative.powf(0.6), found.into_iter().sum())
    }
}
