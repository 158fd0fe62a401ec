//! Triangles without shared vertices, which become a mesh with shared ones.

use super::RawMesh;
use glam::DVec3;
use std::collections::HashMap;

/// Builder of a mesh of triangles, whose corners at the same position become one vertex.
#[derive(Default)]
pub(super) struct SoupBuilder {
    pub mesh: RawMesh,
    /// Vertex at each position, by the bits of its coordinates.
    vertices: HashMap<[u32; 3], u32>,
}

impl SoupBuilder {
    /// Adds a triangle.
    pub fn triangle(&mut self, corners: [[f32; 3]; 3]) {
        let triangle = corners.map(|corner| {
            // Both zeros are one position.
            let key = corner.map(|coordinate| (coordinate + 0.0).to_bits());
            *self.vertices.entry(key).or_insert_with(|| {
                self.mesh.positions.push(DVec3::from(corner.map(f64::from)));
                self.mesh.positions.len() as u32 - 1
            })
        });
        self.mesh.triangles.push(triangle);
    }
}
