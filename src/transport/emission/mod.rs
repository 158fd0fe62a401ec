//! Photons: paths that begin at the emitters of a scene.
//!
//! - [`PhotonEmitter`] samples the beginnings of paths ([`EmissionSample`]), [`target`] directs them at the scene;
//! - [`contributions`] and [`openings`] re-weight them for the points that the eye sees;
//! - [`trace_photons`] follows the paths and stores photons at diffuse surfaces.

mod contributions;
mod emitter;
mod entries;
mod far;
mod openings;
#[cfg(test)]
mod openings_tests;
mod photons;
mod sample;
mod short_paths;
mod target;

pub use emitter::PhotonEmitter;
pub use photons::{MAX_CORRECTION, Photon, PhotonCounts, PhotonHit, PhotonSettings, trace_photons};
pub use sample::{EmissionNumbers, EmissionSample};
