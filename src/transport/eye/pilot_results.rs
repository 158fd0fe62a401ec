//! Results of the pilots of the eye pass with direct light (see [`super::pilots`]).

use super::EyeCounts;
use super::effort::SampledSquares;
use crate::paths::ScatteredEdges;
use world::light::Learned;

/// Results of the pilots.
pub struct EyePilots {
    pub(super) edges: ScatteredEdges,
    /// Visibility of emitters; `None` if there is nothing to learn.
    pub(super) learned: Option<Learned>,
    /// Pixels that were sampled; `None` if they decide nothing.
    pub(super) squares: Option<SampledSquares>,
    /// Rays of the first two pilots.
    pub(super) chains: EyeCounts,
}

impl EyePilots {
    /// Returns the rays of all pilots.
    pub fn chains(&self) -> EyeCounts {
        self.squares.iter().map(|squares| squares.chains).chain([self.chains]).sum()
    }
}
