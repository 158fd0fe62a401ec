//! The larger scenes of the project, generated: each generator yields named parts, and the scene's TOML
//! file gives every part its material, so that what a scene looks like stays editable.

mod apartment;
pub mod builder;
mod furniture;
mod hall;
mod kitchen;
mod knot;
mod nave;

use glam::{Vec2, Vec3};

/// A named piece of generated geometry.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Name by which the scene file refers to it.
    pub name: String,
    /// Vertex positions, in metres.
    pub positions: Vec<Vec3>,
    /// Unit normals by vertex, or empty for flat shading.
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex, or empty.
    pub uvs: Vec<Vec2>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// The parts of the scene called `name`, or `None` where there is no such generator.
pub fn generate(name: &str) -> Option<Vec<Part>> {
    match name {
        "apartment" => Some(apartment::parts()),
        "kitchen" => Some(kitchen::parts()),
        "knot" => Some(knot::parts()),
        "hall" => Some(hall::parts()),
        "nave" => Some(nave::parts()),
        _ => None,
    }
}
