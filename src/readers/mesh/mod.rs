//! Geometry from files and analytic shapes.
//!
//! Each reader returns a [`RawMesh`] in object coordinates. [`place`] transforms it to world coordinates, as Mitsuba
//! does.
//!
//! Front sides: Mitsuba uses the shading normal (for emission and one-sided materials), this renderer the winding. So
//! the winding is reversed if the vertex normals oppose it. A transform that mirrors reverses the winding, too: the
//! outside stays outside, with or without normals. This is the rule of glTF 2.0 and of Mitsuba 3 later than 3.9.1.
//! Mitsuba up to 3.9.1 turns mirrored meshes without normals inside out.

mod chains;
mod edge_order;
pub(crate) mod encodings;
pub(crate) mod faults;
mod large_polygon;
pub mod material_parts;
mod numerals;
pub mod obj;
pub mod obj_references;
mod obj_statements;
#[cfg(test)]
mod obj_tests;
pub mod ply;
mod ply_attributes;
mod ply_contents;
pub(crate) mod ply_header;
mod ply_statements;
mod ply_values;
mod polygon;
pub mod serialized;
pub mod shapes;
mod smooth;
pub mod stl;
mod stl_colours;
mod stl_soup;
mod stl_text;
pub(crate) mod wavefront;

pub(crate) use smooth::vertex_normals as smooth_normals;

use crate::attributes::{NamedAttribute, reorder};
use crate::draft::DraftMesh;
use base::math::unit;
use glam::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};

/// A mesh in object coordinates, as its file describes it.
#[derive(Clone, Debug, Default)]
pub(crate) struct RawMesh {
    pub positions: Vec<DVec3>,
    /// Normal of each vertex, or empty.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of each vertex, or empty; v as in the file.
    pub uvs: Vec<Vec2>,
    /// Tangent of each vertex (see [`scene::Mesh::tangents`]), or empty.
    pub tangents: Vec<Vec4>,
    pub triangles: Vec<[u32; 3]>,
    /// Material groups: name and first triangle, ascending.
    pub groups: Vec<(String, usize)>,
    pub attributes: Vec<NamedAttribute>,
}

/// Shading normals of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    /// Geometric normals of the faces.
    Flat,
    /// Normals of the file; geometric normals if the file has none.
    AsGiven,
    /// Normals of the file; smooth normals are computed if the file has none.
    Smooth,
}

/// Options for placing a raw mesh in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub to_world: DMat4,
    pub normals: Normals,
    /// True if front and back are swapped.
    pub flip_normals: bool,
    /// True if v counts from the top. v then becomes 1 - v.
    pub v_down: bool,
    /// True if triangles without texture coordinates use barycentric coordinates, as in Mitsuba.
    pub needs_uv: bool,
}

/// Returns the mesh in world coordinates. The caller sets name, material and emission.
pub fn place(raw: RawMesh, how: &Placement) -> DraftMesh {
    let mut mesh = DraftMesh {
        positions: raw.positions.iter().map(|&p| how.to_world.transform_point3(p)).collect(),
        triangles: raw.triangles,
        attributes: raw.attributes,
        ..DraftMesh::default()
    };
    mesh.uvs = raw.uvs;
    if how.v_down {
        mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
    }
    let linear = DMat3::from_mat4(how.to_world);
    let is_mirrored = linear.determinant() < 0.0;
    if how.normals != Normals::Flat {
        if raw.normals.is_empty() && how.normals == Normals::Smooth {
            mesh.normals = smooth::vertex_normals(&mesh.positions, &mesh.triangles);
            if is_mirrored {
                mesh.normals.iter_mut().for_each(|n| *n = -*n);
            }
        } else {
            let to_normal = normal_matrix(&linear);
            let to_world = |normal: &Vec3| direction(to_normal * normal.as_dvec3());
            mesh.normals = raw.normals.iter().map(to_world).collect();
        }
    }
    let handedness = if is_mirrored != how.flip_normals { -1.0 } else { 1.0 };
    let to_world = |t: &Vec4| direction(linear * t.truncate().as_dvec3()).extend(t.w * handedness);
    mesh.tangents = raw.tangents.iter().map(to_world).collect();
    if mesh.uvs.is_empty() && how.needs_uv {
        give_barycentric_uvs(&mut mesh);
    }
    if is_mirrored != how.flip_normals {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    if how.flip_normals {
        mesh.normals.iter_mut().for_each(|n| *n = -*n);
    }
    follow_normals(&mut mesh);
    mesh
}

/// Returns a unit direction; zero stays zero, and numbers that are not finite become NaN.
fn direction(along: DVec3) -> Vec3 {
    let other = || if along.is_finite() { DVec3::ZERO } else { DVec3::NAN };
    unit(along).unwrap_or_else(other).as_vec3()
}

/// Returns a multiple of the inverse transpose of `m`, which transforms normals; the outside stays outside.
///
/// Cofactors replace the inverse: the direction agrees up to the determinant's sign, and nothing is divided by 0.
pub(crate) fn normal_matrix(m: &DMat3) -> DMat3 {
    let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis)) * sign
}

/// Duplicates shared vertices, and gives each triangle (0,0), (1,0), (0,1) in Mitsuba's convention of v downwards.
fn give_barycentric_uvs(mesh: &mut DraftMesh) {
    let corners = || mesh.triangles.iter().flatten().map(|&i| i as usize);
    if corners().any(|i| i >= mesh.positions.len()) || mesh.triangles.len() > (u32::MAX / 3) as usize {
        return; // left for the sanitiser
    }
    let positions = corners().map(|i| mesh.positions[i]).collect();
    if !mesh.normals.is_empty() {
        mesh.normals = corners().map(|i| mesh.normals[i]).collect();
    }
    if !mesh.tangents.is_empty() {
        mesh.tangents = corners().map(|i| mesh.tangents[i]).collect();
    }
    mesh.positions = positions;
    reorder(&mut mesh.attributes, mesh.triangles.as_flattened());
    let uvs = [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 0.0)];
    mesh.uvs = (0..mesh.triangles.len()).flat_map(|_| uvs).collect();
    mesh.triangles = (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
}

/// Reverses triangles whose summed vertex normals point away from the geometric normal.
fn follow_normals(mesh: &mut DraftMesh) {
    if mesh.normals.is_empty() {
        return;
    }
    let (positions, normals) = (&mesh.positions, &mesh.normals);
    for t in &mut mesh.triangles {
        let [a, b, c] = t.map(|i| positions.get(i as usize).copied().unwrap_or(DVec3::NAN));
        let normal = |i: u32| normals.get(i as usize).map_or(DVec3::ZERO, |n| n.as_dvec3());
        let mut sum: DVec3 = t.map(normal).iter().sum();
        if !sum.is_finite() {
            sum = t.map(normal).iter().filter(|normal| normal.is_finite()).sum();
        }
        if (b - a).cross(c - a).dot(sum) < 0.0 {
            t.swap(1, 2);
            mesh.turned += 1;
        }
    }
}
