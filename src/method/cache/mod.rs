//! The radiance cache: records at a few thousand points, splatted onto all eye samples.
//!
//! Paper: Herzog et al. 2009; LCache1 with isotropic, LCache2 with anisotropic footprints. Beyond it, and by
//! default: footprints and gradients that know of the edges of occluders (`occlusion`).
//!
//! | setting | default | meaning |
//! |---|---|---|
//! | `spp` | 1 | eye samples a pixel |
//! | `seed` | 0 | another seed, other VPLs and other eye samples |
//! | `max_depth` | the scene's | longest path in edges, counted from the eye |
//! | `light` | as `lightcuts` | how many VPLs |
//! | `cache` | see [`crate::cache::CacheSettings`] | how many records, and how good |
//! | `cut.epsilon` | 0.02 | largest error to expect of a cluster where eye samples have cuts of their own |
//! | `inspect` | off | further images of what the cache did, see [`inspect`] |
//! | `family` | divisive | how light trees are built |
//!
//! Eye samples have cuts of their own, shared among neighbours, where their reflection is too sharp for records,
//! where a record would serve too few of them, and where records still disagree visibly after the last pass.

pub(super) mod filled;
pub mod inspect;
pub(crate) mod own;
pub(super) mod picture;
mod render;

pub use render::{Settings, render};
