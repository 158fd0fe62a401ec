//! Images of a scene: methods, settings planned for a time or an error, sessions and walks.
//!
//! [`session`] is the interface: a scene that is ready to render, and its frames. [`walk`] renders the frames of a
//! camera path. [`method`] holds the renderers that are compared. [`cost`] counts their work, [`prices`] and
//! [`calibration`] price it. [`plan`] chooses settings, [`verify`] measures the error of an image, [`denoise`] removes
//! its noise.

#![forbid(unsafe_code)]

pub mod calibration;
pub mod cost;
pub mod denoise;
pub mod method;
pub mod plan;
pub mod prices;
pub mod session;
pub mod verify;
pub mod walk;
