//! Mesh of a PLY file from the values of its elements.

use super::faults::{Fault, Faults, note_of_codes};
use super::ply_attributes::CollectedAttributes;
use super::ply_header::{Element, Header, PlyProperty};
use super::ply_values::PlyValues;
use super::{RawMesh, polygon};
use crate::error::{Location, Warning};
use glam::{DVec3, Vec2, Vec3};
use scene::AttributeValues;
use std::path::Path;

/// Returns the number of elements to allocate: the header's count, limited by what the remaining bytes can hold.
fn expected(element: &Element, values: &dyn PlyValues) -> usize {
    let most = values.rest().len() / element.properties.len().max(1);
    usize::try_from(element.count).map_or(most, |count| count.min(most))
}

/// Reads one property of one element, and passes on each of its values.
fn property_values(
    property: &PlyProperty,
    values: &mut dyn PlyValues,
    mut each: impl FnMut(f64),
) -> Result<(), String> {
    let count = match property.list {
        Some(scalar) => {
            let count = values.next(scalar)?;
            if !(0.0..=f64::from(u32::MAX)).contains(&count) {
                return Err(format!("a list of {count} values"));
            }
            count as u32
        }
        None => 1,
    };
    for _ in 0..count {
        each(values.next(property.scalar)?);
    }
    Ok(())
}

/// Mesh of a file as far as it is read.
pub(super) struct PlyContents<'a> {
    pub mesh: RawMesh,
    pub faults: Faults,
    /// True if a number of a position, normal or texture coordinate is infinite or NaN.
    pub has_odd: bool,
    /// For messages.
    pub path: &'a Path,
}

impl PlyContents<'_> {
    /// Returns the place of the last value that was read.
    pub fn place(&self, values: &dyn PlyValues) -> Location {
        Location { path: self.path.to_owned(), line: values.line() }
    }

    pub fn read(
        &mut self,
        header: &Header,
        values: &mut dyn PlyValues,
        remarks: &mut Vec<Warning>,
    ) -> Result<(), String> {
        let vertices = header.elements.iter().find(|element| element.name == "vertex");
        let vertex_count = vertices.map_or(0, |element| element.count);
        for element in &header.elements {
            match element.name.as_str() {
                "vertex" => self.vertices(element, values, remarks)?,
                "face" => self.faces(element, vertex_count, values, remarks)?,
                // Elements without properties have no bytes, whatever their number.
                _ if element.properties.is_empty() => {}
                _ => {
                    for _ in 0..element.count {
                        for property in &element.properties {
                            property_values(property, values, |_| ())?;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn vertices(
        &mut self,
        element: &Element,
        values: &mut dyn PlyValues,
        remarks: &mut Vec<Warning>,
    ) -> Result<(), String> {
        let find = |names: &[&str]| {
            let is_it = |p: &PlyProperty| names.iter().any(|name| p.name.eq_ignore_ascii_case(name));
            element.properties.iter().position(is_it)
        };
        let triple = |names: [&str; 3]| names.map(|n| find(&[n])).into_iter().collect::<Option<Vec<_>>>();
        let position = triple(["x", "y", "z"]).ok_or("the vertices have no x, y, z")?;
        let normal = triple(["nx", "ny", "nz"]);
        let uv = [["u", "s", "texture_u"], ["v", "t", "texture_v"]].map(|names| find(&names));
        let mesh = &mut self.mesh;
        mesh.positions.reserve_exact(expected(element, values));
        let mut row = vec![0.0; element.properties.len()];
        let mut attributes = CollectedAttributes::new(element.attributes("vertex_"));
        for _ in 0..element.count {
            for (value, property) in row.iter_mut().zip(&element.properties) {
                property_values(property, values, |v| *value = v)?;
            }
            let at = DVec3::new(row[position[0]], row[position[1]], row[position[2]]);
            self.has_odd |= !at.is_finite();
            mesh.positions.push(at);
            if let Some(n) = &normal {
                let normal = Vec3::new(row[n[0]] as f32, row[n[1]] as f32, row[n[2]] as f32);
                self.has_odd |= !normal.is_finite();
                mesh.normals.push(normal);
            }
            if let [Some(u), Some(v)] = uv {
                let uv = Vec2::new(row[u] as f32, row[v] as f32);
                self.has_odd |= !uv.is_finite();
                mesh.uvs.push(uv);
            }
            if !attributes.push(&row, 1) {
                let place = Location { path: self.path.to_owned(), line: values.line() };
                self.faults.add(Fault::NoColour, || place);
            }
        }
        let has_codes;
        (self.mesh.attributes, has_codes) = attributes.finish(AttributeValues::Vertices);
        remarks.extend(has_codes.then(|| note_of_codes(Location::file(self.path))));
        Ok(())
    }

    fn faces(
        &mut self,
        element: &Element,
        vertex_count: u64,
        values: &mut dyn PlyValues,
        remarks: &mut Vec<Warning>,
    ) -> Result<(), String> {
        let is_corners = |p: &PlyProperty| {
            let is_named = |name: &&str| p.name.eq_ignore_ascii_case(name);
            p.list.is_some() && ["vertex_index", "vertex_indices"].iter().any(is_named)
        };
        if element.count > 0 && !element.properties.iter().any(is_corners) {
            return Err("the faces have no list of vertex indices".into());
        }
        self.mesh.triangles.reserve(expected(element, values));
        let mut corners = Vec::new();
        let mut row = vec![0.0; element.properties.len()];
        let mut attributes = CollectedAttributes::new(element.attributes("face_"));
        for _ in 0..element.count {
            let before = self.mesh.triangles.len();
            for (value, property) in row.iter_mut().zip(&element.properties) {
                if !is_corners(property) {
                    property_values(property, values, |v| *value = v)?;
                    continue;
                }
                corners.clear();
                // Negative and fractional indices are mapped out of range.
                let index = |v: f64| if v >= 0.0 && v.fract() == 0.0 { v as u32 } else { u32::MAX };
                property_values(property, values, |v| corners.push(index(v)))?;
                self.face(&corners, vertex_count, values);
            }
            if !attributes.push(&row, self.mesh.triangles.len() - before) {
                let place = self.place(values);
                self.faults.add(Fault::NoColour, || place);
            }
        }
        let (of_faces, has_codes) = attributes.finish(AttributeValues::Triangles);
        self.mesh.attributes.extend(of_faces);
        remarks.extend(has_codes.then(|| note_of_codes(Location::file(self.path))));
        Ok(())
    }

    /// Adds the triangles of a face, or counts why there are none.
    fn face(&mut self, corners: &[u32], vertex_count: u64, values: &dyn PlyValues) {
        let mesh = &mut self.mesh;
        let fault = if corners.len() < 3 {
            Some(Fault::FewCorners)
        } else if corners.iter().any(|&i| u64::from(i) >= vertex_count) {
            Some(Fault::NoSuchVertex)
        } else if self.has_odd && corners.iter().any(|&i| !is_finite(mesh.positions.get(i as usize))) {
            Some(Fault::NoPosition)
        } else {
            // Vertices may follow the faces. The position of a corner does not matter then.
            let positions = &mesh.positions;
            let position = |&corner: &u32| positions.get(corner as usize).copied().unwrap_or_default();
            let is_cut = polygon::cut(corners, position, &mut mesh.triangles);
            (!is_cut).then_some(Fault::Crossing)
        };
        let place = || Location { path: self.path.to_owned(), line: values.line() };
        if let Some(fault) = fault {
            self.faults.add(fault, place);
        } else if self.has_odd {
            for &i in corners {
                if !mesh.normals.get(i as usize).is_none_or(|normal| normal.is_finite()) {
                    self.faults.add(Fault::NoNormal, place);
                }
                if !mesh.uvs.get(i as usize).is_none_or(|uv| uv.is_finite()) {
                    self.faults.add(Fault::NoUv, place);
                }
            }
        }
    }
}

/// True if a position is finite, or not read yet.
fn is_finite(position: Option<&DVec3>) -> bool {
    position.is_none_or(|position| position.is_finite())
}
