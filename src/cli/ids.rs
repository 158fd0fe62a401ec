//! Table of ids: names of the objects and materials that layers number.

use super::exit::Failure;
use super::files;
use render::session::{Feature, Goal};
use scene::Scene;
use serde_json::{Value, json};
use std::path::Path;

/// Features that number objects or materials.
const NUMBERED: [Feature; 2] = [Feature::Object, Feature::Material];

/// Writes the table, if a goal asks for layers of ids.
///
/// # Errors
/// If it cannot be written.
pub fn write_for(goal: &Goal, path: &Path, scene: &Scene) -> Result<(), Failure> {
    if !NUMBERED.into_iter().any(|feature| goal.features.contains(feature)) {
        return Ok(());
    }
    files::save(path, format!("{:#}\n", table(scene)).as_bytes())
}

/// Returns ids and names of all objects and materials. Ids count from 1.
fn table(scene: &Scene) -> Value {
    let object = |(id, (stored, _)): (usize, (usize, _))| {
        let mesh = scene.meshes.get(stored)?;
        let material = mesh.material.0 as usize;
        let name = scene.materials.get(material).map_or("", |material| material.name.as_str());
        Some(json!({ "id": id, "name": mesh.name, "material_id": material + 1, "material": name }))
    };
    let objects: Vec<Value> = (1..).zip(scene.seen()).filter_map(object).collect();
    let material = |(id, name): (usize, &String)| json!({ "id": id, "name": name });
    let names = scene.materials.iter().map(|material| &material.name);
    json!({ "objects": objects, "materials": (1..).zip(names).map(material).collect::<Vec<Value>>() })
}
