//! Emitters of light, sampled: emitting meshes, point, spot and directional lights, and the environment with the
//! distant discs before it.
//!
//! [`Emitters`] is built once from the scene. Next-event estimation chooses one emitter in proportion to a rough
//! irradiance at the shaded point, with a tree if there are many, then samples that emitter. The light pass chooses by
//! power.

mod area;
mod delta;
mod direct;
mod distribution;
mod emitters;
mod environment;
mod factor;
#[cfg(test)]
mod factor_tests;
mod image;
#[cfg(test)]
mod image_tests;
mod learned;
mod observed;
mod packet;
mod receivers;
mod regions;
mod select;
#[cfg(test)]
mod tests;
mod tree;
mod triangles;

use area::TriangleShape;
pub use area::{AreaLight, AreaPoint};
pub use delta::DeltaEmitter;
pub use direct::{DirectSample, DirectSamples16};
pub use distribution::DiscreteDistribution;
pub use emitters::Emitters;
pub use environment::{EnvironmentLight, EnvironmentSample};
pub use image::{ImageLight, spot_falloff};
pub use learned::Learned;
pub use observed::{LightRays, Observed};
pub use receivers::Receivers16;
pub use regions::Regions;
