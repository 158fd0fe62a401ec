//! Choice of the attributes of meshes that materials and emission look up. The others are dropped.

use crate::attributes::{NamedAttribute, find};
use crate::draft::{Draft, DraftMesh};
use crate::error::{Log, SceneError};
use scene::{Material, Scene};
use std::collections::BTreeSet;

/// Keeps the attributes that the textures of each mesh look up, under the names that the textures use.
///
/// Warns of meshes without an attribute that their material or emission looks up. White stands in.
pub fn choose(draft: &mut Draft, log: &mut Log) -> Result<(), SceneError> {
    let names = &draft.attribute_names;
    if names.is_empty() {
        draft.meshes.iter_mut().for_each(|mesh| mesh.attributes.clear());
        return Ok(());
    }
    let of_materials: Vec<BTreeSet<usize>> =
        draft.scene.materials.iter().map(|material| of_material(&draft.scene, material)).collect();
    let place = draft.main_file();
    for mesh in &mut draft.meshes {
        let mut wanted = of_materials.get(mesh.material.0 as usize).cloned().unwrap_or_default();
        wanted.extend(of_emission(&draft.scene, mesh));
        let given = std::mem::take(&mut mesh.attributes);
        for name in wanted.iter().filter_map(|number| names.get(*number)) {
            match find(&given, name) {
                Some(found) => {
                    let values = found.values.clone();
                    mesh.attributes.push(NamedAttribute { name: name.clone(), values });
                }
                None => {
                    let what =
                        format!("the mesh \"{}\" has no attribute \"{name}\"{}", mesh.name, others(&given));
                    log.warn(&place, what, "white is used instead")?;
                }
            }
        }
    }
    Ok(())
}

/// Returns the numbers of the attributes that a material looks up.
fn of_material(scene: &Scene, material: &Material) -> BTreeSet<usize> {
    let textures = material.textures();
    textures.into_iter().filter_map(|id| Some(scene.textures.attribute(id)?.attribute.0 as usize)).collect()
}

/// Returns the number of the attribute that a mesh's emission looks up.
fn of_emission(scene: &Scene, mesh: &DraftMesh) -> Option<usize> {
    Some(scene.textures.attribute(mesh.emission?.texture?)?.attribute.0 as usize)
}

/// Returns the rest of a sentence: the attributes that a mesh has.
fn others(given: &[NamedAttribute]) -> String {
    let names: Vec<&str> = given.iter().map(|attribute| attribute.name.as_str()).collect();
    if names.is_empty() { String::new() } else { format!(", but {}", names.join(", ")) }
}
