//! Parts of the meshes of a plan, with the material of each, and their places.

use crate::attributes::{COLOUR, find};
use crate::draft::DraftMesh;
use crate::error::Warning;
use crate::findings::listed;
use crate::mesh::material_parts::split_by_material;
use crate::mesh::{self, Normals, Placement, RawMesh};
use crate::plan::{Appearance, MaterialPlan, MeshPlan, MeshSource, NamedAppearances};
use glam::{DMat4, Vec2};
use std::collections::BTreeMap;

/// Maximum number of names that a message lists.
const MAX_LISTED: usize = 8;

/// Part of a mesh, in the coordinates of its file, with one material.
#[derive(Clone, Debug)]
pub(crate) struct MeshPart {
    name: String,
    appearance: Appearance,
    lacks_uvs: bool,
    raw: RawMesh,
}

impl MeshPart {
    /// Returns the part as the mesh of a scene. `to_world` replaces the transform of its plan, and `name` its own name.
    pub fn placed(self, plan: &MeshPlan, to_world: DMat4, name: Option<&str>) -> DraftMesh {
        let placement = Placement { to_world, ..plan.placement };
        DraftMesh {
            name: name.map_or(self.name, str::to_owned),
            material: self.appearance.material,
            emission: plan.emission.or(self.appearance.emission),
            lacks_uvs: self.lacks_uvs,
            ..mesh::place(self.raw, &placement)
        }
    }
}

/// Returns the parts of a plan, one for each material. `remarks` gets warnings about materials that are not there.
pub(crate) fn parts(plan: &MeshPlan, mut raw: RawMesh, remarks: &mut Vec<Warning>) -> Vec<MeshPart> {
    if plan.placement.normals != Normals::AsGiven {
        // Smoothing groups mean nothing where all faces are smooth or all are flat, as in Mitsuba.
        remarks.retain(|remark| !remark.what.contains("statement \"s\""));
    }
    let parts = match &plan.material {
        MaterialPlan::One(material) => {
            vec![(plan.name.clone(), Appearance { material: *material, emission: None }, raw)]
        }
        MaterialPlan::ByName(NamedAppearances { appearances, names }, other) => {
            for (text, _) in &mut raw.groups {
                if let Some(name) = names.get(text) {
                    text.clone_from(name);
                }
            }
            let has_colours = find(&raw.attributes, COLOUR).is_some();
            let parts = split_by_material(raw);
            // Faces without a material show the colours of their vertices.
            let is_bare = |name: &&str| !(has_colours && name.is_empty());
            let names = parts.iter().map(|part| part.0.as_str()).filter(is_bare);
            let fallback = match has_colours {
                true => "the colours of the vertices are used instead",
                false => "a grey of 0.5 is used instead",
            };
            remarks.extend(undefined_materials(plan, appearances, names, fallback));
            let unknown = Appearance { material: *other, emission: None };
            let appearance = |name: &str| appearances.get(name).copied().unwrap_or(unknown);
            let named =
                |(name, part): (String, RawMesh)| (format!("{}:{name}", plan.name), appearance(&name), part);
            parts.into_iter().map(named).collect()
        }
    };
    let finish = |(name, appearance, mut raw): (String, Appearance, RawMesh)| {
        let is_partial = matches!(plan.geometry, MeshSource::Obj(..)) && fill_uvs(&mut raw.uvs);
        let lacks_uvs = is_partial || raw.uvs.is_empty();
        MeshPart { name, appearance, lacks_uvs, raw }
    };
    parts.into_iter().map(finish).collect()
}

/// Sets texture coordinates that are NaN to 0; returns whether there are any.
fn fill_uvs(uvs: &mut [Vec2]) -> bool {
    let mut fills = false;
    for uv in uvs.iter_mut().filter(|uv| uv.is_nan()) {
        (*uv, fills) = (Vec2::ZERO, true);
    }
    fills
}

/// Returns the warning about parts whose material is not defined; `fallback` stands in.
fn undefined_materials<'a>(
    plan: &MeshPlan,
    defined: &BTreeMap<String, Appearance>,
    parts: impl Iterator<Item = &'a str>,
    fallback: &str,
) -> Option<Warning> {
    let missing: Vec<&str> = parts.filter(|name| !defined.contains_key(*name)).collect();
    let named = missing.iter().filter(|name| !name.is_empty());
    let named: Vec<String> = named.map(|name| format!("\"{name}\"")).collect();
    let mesh = &plan.name;
    let what = match (missing.is_empty(), named.is_empty()) {
        (true, _) => return None,
        (false, true) if defined.is_empty() => "neither the mesh nor its file has a material".to_owned(),
        (false, true) => format!("faces of \"{mesh}\" have no material"),
        (false, false) => {
            format!("materials that \"{mesh}\" uses are not in its libraries: {}", listed(&named, MAX_LISTED))
        }
    };
    Some(Warning::new(plan.place.clone(), what, fallback))
}
