//! Vertex normals from a shell: at each corner the angle-weighted mean of the faces around the point that
//! lie within the crease angle of the corner's own face.
//!
//! Paper: Thürrner & Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998 (the weights).

use super::{Part, Shell};
use glam::{Vec2, Vec3};

impl Shell {
    /// Shell as a nameless part with normals; corners with equal normal and texture coordinate share a vertex.
    pub(super) fn with_normals(&self) -> Part {
        let mut part = Part::default();
        let face_normals: Vec<Vec3> = self.triangles.iter().map(|&t| face_normal(self, t)).collect();
        let around = FacesAroundPoints::new(self);
        let cos_crease = self.crease_degrees.to_radians().cos();
        // The vertices made so far for each point, as a linked list through `next`.
        let mut first = vec![u32::MAX; self.points.len()];
        let mut next: Vec<u32> = Vec::new();
        for (face, (&corners, uvs)) in self.triangles.iter().zip(&self.uvs).enumerate() {
            let vertices = [0, 1, 2].map(|k| {
                let point = corners[k];
                let normal = corner_normal(self, &face_normals, around.faces(point), face, point, cos_crease);
                let mut vertex = first[point as usize];
                while vertex != u32::MAX && !same(&part, vertex, normal, uvs[k]) {
                    vertex = next[vertex as usize];
                }
                if vertex == u32::MAX {
                    vertex = next.len() as u32;
                    next.push(first[point as usize]);
                    first[point as usize] = vertex;
                    part.positions.push(self.points[point as usize]);
                    part.normals.push(normal);
                    part.uvs.push(uvs[k]);
                }
                vertex
            });
            part.triangles.push(vertices);
        }
        part
    }
}

fn same(part: &Part, vertex: u32, normal: Vec3, uv: Vec2) -> bool {
    let vertex = vertex as usize;
    part.normals[vertex].distance_squared(normal) < 1e-10 && part.uvs[vertex].distance_squared(uv) < 1e-10
}

fn face_normal(shell: &Shell, triangle: [u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|i| shell.points[i as usize]);
    (b - a).cross(c - a).normalize_or_zero()
}

fn corner_normal(
    shell: &Shell,
    face_normals: &[Vec3],
    faces: &[u32],
    own_face: usize,
    point: u32,
    cos_crease: f32,
) -> Vec3 {
    let own = face_normals[own_face];
    let mut sum = Vec3::ZERO;
    for &face in faces {
        let normal = face_normals[face as usize];
        // The tolerance makes the coplanar triangles of one flat face always agree.
        if normal.dot(own) >= cos_crease - 1e-5 {
            sum += normal * corner_angle(shell, shell.triangles[face as usize], point);
        }
    }
    sum.normalize_or(own)
}

/// Angle of `triangle` at `point`.
fn corner_angle(shell: &Shell, triangle: [u32; 3], point: u32) -> f32 {
    let k = triangle.iter().position(|&i| i == point).unwrap_or(0);
    let [apex, left, right] = [0, 1, 2].map(|j| shell.points[triangle[(k + j) % 3] as usize]);
    (left - apex).normalize_or_zero().dot((right - apex).normalize_or_zero()).clamp(-1.0, 1.0).acos()
}

/// Faces around every point, in compressed rows.
struct FacesAroundPoints {
    start: Vec<u32>,
    faces: Vec<u32>,
}

impl FacesAroundPoints {
    fn new(shell: &Shell) -> Self {
        let mut start = vec![0_u32; shell.points.len() + 1];
        for point in shell.triangles.iter().flatten() {
            start[*point as usize + 1] += 1;
        }
        for i in 1..start.len() {
            start[i] += start[i - 1];
        }
        let mut cursor = start.clone();
        let mut faces = vec![0_u32; shell.triangles.len() * 3];
        for (face, triangle) in shell.triangles.iter().enumerate() {
            for &point in triangle {
                faces[cursor[point as usize] as usize] = face as u32;
                cursor[point as usize] += 1;
            }
        }
        FacesAroundPoints { start, faces }
    }

    fn faces(&self, point: u32) -> &[u32] {
        &self.faces[self.start[point as usize] as usize..self.start[point as usize + 1] as usize]
    }
}
