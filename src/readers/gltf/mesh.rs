//! Conversion of primitives to triangle meshes.

use super::document::GltfFile;
use crate::attributes::{NamedAttribute, VERTEX_ALPHA, VERTEX_COLOUR};
use crate::error::SceneError;
use crate::findings::Findings;
use crate::mesh::RawMesh;
use base::math::Rgb;
use glam::{DVec3, Vec2, Vec3, Vec4};
use gltf_json::Index;
use gltf_json::accessor::{Accessor, Type};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

/// Reads a primitive with the texture coordinates of set `uv_set`; `what` names it in messages. Tangents are read if
/// `with_tangents`.
///
/// Returns `None` for points, lines, and primitives without positions.
pub(super) fn read(
    document: &GltfFile,
    primitive: &Primitive,
    uv_set: u32,
    with_tangents: bool,
    what: &str,
    report: &mut Findings,
) -> Result<Option<RawMesh>, SceneError> {
    let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let mode = match &primitive.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => *mode,
        Checked::Valid(_) => {
            report.lacks("points and lines are not supported", "they are left out", what);
            return Ok(None);
        }
        Checked::Invalid => return Err(document.wrong(format!("{what}: its mode is unknown"))),
    };
    let Some(positions) = attribute(Semantic::Positions) else {
        report.lacks("a primitive without positions has no shape", "it is left out", what);
        return Ok(None);
    };
    let positions = document.vectors::<3>(positions, what)?;
    let normals = attribute(Semantic::Normals);
    let normals =
        normals.map(|normals| document.vectors::<3>(normals, what)).transpose()?.unwrap_or_default();
    let uvs = attribute(Semantic::TexCoords(uv_set));
    let uvs = uvs.map(|uvs| document.vectors::<2>(uvs, what)).transpose()?.unwrap_or_default();
    // Tangents without normals do not count (glTF 2.0 specification, section 3.7.2.1).
    let tangents = match attribute(Semantic::Tangents) {
        Some(tangents) if with_tangents && !normals.is_empty() => document.vectors::<4>(tangents, what)?,
        _ => Vec::new(),
    };
    let attributes = match attribute(Semantic::Colors(0)) {
        Some(colours) => attributes(document, colours, what)?,
        None => Vec::new(),
    };
    let colours = attributes.first().map_or(0, |colours| colours.values.all().len());
    let lengths = [
        ("normals", normals.len()),
        ("texture coordinates", uvs.len()),
        ("tangents", tangents.len()),
        ("colours", colours),
    ];
    if let Some((name, length)) = lengths.iter().find(|(_, n)| *n != 0 && *n != positions.len()) {
        return Err(document.wrong(format!("{what} has {} vertices and {length} {name}", positions.len())));
    }
    let corners = corners(document, primitive, positions.len(), what)?;
    let is_odd =
        if mode == Mode::Triangles { corners.len() % 3 != 0 } else { matches!(corners.len(), 1 | 2) };
    if is_odd {
        report.lacks("the last triangle lacks corners", "it is left out; export the mesh again", what);
    }
    Ok(Some(RawMesh {
        positions: positions.iter().map(|p| DVec3::from(p.map(f64::from))).collect(),
        normals: normals.into_iter().map(Vec3::from).collect(),
        uvs: uvs.into_iter().map(Vec2::from).collect(),
        tangents: tangents.into_iter().map(Vec4::from).collect(),
        triangles: triangles(&corners, mode),
        attributes,
        ..RawMesh::default()
    }))
}

/// Returns the numbers of the vertices of a primitive's corners.
pub(super) fn corners(
    document: &GltfFile,
    primitive: &Primitive,
    vertices: usize,
    what: &str,
) -> Result<Vec<u32>, SceneError> {
    match primitive.indices {
        Some(indices) => Ok(document.integers::<1>(indices, what)?.into_flattened()),
        None => Ok((0..vertices as u32).collect()),
    }
}

/// Returns the colours of vertices: their colour, and their opacity if there is one.
fn attributes(
    document: &GltfFile,
    accessor: Index<Accessor>,
    what: &str,
) -> Result<Vec<NamedAttribute>, SceneError> {
    let rgb = |colours: Vec<[f32; 3]>| {
        NamedAttribute::of_vertices(VERTEX_COLOUR, colours.into_iter().map(Rgb::from).collect())
    };
    if !has_alpha(document, accessor)? {
        return Ok(vec![rgb(document.vectors::<3>(accessor, what)?)]);
    }
    let colours = document.vectors::<4>(accessor, what)?;
    let alpha = colours.iter().map(|[.., alpha]| Rgb::splat(*alpha)).collect();
    let colours = rgb(colours.into_iter().map(|[r, g, b, _]| [r, g, b]).collect());
    Ok(vec![colours, NamedAttribute::of_vertices(VERTEX_ALPHA, alpha)])
}

/// Returns true if the elements of an accessor have a fourth component.
fn has_alpha(document: &GltfFile, accessor: Index<Accessor>) -> Result<bool, SceneError> {
    Ok(matches!(document.get(accessor, "accessor")?.type_, Checked::Valid(Type::Vec4)))
}

/// Colours of the vertices of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum VertexColours {
    None,
    Opaque,
    WithAlpha,
}

impl VertexColours {
    /// Returns which colours a primitive has.
    pub fn read(document: &GltfFile, primitive: &Primitive) -> Result<VertexColours, SceneError> {
        let colours = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0)));
        Ok(match colours {
            None => VertexColours::None,
            Some(colours) if has_alpha(document, *colours)? => VertexColours::WithAlpha,
            Some(_) => VertexColours::Opaque,
        })
    }
}

/// Returns the triangles of a list of corners.
pub(super) fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    let windows = corners.windows(3).map(|w| [w[0], w[1], w[2]]);
    match mode {
        Mode::TriangleStrip => {
            windows.enumerate().map(|(i, [a, b, c])| if i % 2 == 0 { [a, b, c] } else { [b, a, c] }).collect()
        }
        Mode::TriangleFan => {
            let Some((&first, rest)) = corners.split_first() else { return Vec::new() };
            rest.windows(2).map(|w| [first, w[0], w[1]]).collect()
        }
        _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}
