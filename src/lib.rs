//! lightsplat: global illumination by lightcuts and radiance-cache splatting over Embree 4.

#![deny(unsafe_code)]

pub mod cli;
pub mod embree;
pub mod eye;
pub mod image;
pub mod light;
pub mod light_tree;
pub mod lightcut;
pub mod material;
pub mod math;
pub mod method;
pub mod sampling;
pub mod scene;
pub mod shadow;
pub mod stats;
pub mod vpl;
pub mod world;
