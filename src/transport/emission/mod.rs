//! Emission of photons, and the paths of photons through a scene.
//!
//! - [`PhotonEmitter`] begins paths at an emitter; [`target`] and [`lit_sphere`] direct them at the scene;
//! - [`plan`] holds the shares of paths by emitter, from their [`contributions`] to the points that the eye sees;
//! - [`tracing`] follows the paths of a plan; [`trace_photons`] traces as many as are wanted.

mod contributions;
mod emitter;
mod lit_sphere;
mod photon;
mod photons;
mod plan;
mod sample;
mod short_paths;
mod target;
mod tracing;

pub use emitter::PhotonEmitter;
pub use photon::{Photon, PhotonCounts, PhotonHit, PhotonSettings};
pub use photons::trace_photons;
pub use sample::{EmissionNumbers, EmissionSample};
pub use tracing::MAX_CORRECTION;
