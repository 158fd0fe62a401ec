//! Choice of the samples that look up photons. Only every fourth sample of a pixel does; the others would find the
//! same photons.

use crate::caustics::Caustics;
use crate::paths::ChainEnd;
use base::math::{Rgb, luminance};

/// Number of samples per lookup.
const SAMPLES_PER_LOOKUP: u32 = 4;

/// Lookups of pixels that are traced together with the same number of samples each.
#[derive(Clone, Copy, Debug)]
pub(super) struct CausticLookups {
    samples: u32,
    /// Number of samples that do lookups: the first ones, which are spread over the pixel as evenly as all.
    looking: u32,
    /// Luminance of the photons' light that reached the eye, summed over the samples.
    pub found: f64,
    /// Second moment of the path estimator for the same light, summed over the samples.
    pub square: f64,
}

impl Default for CausticLookups {
    fn default() -> CausticLookups {
        CausticLookups::new(1)
    }
}

impl CausticLookups {
    /// No path does lookups.
    pub const NONE: CausticLookups = CausticLookups { samples: 1, looking: 0, found: 0.0, square: 0.0 };

    /// Returns the lookups of pixels with `samples` samples each.
    pub fn new(samples: u32) -> CausticLookups {
        let looking = samples.div_ceil(SAMPLES_PER_LOOKUP).max(1);
        CausticLookups { samples: samples.max(1), looking, found: 0.0, square: 0.0 }
    }

    /// Returns true if a path does lookups.
    #[inline]
    pub fn looks_up(&self, path: u32) -> bool {
        path % self.samples < self.looking
    }

    /// Returns the photons' light that the first hit of a path reflects, scaled for the paths without lookups; 0 if
    /// the path itself does none.
    #[inline]
    pub fn reflected(&mut self, caustics: &Caustics, end: &ChainEnd) -> Rgb {
        if !self.looks_up(end.path) {
            return Rgb::ZERO;
        }
        let reflected = caustics.reflected(&end.surface, &end.bsdf, end.out, end.distance, end.depth);
        let scale = self.samples as f32 / self.looking as f32;
        let radiance = reflected.radiance * scale;
        let seen = luminance(end.throughput * radiance);
        if seen.is_finite() {
            self.found += f64::from(seen);
            let by_emitted = f64::from(reflected.by_emitted.min(f32::MAX));
            self.square += f64::from(luminance(end.throughput)).powi(2) * by_emitted * f64::from(scale);
        }
        radiance
    }
}
