//! Indexed triangle meshes.

use super::material::MaterialId;
use super::texture::TextureId;
use base::math::Rgb;
use glam::{Vec2, Vec3};

/// An indexed triangle mesh with one material.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Name for reports.
    pub name: String,
    /// Vertex positions relative to the scene's centre.
    pub positions: Vec<Vec3>,
    /// Shading normals by vertex, or empty: then the geometric normal is used. Of unit length, but for vertices within
    /// an edge that was cut, whose shorter ones are interpolated as on the whole edge.
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex, v up, or empty: then the barycentric coordinates are used.
    pub uvs: Vec<Vec2>,
    /// Vertex indices, counter-clockwise seen from the front; all in range.
    pub triangles: Vec<[u32; 3]>,
    /// Material of every triangle.
    pub material: MaterialId,
    /// Emission, if the surface emits.
    pub emission: Option<Emission>,
}

/// Diffuse emission of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance leaving every point in every direction of the front side.
    pub radiance: Rgb,
    /// Texture that scales it over the surface.
    pub texture: Option<TextureId>,
    /// True if the back emits as well.
    pub two_sided: bool,
}

impl Mesh {
    /// The corners of triangle `t`.
    #[inline]
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|i| self.positions[i as usize])
    }

    /// The interpolated normal, not of unit length, at barycentric weights `b` of the last two of a triangle's
    /// `vertices`; `None` where the mesh has no normals.
    #[inline]
    pub fn normal(&self, vertices: &[u32; 3], b: Vec2) -> Option<Vec3> {
        if self.normals.is_empty() {
            return None;
        }
        let [n0, n1, n2] = vertices.map(|i| self.normals[i as usize]);
        Some(n0 * (1.0 - b.x - b.y) + n1 * b.x + n2 * b.y)
    }

    /// Texture coordinates at barycentric weights `b` of the last two of a triangle's `vertices`; the weights
    /// themselves where the mesh has no coordinates.
    #[inline]
    pub fn uv(&self, vertices: &[u32; 3], b: Vec2) -> Vec2 {
        if self.uvs.is_empty() {
            return b;
        }
        let [u0, u1, u2] = vertices.map(|i| self.uvs[i as usize]);
        u0 * (1.0 - b.x - b.y) + u1 * b.x + u2 * b.y
    }
}
