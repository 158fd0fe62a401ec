//! Photons that a view is worth, by some samples of it that look for a few.
//!
//! Photons in discs that hold as many have the same noise whatever their number, and blur as much as discs are wide:
//! the error falls with the number to the power of 2/3 where discs are as wide as is best. It counts as the square of
//! the photons' part of the light. So the number of the least error in all for the time rises with the mean of those
//! squares to the power of 3/5.
//!
//! Measured where photons find a third to two thirds of the light (glass ware, lamps in polished cans): four times the
//! usual number are worth 1.2 to 2.6 dB at 10 to 33 % of the time, half as many samples more nothing; in a box with a
//! glass figure, where they find .4 %, an eighth costs .1 dB and spares 18 %.

use super::drawn::Tracer;
use super::{ChainCounts, DrawnLight, EyePass, EyeSettings, adaptive};
use crate::caustics::Caustics;
use crate::paths::{LightSamples, ScatteredEdges};
use base::progress::Control;
use world::World;
use world::view::View;

/// Samples of a pixel.
const SPP: u32 = 4;

/// Seed of the samples over that of the picture's.
const SEED: u32 = 0x1f83_d9ab;

/// Luminance that counts as dark, over the mean of all.
const DARK: f64 = 0.1;

/// Mean square of the photons' part of the light that is worth the usual number of photons.
const USUAL: f64 = 0.01;

impl EyePass<'_> {
    /// Number of photons, over the usual one, that a view is worth which finds the light of a few; and the rays.
    pub fn photons_worth(
        world: &World,
        view: &View,
        settings: EyeSettings,
        few: &Caustics,
        control: &Control,
    ) -> (f64, ChainCounts) {
        let drawn = DrawnLight::default();
        let (edges, light_samples) = (ScatteredEdges::default(), LightSamples::ONE);
        let settings = EyeSettings { spp: SPP, ..settings };
        let tracer = Tracer {
            world,
            view,
            settings,
            drawn: &drawn,
            caustics: Some(few),
            edges,
            light_samples,
            control,
        };
        let squares = adaptive::pilot(view.window.film);
        let pixels = squares.iter().map(|square| square.film_pixels().collect()).collect();
        let (_, found) = tracer.luminances(pixels, settings.seed ^ SEED, None);
        let mean = found.iter().map(|square| square.light).sum::<f64>() / found.len().max(1) as f64;
        let part = |square: &ChainCounts| square.by_photons / (square.light + DARK * mean);
        let squared = found.iter().map(part).filter(|part| part.is_finite()).map(|part| part * part);
        let worth = squared.sum::<f64>() / found.len().max(1) as f64 / USUAL;
        (worth.powf(0.6), found.into_iter().sum())
    }
}
