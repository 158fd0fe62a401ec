//! Samples of a pixel that look for photons: those that find the same ones need not all look.

use crate::caustics::Caustics;
use crate::math::Rgb;
use crate::paths::ChainEnd;

/// Samples for one that looks.
const SAMPLES: u32 = 4;

/// Which paths look, of pixels with as many samples each that are traced together.
#[derive(Clone, Copy, Debug)]
pub(super) struct CausticLooks {
    samples: u32,
    /// The first of them, which are as even over the pixel as all are.
    looking: u32,
}

impl Default for CausticLooks {
    fn default() -> CausticLooks {
        CausticLooks::new(1)
    }
}

impl CausticLooks {
    /// None of the paths.
    pub const NONE: CausticLooks = CausticLooks { samples: 1, looking: 0 };

    /// Of pixels with `samples` samples each.
    pub fn new(samples: u32) -> CausticLooks {
        CausticLooks { samples: samples.max(1), looking: samples.div_ceil(SAMPLES).max(1) }
    }

    /// Radiance that the surface at the end of a chain reflects of the light of photons, if its path looks, for those
    /// that do not, too.
    #[inline]
    pub fn reflected(&self, caustics: &Caustics, end: &ChainEnd) -> Rgb {
        if end.path % self.samples >= self.looking {
            return Rgb::ZERO;
        }
        let found = caustics.reflected(&end.surface, &end.bsdf, end.out, (end.distance, end.depth));
        found * (self.samples as f32 / self.looking as f32)
    }
}
