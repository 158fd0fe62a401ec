//! Order for direct light that the eye pass samples.

use super::{ExtraSamples, Settled};
use crate::caustics::Caustics;
use crate::irradiance::PathEnds;
use world::light::Learned;

/// Order for direct light that the eye pass samples.
#[derive(Clone, Debug, Default)]
pub struct DirectSampling {
    /// True for materials all of whose rough lobes chains follow, by material. For other materials chains follow the
    /// sharp lobes.
    pub followed: Vec<bool>,
    /// Extra samples for the pixels that need them most.
    pub extra_samples: ExtraSamples,
    /// Pixels that need fewer samples.
    pub settled: Settled,
    /// True if the pass also computes guides for a denoiser.
    pub guides: bool,
}

/// Sources of the light that paths of the eye pass find at first hits.
#[derive(Clone, Copy)]
pub struct LightSources<'a> {
    /// Order for direct light.
    pub direct: &'a DirectSampling,
    /// Photons by mirrors and glass, if there are any.
    pub caustics: Option<&'a Caustics>,
    /// Learned light that guides light samples.
    pub learned: Option<&'a Learned>,
    /// Light by which paths end behind specular lobes; `None` if they go on.
    pub path_ends: Option<&'a PathEnds>,
}
