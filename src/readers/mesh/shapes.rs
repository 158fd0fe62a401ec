//! Analytic shapes, with Mitsuba's extents and texture coordinates (v counts downwards).
//!
//! Deviations: spheres, disks and cylinders are tessellated. Their vertices are moved outwards until the area, and so
//! the power of an emitter, is exact. Normals are exact.

use super::RawMesh;
use base::math::unit;
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Number of facets around a sphere, disk or cylinder. The edges stay within 0.03 % of the radius.
const AROUND: u32 = 128;

/// Returns the square [-1, 1]² in the plane z = 0, facing +z.
pub fn rectangle() -> RawMesh {
    RawMesh {
        positions: [[-1., -1.], [1., -1.], [-1., 1.], [1., 1.]].map(|[x, y]| DVec3::new(x, y, 0.)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: [[0., 0.], [1., 0.], [0., 1.], [1., 1.]].map(Vec2::from).to_vec(),
        triangles: vec![[1, 2, 0], [1, 3, 2]],
        ..RawMesh::default()
    }
}

/// Returns the cube [-1, 1]³, facing outwards.
pub fn cube() -> RawMesh {
    let mut mesh = RawMesh::default();
    // Normal, and the edges from the first corner to the second and to the fourth.
    let faces: [[[f64; 3]; 3]; 6] = [
        [[0., -1., 0.], [0., 0., 1.], [-1., 0., 0.]],
        [[0., 1., 0.], [-1., 0., 0.], [0., 0., 1.]],
        [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]],
        [[0., 0., 1.], [0., 1., 0.], [-1., 0., 0.]],
        [[-1., 0., 0.], [0., 1., 0.], [0., 0., -1.]],
        [[0., 0., -1.], [0., -1., 0.], [-1., 0., 0.]],
    ];
    for [normal, second, fourth] in faces.map(|f| f.map(DVec3::from)) {
        let first = mesh.positions.len() as u32;
        let corner = normal - second - fourth;
        mesh.positions.extend([
            corner,
            corner + 2.0 * second,
            corner + 2.0 * (second + fourth),
            corner + 2.0 * fourth,
        ]);
        mesh.normals.extend([normal.as_vec3(); 4]);
        mesh.uvs.extend([[0., 1.], [1., 1.], [1., 0.], [0., 0.]].map(Vec2::from));
        mesh.triangles.extend([[first, first + 1, first + 2], [first + 3, first, first + 2]]);
    }
    mesh
}

/// Returns the unit disk in the plane z = 0, facing +z; u is the radius, v the azimuth over 2π.
pub fn disk() -> RawMesh {
    let step = TAU / f64::from(AROUND);
    let radius = (step / step.sin()).sqrt();
    let mut mesh = RawMesh::default();
    for i in 0..=AROUND {
        let (sin, cos) = (f64::from(i % AROUND) * step).sin_cos();
        mesh.positions.push(DVec3::new(cos, sin, 0.0) * radius);
        mesh.uvs.push(Vec2::new(1.0, i as f32 / AROUND as f32));
    }
    for i in 0..AROUND {
        mesh.positions.push(DVec3::ZERO);
        mesh.uvs.push(Vec2::new(0.0, (i as f32 + 0.5) / AROUND as f32));
        mesh.triangles.push([i, i + 1, AROUND + 1 + i]);
    }
    mesh.normals = vec![Vec3::Z; mesh.positions.len()];
    mesh
}

/// Returns a sphere facing outwards; u is the azimuth over 2π, v the angle from +z over π.
pub fn sphere(centre: DVec3, radius: f64) -> RawMesh {
    let rows = AROUND / 2;
    let direction = |i: u32, j: u32| {
        let (sin_phi, cos_phi) = (TAU * f64::from(i % AROUND) / f64::from(AROUND)).sin_cos();
        let theta = PI * f64::from(j) / f64::from(rows);
        let sin_theta = if j == rows { 0.0 } else { theta.sin() };
        DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, theta.cos())
    };
    let mut mesh = RawMesh::default();
    for j in 0..=rows {
        for i in 0..=AROUND {
            mesh.positions.push(direction(i, j));
            // The texture coordinate of a pole lies in the middle of the triangle that ends there.
            let shift = if j == 0 || j == rows { 0.5 } else { 0.0 };
            mesh.uvs.push(Vec2::new((i as f32 + shift) / AROUND as f32, j as f32 / rows as f32));
        }
    }
    let at = |i: u32, j: u32| j * (AROUND + 1) + i;
    for j in 0..rows {
        for i in 0..AROUND {
            if j > 0 {
                mesh.triangles.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            }
            if j + 1 < rows {
                let upper = if j == 0 { at(i, j) } else { at(i + 1, j) };
                mesh.triangles.push([upper, at(i, j + 1), at(i + 1, j + 1)]);
            }
        }
    }
    mesh.normals = mesh.positions.iter().map(|p| p.as_vec3()).collect();
    let push = (4.0 * PI / area(&mesh)).sqrt() * radius;
    mesh.positions.iter_mut().for_each(|p| *p = centre + *p * push);
    mesh
}

/// Returns an open cylinder from `p0` to `p1`, facing outwards; u is the azimuth over 2π, v runs along the axis.
pub fn cylinder(p0: DVec3, p1: DVec3, radius: f64) -> RawMesh {
    let axis = p1 - p0;
    let (tangent, bitangent) = unit(axis).unwrap_or(DVec3::Z).any_orthonormal_pair();
    let step = TAU / f64::from(AROUND);
    let push = radius * step / (2.0 * (0.5 * step).sin());
    let mut mesh = RawMesh::default();
    for i in 0..=AROUND {
        let (sin, cos) = (f64::from(i % AROUND) * step).sin_cos();
        let normal = tangent * cos + bitangent * sin;
        for (end, v) in [(p0, 0.0), (p1, 1.0)] {
            mesh.positions.push(end + normal * push);
            mesh.normals.push(normal.as_vec3());
            mesh.uvs.push(Vec2::new(i as f32 / AROUND as f32, v));
        }
    }
    for i in 0..AROUND {
        let a = 2 * i;
        mesh.triangles.extend([[a, a + 2, a + 1], [a + 1, a + 2, a + 3]]);
    }
    mesh
}

fn area(mesh: &RawMesh) -> f64 {
    let corner = |i: u32| mesh.positions[i as usize];
    let double = |t: &[u32; 3]| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).length();
    mesh.triangles.iter().map(double).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces_its_normals(mesh: &RawMesh) {
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            let normal = (b - a).cross(c - a).normalize();
            for i in t {
                let cos = mesh.normals[*i as usize].as_dvec3().dot(normal);
                assert!(cos > 0.998, "{cos} {t:?}");
            }
        }
    }

    #[test]
    fn areas_are_the_true_shapes_and_windings_agree_with_normals() {
        let shapes = [
            (rectangle(), 4.0),
            (cube(), 24.0),
            (disk(), PI),
            (sphere(DVec3::new(5.0, 6.0, 7.0), 2.0), 16.0 * PI),
            (cylinder(DVec3::ONE, DVec3::new(1.0, 4.0, 1.0), 2.0), 12.0 * PI),
        ];
        for (mesh, expected) in shapes {
            assert!((area(&mesh) / expected - 1.0).abs() < 1e-9, "{} {expected}", area(&mesh));
            faces_its_normals(&mesh);
        }
    }

    #[test]
    fn the_sphere_is_closed_and_within_tolerance() {
        let mesh = sphere(DVec3::ZERO, 1.0);
        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 1e-3, "{volume}");
        assert!(mesh.positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-3));
    }
}
