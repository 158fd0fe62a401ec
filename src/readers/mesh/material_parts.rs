//! Division of a mesh at its materials.

use super::RawMesh;
use crate::attributes::reorder;
use scene::AttributeValues;
use std::collections::HashMap;
use std::ops::Range;

const MISSING: u32 = u32::MAX;

/// Splits the mesh at its material groups, by first use. The name before the first `usemtl` is empty.
pub(crate) fn split_by_material(raw: RawMesh) -> Vec<(String, RawMesh)> {
    let mut names: Vec<String> = Vec::new();
    let mut of_name: HashMap<String, usize> = HashMap::new();
    let mut parts: Vec<Vec<Range<usize>>> = Vec::new();
    let mut groups = raw.groups.clone();
    groups.insert(0, (String::new(), 0));
    for (g, (name, start)) in groups.iter().enumerate() {
        let end = groups.get(g + 1).map_or(raw.triangles.len(), |next| next.1);
        if *start == end {
            continue;
        }
        let part = *of_name.entry(name.clone()).or_insert_with(|| {
            names.push(name.clone());
            parts.push(Vec::new());
            names.len() - 1
        });
        parts[part].push(*start..end);
    }
    names.into_iter().zip(parts).map(|(name, ranges)| (name, with_used_vertices(&raw, &ranges))).collect()
}

/// Returns the mesh of ranges of the triangles of `raw` with the vertices that they use. The reader guarantees that
/// indices are in range.
fn with_used_vertices(raw: &RawMesh, ranges: &[Range<usize>]) -> RawMesh {
    let mut triangles: Vec<[u32; 3]> = chosen(&raw.triangles, ranges);
    let mut used = Vec::new();
    let mut renumbered = vec![MISSING; raw.positions.len()];
    let mut part = RawMesh::default();
    for i in triangles.iter_mut().flatten() {
        let old = *i as usize;
        if renumbered[old] == MISSING {
            renumbered[old] = part.positions.len() as u32;
            used.push(*i);
            part.positions.push(raw.positions[old]);
            part.uvs.extend(raw.uvs.get(old));
            part.normals.extend(raw.normals.get(old));
            part.tangents.extend(raw.tangents.get(old));
        }
        *i = renumbered[old];
    }
    part.triangles = triangles;
    part.attributes = raw.attributes.clone();
    reorder(&mut part.attributes, &used);
    for attribute in &mut part.attributes {
        if let AttributeValues::Triangles(values) = &mut attribute.values {
            *values = chosen(values, ranges);
        }
    }
    part
}

/// Returns the values in some ranges.
fn chosen<T: Clone>(values: &[T], ranges: &[Range<usize>]) -> Vec<T> {
    ranges.iter().flat_map(|range| values[range.clone()].iter().cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::obj;
    use super::*;
    use crate::selection::PartSelection;
    use std::path::Path;

    #[test]
    fn material_groups_split_the_mesh_and_share_nothing() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl x\nf 1 2 4\nusemtl y\nusemtl x\n\
            f 2 3 4\n";
        let mesh = obj::read(text.as_bytes(), Path::new("t.obj"), &PartSelection::default(), &mut Vec::new())
            .unwrap();
        let parts = split_by_material(mesh);
        let names: Vec<_> =
            parts.iter().map(|p| (p.0.as_str(), p.1.triangles.len(), p.1.positions.len())).collect();
        assert_eq!(names, [("", 1, 3), ("x", 2, 4)]);
    }
}
