//! Images of a scene: methods, settings chosen for a time or an error, sessions and walks.
//!
//! [`session`] is the interface: a scene held ready, and frames rendered of it. [`walk`] renders the frames of a camera
//! path. [`method`] holds the renderers that are compared. [`plan`] chooses settings, [`verify`] measures the error of
//! an image, [`denoise`] removes its noise.

#![forbid(unsafe_code)]

pub mod denoise;
pub mod method;
pub mod plan;
pub mod session;
pub mod verify;
pub mod walk;
