//! Photon mapping with radiance caching: the cache of [`super::cache`], with records of indirect light by final
//! gathering over a photon map.
//!
//! Papers: the method PM of Herzog et al. 2009, section 7; Jensen 1996; Christensen 1999; Krivanek et al. 2005.
//!
//! Use it to compare with `cache`. Only the records of indirect light differ: the eye pass, direct light, waves,
//! footprints, splatting, adaptation and layers are the same code. The method does not clamp, so creases are not dark.
//! The price is noise of the photons, visible as blotches, and time.

mod render;

pub use render::Settings;
