//! Indexed triangle meshes.

use super::attribute::{Attribute, AttributeId, interpolated};
use super::material::MaterialId;
use super::texture::TextureId;
use base::math::{Placement, Rgb};
use glam::{DVec3, Vec2, Vec3, Vec4};
use std::ops::Range;

/// An indexed triangle mesh with one material.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Name for reports.
    pub name: String,
    /// Vertex positions relative to the scene's centre.
    pub positions: Vec<Vec3>,
    /// Shading normal of each vertex, or empty for geometric normals.
    ///
    /// Normals have unit length, except at vertices within a divided edge. These interpolate the normals of the whole
    /// edge.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of each vertex, v upwards, or empty for barycentric coordinates.
    pub uvs: Vec<Vec2>,
    /// Tangent of each vertex, or empty for the direction of growing u.
    ///
    /// Normal maps and anisotropy have their x axis along x, y, z; the normal × this axis × the sign of w is their y
    /// axis. A tangent of zeros stands for the direction of growing u.
    pub tangents: Vec<Vec4>,
    /// Vertex indices, counter-clockwise seen from the front. All are in range.
    pub triangles: Vec<[u32; 3]>,
    /// Material of every triangle.
    pub material: MaterialId,
    /// Emission, if the surface emits.
    pub emission: Option<Emission>,
    /// Attributes that material or emission look up.
    pub attributes: Vec<Attribute>,
}

/// Diffuse emission of a surface, to be multiplied by the opacity of its material at each point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance from every point of the front, in every direction, W/(sr m²).
    pub radiance: Rgb,
    /// Texture of factors on the radiance.
    pub texture: Option<TextureId>,
    /// True if the back emits as well.
    pub two_sided: bool,
}

impl Mesh {
    /// Returns the corners of triangle `t`.
    #[inline]
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|i| self.positions[i as usize])
    }

    /// Returns the interpolated normal, not of unit length; `None` if the mesh has no normals.
    ///
    /// `b` are the barycentric weights of the last two of a triangle's `vertices`.
    #[inline]
    pub fn normal(&self, vertices: &[u32; 3], b: Vec2) -> Option<Vec3> {
        self.corner_normals(vertices).map(|normals| interpolated(normals, b))
    }

    /// Returns the normals at a triangle's `vertices`; `None` if the mesh has no normals.
    #[inline]
    pub fn corner_normals(&self, vertices: &[u32; 3]) -> Option<[Vec3; 3]> {
        (!self.normals.is_empty()).then(|| vertices.map(|i| self.normals[i as usize]))
    }

    /// Returns the interpolated tangent, not of unit length; `None` if the mesh has no tangents.
    ///
    /// `b` are the barycentric weights of the last two of a triangle's `vertices`.
    #[inline]
    pub fn tangent(&self, vertices: &[u32; 3], b: Vec2) -> Option<Vec4> {
        if self.tangents.is_empty() {
            return None;
        }
        Some(interpolated(vertices.map(|i| self.tangents[i as usize]), b))
    }

    /// Returns the texture coordinates, or `b` if the mesh has none.
    ///
    /// `b` are the barycentric weights of the last two of a triangle's `vertices`.
    #[inline]
    pub fn uv(&self, vertices: &[u32; 3], b: Vec2) -> Vec2 {
        if self.uvs.is_empty() {
            return b;
        }
        interpolated(vertices.map(|i| self.uvs[i as usize]), b)
    }

    /// Returns the value of an attribute at barycentric weights `b` of the last two corners of triangle `t`; white if
    /// the mesh lacks the attribute.
    #[inline]
    pub fn attribute(&self, id: AttributeId, t: usize, b: Vec2) -> Rgb {
        let attribute = self.attributes.iter().find(|attribute| attribute.id == id);
        attribute.map_or(Rgb::ONE, |attribute| attribute.values.at(t, &self.triangles[t], b))
    }

    /// Returns the integral of an attribute over the surface, and the surface's area; zeros if the mesh lacks it.
    pub fn integrate_attribute(&self, id: AttributeId) -> (DVec3, f64) {
        let Some(attribute) = self.attributes.iter().find(|attribute| attribute.id == id) else {
            return (DVec3::ZERO, 0.0);
        };
        let of_triangle = |(sum, total): (DVec3, f64), t: usize| {
            let [a, b, c] = self.corners(t).map(|corner| corner.as_dvec3());
            let area = 0.5 * (b - a).cross(c - a).length();
            let corners = attribute.values.corners(t, &self.triangles[t]);
            let mean = corners.into_iter().map(|value| value.as_dvec3()).sum::<DVec3>() / 3.0;
            (sum + area * mean, total + area)
        };
        (0..self.triangles.len()).fold((DVec3::ZERO, 0.0), of_triangle)
    }
}

/// Meshes in coordinates of their own, and the places at which they are seen. Meshes of groups do not emit.
#[derive(Clone, Debug)]
pub struct Group {
    /// Indices of the meshes in [`crate::Scene::meshes`].
    pub meshes: Range<usize>,
    /// Transforms to the scene's coordinates.
    pub placements: Vec<Placement>,
}
