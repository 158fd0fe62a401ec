//! lightsplat: global illumination by lightcuts, reconstructed or cached, and a path-traced reference, over
//! Embree 4.
//!
//! [`session`] is the interface: a scene held ready, and frames rendered of it; [`walk`] renders those of a camera
//! path. The crates behind it, in the order of the data:
//!
//! - [`base`]: mathematics, threads, counters, settings, images and their files;
//! - [`scene`]: the scene model; [`readers`] read scene files;
//! - `embree`: rays; [`world`]: a scene ready for rendering;
//! - `transport`: light between surfaces; [`render`]: methods, plans, sessions;
//! - `bench`: measurements; [`cli`]: the command.

#![forbid(unsafe_code)]

pub use base::{self, film, math, progress, setting, stats};
pub use render::{self, method, session, verify, walk};
pub use world::{self, view};
pub use {cli, readers, scene};
