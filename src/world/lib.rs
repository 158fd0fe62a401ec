//! A scene prepared for rendering: acceleration structure, material tables and emitters beside the data.
//!
//! [`material`] tells how surfaces scatter, [`light`] what emits, [`shadow`] whether segments are free; [`view`] is a
//! camera and the part of its film to render.
//!
//! Units: positions relative to the scene's centre. A `World` is immutable and shared by all threads.

#![forbid(unsafe_code)]

mod hidden;
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
pub use meshes::triangle_meshes;
pub use packet::Surfaces16;
pub use sheets::beyond;
pub use surface::{Surface, SurfacePoint};
pub use towards::Faces;
pub use world::World;
