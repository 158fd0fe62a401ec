//! lightsplat: global illumination by lightcuts, reconstructed or cached, and a path-traced reference, over
//! Embree 4.
//!
//! [`session`] is the interface: a scene that is ready to render, and its frames. [`walk`] renders the frames of a
//! camera path.
//!
//! ```no_run
//! # use lightsplat::{film::write_exr, progress::Control, session::{Goal, Session}, view::{Framing, View}};
//! # use std::path::Path;
//! let session = Session::open(Path::new("scenes/cornell.toml"), &Default::default())?.session;
//! let view = View::new(&session.cameras, &Framing::default())?;
//! let frame = session.frame(&view, &Goal::default(), &Control::new())?;
//! write_exr(Path::new("cornell.exr"), &frame.film)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The crates behind it, in the order of the data:
//!
//! - [`base`]: mathematics, threads, counters, settings, images and their files;
//! - [`scene`]: the scene model; [`readers`] read scene files;
//! - `embree`: rays; [`world`]: a scene ready for rendering;
//! - `transport`: light between surfaces; [`render`]: methods, plans, sessions;
//! - `bench`: measurements; [`cli`]: the command.

#![forbid(unsafe_code)]

pub use base::{self, film, live, math, progress, setting, stats};
pub use render::{self, method, session, verify, walk};
pub use world::{self, view};
pub use {cli, readers, scene};

/// Examples of `docs/library.md`, which are compiled as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
struct LibraryPage;
