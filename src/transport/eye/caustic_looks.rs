//! Samples of a pixel that look for photons: those that find the same ones need not all look.

use crate::caustics::Caustics;
use crate::paths::ChainEnd;
use base::math::{Rgb, luminance};

/// Samples for one that looks.
const SAMPLES: u32 = 4;

/// Which paths look, of pixels with as many samples each that are traced together.
#[derive(Clone, Copy, Debug)]
pub(super) struct CausticLooks {
    samples: u32,
    /// The first of them, which are as even over the pixel as all are.
    looking: u32,
    /// Luminance of the photons' light that reached the eye, as a sum over the samples.
    pub found: f64,
    /// Mean square of that which paths find in its place, as a sum over the samples.
    pub square: f64,
}

impl Default for CausticLooks {
    fn default() -> CausticLooks {
        CausticLooks::new(1)
    }
}

impl CausticLooks {
    /// None of the paths.
    pub const NONE: CausticLooks = CausticLooks { samples: 1, looking: 0, found: 0.0, square: 0.0 };

    /// Of pixels with `samples` samples each.
    pub fn new(samples: u32) -> CausticLooks {
        let looking = samples.div_ceil(SAMPLES).max(1);
        CausticLooks { samples: samples.max(1), looking, found: 0.0, square: 0.0 }
    }

    /// Radiance that the surface at the end of a chain reflects of the light of photons, if its path looks, for those
    /// that do not, too.
    #[inline]
    pub fn reflected(&mut self, caustics: &Caustics, end: &ChainEnd) -> Rgb {
        if end.path % self.samples >= self.looking {
            return Rgb::ZERO;
        }
        let found = caustics.reflected(&end.surface, &end.bsdf, end.out, (end.distance, end.depth));
        let scale = self.samples as f32 / self.looking as f32;
        let radiance = found.radiance * scale;
        let seen = luminance(end.throughput * radiance);
        if seen.is_finite() {
            self.found += f64::from(seen);
            let by_emitted = f64::from(found.by_emitted.min(f32::MAX));
            self.square += f64::from(luminance(end.throughput)).powi(2) * by_emitted * f64::from(scale);
        }
        radiance
    }
}
