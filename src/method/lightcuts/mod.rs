//! Lightcuts per pixel: every eye sample has its own cut, or shares one with its neighbours.
//!
//! Paper: Walter et al., *Lightcuts*, 2005; "LC" in Herzog et al. 2009, section 6, over direct and indirect VPLs.
//!
//! | setting | default | meaning |
//! |---|---|---|
//! | `spp` | 1 | eye samples a pixel |
//! | `seed` | 0 | another seed, other VPLs and other eye samples |
//! | `max_depth` | the scene's | longest path in edges, counted from the eye |
//! | `light.direct` | 4096 | VPLs on area lights, and directions of the environment |
//! | `light.indirect` | 300 000 | VPLs where light is reflected |
//! | `cut.epsilon` | 0.02 | largest error to expect of a cluster, relative to the sample's luminance |
//! | `cut.max_cut` | 1000 | most clusters in a cut |
//! | `cut.clamp` | 0.02 | most that one indirect VPL may contribute, relative to the sample's luminance |
//! | `compensation` | on | whether short rays find again what clamping takes away |
//! | `share` | true | whether neighbouring eye samples share cuts, for speed |
//! | `shadows` | cached where not `share` | which shadow rays ask an occluder cache, and its size |
//! | `family` | divisive | how light trees are built |
//!
//! Use it where a picture without noise is wanted and a small, smooth error is not in the way. Not for caustics on
//! what the eye sees: light that reaches a visible surface through glass or by a mirror is missing there (what
//! that surface reflects onto others is not).

mod render;
mod tile;

pub use render::{Settings, render};
