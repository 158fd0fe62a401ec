//! Photons: paths that begin at the emitters of a scene.
//!
//! - [`PhotonEmitter`] begins paths at an emitter; [`target`] and [`lit_sphere`] direct them at the scene;
//! - [`plan`] holds the shares of paths by emitter and their aims, and walks its paths. [`openings`] aims paths from
//!   infinitely far;
//! - [`walk`] goes from surface to surface, and [`trace_photons`] plans from pilot paths and traces as many
//!   paths as are wanted.

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
mod target;
mod walk;

pub use emitter::PhotonEmitter;
pub use photon::{EmissionNumbers, EmissionSample, Photon, PhotonCounts, PhotonHit, PhotonSettings};
pub use photons::{trace_in_parts, trace_photons};
pub use walk::{Carried, MAX_EDGES, Walk, WalkVertex};
