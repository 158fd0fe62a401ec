//! Named triangle meshes: the unit that a scene file gives a material.

use super::Shell;
use glam::{Affine3A, Mat3, Vec2, Vec3};

/// Named piece of generated geometry.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Name by which the scene file refers to it.
    pub name: String,
    /// Vertex positions, in metres.
    pub positions: Vec<Vec3>,
    /// Unit normals by vertex.
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex.
    pub uvs: Vec<Vec2>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Part {
    /// Empty part called `name`.
    pub(super) fn new(name: &str) -> Self {
        Part { name: name.to_owned(), ..Part::default() }
    }

    /// Appends `shell` placed by `transform`; a mirroring transform keeps the outside outside.
    pub(super) fn add(&mut self, shell: &Shell, transform: Affine3A) {
        self.append(&shell.with_normals(), transform);
    }

    /// Appends a copy of `piece` placed by `transform`; a mirroring transform keeps the outside outside.
    pub(super) fn append(&mut self, piece: &Part, transform: Affine3A) {
        let base = self.positions.len() as u32;
        let linear = Mat3::from(transform.matrix3);
        let to_normal = linear.inverse().transpose();
        let mirrored = linear.determinant() < 0.0;
        self.positions.extend(piece.positions.iter().map(|&p| transform.transform_point3(p)));
        self.normals.extend(piece.normals.iter().map(|&n| (to_normal * n).normalize()));
        self.uvs.extend_from_slice(&piece.uvs);
        self.triangles.extend(piece.triangles.iter().map(|&[a, b, c]| {
            if mirrored { [base + a, base + c, base + b] } else { [base + a, base + b, base + c] }
        }));
    }

    /// Appends `piece` as it stands.
    pub(super) fn merge(&mut self, piece: Part) {
        let base = self.positions.len() as u32;
        self.positions.extend(piece.positions);
        self.normals.extend(piece.normals);
        self.uvs.extend(piece.uvs);
        self.triangles.extend(piece.triangles.iter().map(|t| t.map(|i| base + i)));
    }
}
