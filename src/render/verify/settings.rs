//! Settings of a verification.

use crate::method::Method;
use transport::paths::Estimand;

/// Settings of a verification.
#[derive(Clone, Copy, Debug)]
pub struct VerifySettings {
    /// Approximate number of pixels.
    pub pixels: usize,
    /// Quantity that a pixel estimates.
    pub estimand: Estimand,
    /// Seed of the choice of pixels and of their paths.
    pub seed: u32,
    /// Maximum path length in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
    /// Maximum number of paths per pixel.
    pub max_samples: u32,
}

impl VerifySettings {
    /// Returns these settings for an image of `method`, whose eye samples may differ from those planned with.
    pub fn of(self, method: &Method) -> VerifySettings {
        let estimand = match self.estimand {
            Estimand::Pixels => Estimand::Pixels,
            Estimand::EyeSamples { .. } => Estimand::EyeSamples { spp: method.spp(), seed: method.seed() },
        };
        VerifySettings { estimand, ..self }
    }
}

impl Default for VerifySettings {
    fn default() -> VerifySettings {
        VerifySettings {
            pixels: 1000,
            estimand: Estimand::Pixels,
            seed: 0,
            max_depth: None,
            max_samples: 4096,
        }
    }
}
