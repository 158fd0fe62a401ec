//! Vertex normals for meshes whose files have none.
//!
//! Paper: Thürmer and Wüthrich, *Computing Vertex Normals from Polygonal Facets*, JGT 1998. Face normals are weighted
//! by the angle of the face at the vertex.

use base::math::unit;
use glam::{DVec3, Vec3};

/// Returns a unit normal per vertex; zero if no face of positive area touches the vertex.
pub(crate) fn vertex_normals(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for t in triangles {
        let index = t.map(|i| i as usize);
        let [Some(&a), Some(&b), Some(&c)] = index.map(|i| positions.get(i)) else { continue };
        let Some(face_normal) = unit((b - a).cross(c - a)) else { continue };
        let corners = [a, b, c];
        for k in 0..3 {
            let to_next = unit(corners[(k + 1) % 3] - corners[k]).unwrap_or_default();
            let to_last = unit(corners[(k + 2) % 3] - corners[k]).unwrap_or_default();
            let angle = to_next.dot(to_last).clamp(-1.0, 1.0).acos();
            sums[index[k]] += face_normal * angle;
        }
    }
    sums.iter().map(|n| unit(*n).unwrap_or_default().as_vec3()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_corner_points_along_the_diagonal_however_its_faces_are_split() {
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let positions = [p(0., 0., 0.), p(1., 0., 0.), p(0., 1., 0.), p(0., 0., 1.), p(1., 1., 0.)];
        // The face z = 0 is split in two at the corner, the others are single triangles.
        let triangles = [[0, 4, 1], [0, 2, 4], [0, 1, 3], [0, 3, 2]];
        let normals = vertex_normals(&positions, &triangles);
        assert!((normals[0] - Vec3::splat(-1.0).normalize()).length() < 1e-6, "{}", normals[0]);
    }

    #[test]
    fn bad_triangles_are_passed_over() {
        let positions = [DVec3::ZERO, DVec3::NAN, DVec3::X];
        assert_eq!(vertex_normals(&positions, &[[0, 0, 2], [0, 1, 2], [0, 9, 2]]), [Vec3::ZERO; 3]);
    }
}
