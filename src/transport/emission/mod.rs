//! Photons: paths that begin at the emitters of a scene.
//!
//! - [`PhotonEmitter`] begins paths at an emitter; [`target`] and [`lit_sphere`] direct them at the scene;
//! - [`plan`] holds the shares of paths by emitter and their aims. [`openings`] aims paths from infinitely far;
//! - [`walk`] goes from surface to surface; [`tracing`] walks the paths of a plan, and [`trace_photons`] traces as many
//!   as are wanted.

mod emitter;
mod entries;
mod far;
mod lit_sphere;
mod openings;
#[cfg(test)]
mod openings_tests;
mod photon;
mod photons;
mod plan;
mod sample;
mod target;
mod tracing;
mod walk;

pub use emitter::PhotonEmitter;
pub use photon::{Photon, PhotonCounts, PhotonHit, PhotonSettings};
pub use photons::{trace_in_parts, trace_photons};
pub use sample::{EmissionNumbers, EmissionSample};
pub use walk::{Carried, MAX_EDGES, Walk, WalkVertex};
