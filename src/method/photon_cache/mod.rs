//! Photon mapping with radiance caching: the cache of [`super::cache`], its records of indirect light computed by final
//! gathering over a photon map.
//!
//! Paper: what Herzog et al. 2009, section 7, compare with as PM; Jensen 1996, Christensen 1999, Krivanek et al. 2005.
//!
//! | setting | default | meaning |
//! |---|---|---|
//! | `spp` | 4 | eye samples a pixel |
//! | `seed` | 0 | another seed, other photons and other eye samples |
//! | `max_depth` | the scene's | longest path in edges, counted from the eye |
//! | `photons` | 600000 | photons on diffuse surfaces |
//! | `nearest` | 64 | photons in an estimate of irradiance, of which there is one for four photons |
//! | `rays` | 2000 | rays of a record's final gathering |
//! | `own_rays` | 64 | rays of a single sample that records do not serve |
//! | `direct`, `cut`, `family` | as `cache` | direct light, by cuts as there |
//! | `cache` | as `cache`, but cells of 32 samples: that many have as many rays of their own as a record | how many records, and how far each reaches |
//!
//! Use it to compare with `cache`. All but the records of indirect light is the same code: eye pass, direct
//! light, waves, footprints, splatting, adaptation, layers. It has no clamping and so no dark creases; the price is
//! noise of the photons, which shows as blotches, and time.

mod render;

pub use render::{Settings, render};
