//! Meshes of a plan in world coordinates, with the material of each part.

use crate::attributes::{COLOUR, find};
use crate::draft::DraftMesh;
use crate::error::Warning;
use crate::mesh::material_parts::split_by_material;
use crate::mesh::{self, Normals, RawMesh};
use crate::plan::{Appearance, MaterialPlan, MeshPlan, MeshSource};
use glam::Vec2;
use std::collections::BTreeMap;

/// Maximum number of names that a message lists.
const MAX_LISTED: usize = 8;

/// Returns the meshes of a plan, one for each material. `remarks` gets warnings about materials that are not there.
pub(crate) fn finish_mesh(plan: &MeshPlan, raw: RawMesh, remarks: &mut Vec<Warning>) -> Vec<DraftMesh> {
    if plan.placement.normals != Normals::AsGiven {
        // Smoothing groups mean nothing where all faces are smooth or all are flat, as in Mitsuba.
        remarks.retain(|remark| !remark.what.contains("statement \"s\""));
    }
    let parts = match &plan.material {
        MaterialPlan::One(material) => {
            vec![(plan.name.clone(), Appearance { material: *material, emission: None }, raw)]
        }
        MaterialPlan::ByName(appearances, other) => {
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
        let placed = mesh::place(raw, &plan.placement);
        DraftMesh {
            name,
            material: appearance.material,
            emission: plan.emission.or(appearance.emission),
            lacks_uvs,
            ..placed
        }
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
    let named: Vec<&&str> = missing.iter().filter(|name| !name.is_empty()).collect();
    let mut listed = named.iter().take(MAX_LISTED).map(|name| format!("\"{name}\"")).collect::<Vec<_>>();
    if named.len() > MAX_LISTED {
        listed.push(format!("{} more", named.len() - MAX_LISTED));
    }
    let mesh = &plan.name;
    let what = match (missing.is_empty(), listed.is_empty()) {
        (true, _) => return None,
        (false, true) if defined.is_empty() => "neither the mesh nor its file has a material".to_owned(),
        (false, true) => format!("faces of \"{mesh}\" have no material"),
        (false, false) => {
            format!("materials that \"{mesh}\" uses are not in its libraries: {}", listed.join(", "))
        }
    };
    Some(Warning::new(plan.place.clone(), what, fallback))
}
