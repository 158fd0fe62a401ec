//! The radiance cache: incident light found at some thousand places, and what the eye samples between them make of it.
//!
//! Paper: Herzog et al. 2009, records splatted onto all eye samples; LCache1 with isotropic, LCache2 with anisotropic
//! footprints. Beyond it: footprints and gradients that know of the edges of occluders (`occlusion`).
//!
//! Deviations: by default neither layer has records. Cuts shared by sixteen places of a patch, and lent to the
//! eye samples among them (see [`crate::lightcut::ReconstructionCut`]), took as long and erred less, most of all where
//! shadows are fine: the patch's cut is its record, a linear fit its gradient, and rays correct it where the sixteen
//! disagree.
//!
//! | setting | default | meaning |
//! |---|---|---|
//! | `spp` | 4 | eye samples a pixel |
//! | `seed` | 0 | another seed, other VPLs and other eye samples |
//! | `max_depth` | the scene's | longest path in edges, counted from the eye |
//! | `light` | as `lightcuts` | how many VPLs |
//! | `cache` | see [`crate::radiance_cache::CacheSettings`] | how many records, and how good |
//! | `cut.epsilon` | 0.02 | largest error to expect of a cluster where eye samples have cuts of their own |
//! | `inspect` | off | further images of what the cache did, see [`inspect`] |
//! | `family` | divisive | how light trees are built |
//!
//! With records, eye samples have lent cuts where their reflection is too sharp for records,
//! where a record would serve too few of them, and where records still disagree visibly after the last pass.

pub(super) mod filled;
pub mod inspect;
pub(crate) mod own;
pub(super) mod picture;
mod render;

pub use render::{Prepared, Settings, render};
