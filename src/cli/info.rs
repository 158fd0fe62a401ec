//! `lightsplat info`: prints the content and the requirements of a scene.

use super::args::InfoArgs;
use super::exit::Failure;
use super::{opened, talk};
use readers::{Loaded, SanitizeReport};
use scene::{Requirements, Scene};
use serde_json::{Value, json};
use std::fmt::Write;

/// Runs the command.
pub fn run(args: InfoArgs) -> Result<(), Failure> {
    let loaded = opened::read(&args.scene, &args.reading.options())?;
    let facts = facts(&loaded);
    let requires = Requirements::of(&loaded.scene);
    if args.json {
        let mut facts = facts;
        facts["requires"] = json!(requires);
        talk::print(&format!("{facts}\n"))
    } else {
        talk::print(&format!("{}\nrequires\n{requires}\n", to_text(&facts, &loaded.repairs)))
    }
}

fn facts(loaded: &Loaded) -> Value {
    let Scene { meshes, materials, textures, lights, .. } = &loaded.scene;
    json!({
        "name": loaded.scene.name,
        "hash": format!("{:016x}", loaded.hash),
        "resolution": loaded.cameras.resolution,
        "frames": loaded.cameras.path.len(),
        "max_depth": loaded.scene.max_depth,
        "meshes": meshes.len(),
        "triangles": meshes.iter().map(|m| m.triangles.len()).sum::<usize>(),
        "vertices": meshes.iter().map(|m| m.positions.len()).sum::<usize>(),
        "materials": materials.len(),
        "textures": textures.len(),
        "texels": textures.iter().map(|t| t.texels.len()).sum::<usize>(),
        "emitting_triangles":
            meshes.iter().filter(|m| m.emission.is_some()).map(|m| m.triangles.len()).sum::<usize>(),
        "point_spot_directional_lights": lights.len(),
        "distant_discs": loaded.scene.discs.len(),
        "environment": loaded.scene.environment.is_some(),
        "warnings": loaded.warnings.len(),
        "repairs": loaded.repairs,
    })
}

fn to_text(facts: &Value, repairs: &SanitizeReport) -> String {
    let mut text = String::new();
    for (key, value) in facts.as_object().into_iter().flatten() {
        let shown = match key.as_str() {
            "repairs" => repairs.to_string(),
            _ => value.as_str().map_or_else(|| value.to_string(), str::to_owned),
        };
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{:<32}{shown}", key.replace('_', " "));
    }
    text
}
