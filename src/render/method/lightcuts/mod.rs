//! Lightcuts per pixel: every eye sample has its own cut, or shares one with its neighbours.
//!
//! Paper: Walter et al., *Lightcuts*, 2005; "LC" in Herzog et al. 2009, section 6, over direct and indirect VPLs.
//!
//! Use it for images without noise if a small, smooth error is acceptable. Light that reaches visible surfaces through
//! glass or over mirrors is found by four paths from each eye sample, with their noise.

mod blocks;
mod render;

pub use render::Settings;
