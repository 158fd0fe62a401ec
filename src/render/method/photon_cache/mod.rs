//! Photon mapping with radiance caching: the cache of [`super::cache`], its records of indirect light
//! computed by final gathering over a photon map.
//!
//! Paper: the method that Herzog et al. 2009, section 7, compare with as PM; Jensen 1996, Christensen 1999,
//! Krivanek et al. 2005.
//!
//! Use it to compare with `cache`. All but the records of indirect light is the same code: eye pass, direct
//! light, waves, footprints, splatting, adaptation, layers. It has no clamping and so no dark creases; the
//! price is noise of the photons, visible as blotches, and time.

mod render;

pub use render::Settings;
