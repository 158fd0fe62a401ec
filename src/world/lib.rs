//! A scene prepared for rendering: the scene itself, its acceleration structure, material tables and emitters.
//!
//! [`material`] is scattering at surfaces, [`light`] emission, [`shadow`] visibility between points, and [`view`] a
//! camera and the part of its film to render. A [`World`] is immutable and shared by all threads.
//!
//! Units: positions are relative to the scene's centre.

#![forbid(unsafe_code)]

#[cfg(test)]
mod attribute_tests;
#[cfg(test)]
mod instance_tests;
mod instances;
mod interior;
pub mod light;
pub mod material;
mod meshes;
mod packet;
mod relief;
pub mod shadow;
mod sheets;
mod specular;
mod surface;
#[cfg(any(test, feature = "testkit"))]
pub mod testkit;
#[cfg(test)]
mod tests;
mod towards;
mod triangle;
pub mod view;
mod world;

pub use embree::{EmbreeError, Ray};
pub use interior::Interior;
pub use meshes::triangle_meshes;
pub use packet::Surfaces16;
pub use sheets::beyond;
pub use surface::{Surface, SurfacePoint};
pub use towards::Faces;
pub use world::World;
