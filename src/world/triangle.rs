//! Triangles laid out for hits: all data of a triangle in one cache line.
//!
//! The layout repeats the meshes' positions and takes 64 bytes per triangle. Following the indices of a triangle to its
//! corners would wait for memory two to four times.

use base::math::Placement;
use glam::{Vec2, Vec3};
use scene::texture::uv_scale;
use scene::{Mesh, Scene};

/// The triangles of all stored meshes.
pub(super) struct Triangles {
    /// Index of the first record of each seen mesh.
    first: Vec<usize>,
    records: Vec<Triangle>,
}

/// One triangle.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Triangle {
    /// Corner 0.
    pub corner: Vec3,
    /// Edges from corner 0 to corners 1 and 2.
    pub edges: [Vec3; 2],
    /// Unit geometric normal, on the front by winding.
    pub normal: Vec3,
    /// Indices of the corners in the mesh.
    pub vertices: [u32; 3],
    /// Length in texture coordinates of one unit of length (see [`uv_scale`]); 0 if the mesh has no coordinates.
    pub uv_scale: f32,
}

impl Triangles {
    /// Collects the triangles of a scene.
    pub fn new(scene: &Scene) -> Triangles {
        let mut starts = Vec::with_capacity(scene.meshes.len());
        let mut records = Vec::with_capacity(scene.triangle_count());
        for mesh in &scene.meshes {
            starts.push(records.len());
            records.extend(mesh.triangles.iter().map(|&vertices| {
                let [a, b, c] = vertices.map(|i| mesh.positions[i as usize]);
                let edges = [b - a, c - a];
                let uv_scale = scale_of_uvs(mesh, vertices, edges);
                Triangle { corner: a, edges, normal: unit_normal(edges), vertices, uv_scale }
            }));
        }
        let first = scene.seen().map(|(mesh, _)| starts[mesh]).collect();
        Triangles { first, records }
    }

    /// Returns triangle `primitive` of the seen mesh `mesh`, in the coordinates in which it is stored.
    #[inline]
    pub fn get(&self, mesh: u32, primitive: u32) -> &Triangle {
        &self.records[self.first[mesh as usize] + primitive as usize]
    }
}

impl Triangle {
    /// Returns the triangle of a mesh at a place.
    pub fn placed(&self, placement: &Placement, mesh: &Mesh) -> Triangle {
        let edges = self.edges.map(|edge| placement.vector(edge));
        Triangle {
            corner: placement.point(self.corner),
            edges,
            normal: placement.normal(self.normal),
            vertices: self.vertices,
            uv_scale: scale_of_uvs(mesh, self.vertices, edges),
        }
    }

    /// Returns the point at barycentric weights `b` of corners 1 and 2.
    #[inline]
    pub fn position(&self, b: Vec2) -> Vec3 {
        position(self.corner, self.edges, b)
    }
}

/// Returns the point at barycentric weights `b` of a triangle's corners 1 and 2.
#[inline(always)]
pub(super) fn position(corner: Vec3, edges: [Vec3; 2], b: Vec2) -> Vec3 {
    corner + (edges[0] * b.x + edges[1] * b.y)
}

/// Returns the length in texture coordinates of one unit of length on a triangle; 0 without coordinates.
fn scale_of_uvs(mesh: &Mesh, vertices: [u32; 3], edges: [Vec3; 2]) -> f32 {
    match mesh.uvs.as_slice() {
        [] => 0.0,
        uvs => uv_scale(vertices.map(|i| uvs[i as usize]), edges),
    }
}

/// Returns the unit normal of a triangle from two edges. Very small and very large edges are scaled first.
fn unit_normal([e1, e2]: [Vec3; 2]) -> Vec3 {
    let cross = e1.cross(e2);
    let length_sq = cross.length_squared();
    if length_sq > 1e-30 && length_sq < 1e30 {
        return cross / length_sq.sqrt();
    }
    let scale = e1.abs().max_element().max(e2.abs().max_element());
    (e1 / scale).cross(e2 / scale).try_normalize().unwrap_or(Vec3::Z)
}
