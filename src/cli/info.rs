//! `lightsplat info`: prints the content and the requirements of a scene.

use super::args::InfoArgs;
use super::exit::Failure;
use super::info_lists::{bounds, cameras, lights, unsupported};
use super::{opened, talk};
use base::shown::shown_line;
use readers::{Loaded, SanitizeReport};
use scene::{Requirements, Scene};
use serde_json::{Value, json};
use std::fmt::Write;

/// Facts whose lists text shows in another form, or not at all.
const LISTS: [&str; 6] = ["box", "cameras", "frame_range", "lights", "material_names", "not_supported"];

/// Runs the command.
pub fn run(args: InfoArgs) -> Result<(), Failure> {
    let loaded = opened::read(&args.scene, &args.reading.options())?;
    let facts = facts(&loaded);
    let requires = Requirements::new(&loaded.scene);
    if args.json {
        let mut facts = facts;
        facts["requires"] = json!(requires);
        talk::print(&format!("{facts}\n"))
    } else {
        talk::print(&format!("{}\nrequires\n{requires}\n", to_text(&facts, &loaded.repairs)))
    }
}

fn facts(loaded: &Loaded) -> Value {
    let Scene { meshes, materials, textures, lights: deltas, .. } = &loaded.scene;
    let frames = loaded.animation_frames;
    json!({
        "name": loaded.scene.name,
        "hash": format!("{:016x}", loaded.hash),
        "resolution": loaded.cameras.resolution,
        "cameras": loaded.camera_names,
        "frames": frames,
        "frame_range": (frames > 0).then_some([1, frames]),
        "max_depth": loaded.scene.max_depth,
        "box": bounds(&loaded.scene),
        "meshes": meshes.len(),
        "triangles": meshes.iter().map(|m| m.triangles.len()).sum::<usize>(),
        "seen_triangles": loaded.scene.seen_triangle_count(),
        "instances": loaded.scene.groups.iter().map(|group| group.placements.len()).sum::<usize>(),
        "vertices": meshes.iter().map(|m| m.positions.len()).sum::<usize>(),
        "materials": materials.len(),
        "material_names": materials.iter().map(|material| &material.name).collect::<Vec<_>>(),
        "textures": textures.len(),
        "texels": textures.iter().map(|t| t.texels.len()).sum::<usize>(),
        "lights": lights(&loaded.scene),
        "emitting_triangles":
            meshes.iter().filter(|m| m.emission.is_some()).map(|m| m.triangles.len()).sum::<usize>(),
        "point_spot_directional_lights": deltas.len(),
        "distant_discs": loaded.scene.discs.len(),
        "environment": loaded.scene.environment.is_some(),
        "warnings": loaded.warnings.len(),
        "not_supported": unsupported(&loaded.warnings),
        "repairs": loaded.repairs,
    })
}

/// Returns a line per fact: first what people ask for, then numbers.
fn to_text(facts: &Value, repairs: &SanitizeReport) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |key: &str, shown: String| {
        let _ = writeln!(text, "{:<32}{shown}", key.replace('_', " "));
    };
    line("cameras", cameras(&facts["cameras"]));
    if let [first, last] = list(&facts["frame_range"]) {
        line("frames of the animation", format!("{first} to {last}"));
    }
    line("lights", counted(list(&facts["lights"]).iter().map(described)));
    line(
        "material names",
        counted(
            list(&facts["material_names"])
                .iter()
                .filter_map(Value::as_str)
                .map(|name| shown_line(name).into_owned()),
        ),
    );
    let [low, high] = ["min", "max"].map(|corner| &facts["box"][corner]);
    if !low.is_null() {
        line("box in units of the file", format!("{low} to {high}"));
    }
    for (key, value) in facts.as_object().into_iter().flatten() {
        if LISTS.contains(&key.as_str()) {
            continue;
        }
        let shown = match key.as_str() {
            "repairs" => repairs.to_string(),
            _ => value.as_str().map_or_else(|| value.to_string(), |text| shown_line(text).into_owned()),
        };
        line(key, shown);
    }
    text
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Returns kind and name of a light.
fn described(light: &Value) -> String {
    let kind = light["kind"].as_str().unwrap_or_default();
    match light["name"].as_str().filter(|name| !name.is_empty()) {
        Some(name) => format!("{kind} ({})", shown_line(name)),
        None => kind.to_owned(),
    }
}

/// Joins items; equal ones are counted.
fn counted(items: impl Iterator<Item = String>) -> String {
    let mut groups: Vec<(String, usize)> = Vec::new();
    for item in items {
        match groups.iter_mut().find(|(known, _)| *known == item) {
            Some((_, count)) => *count += 1,
            None => groups.push((item, 1)),
        }
    }
    let shown = |(item, count): (String, usize)| if count > 1 { format!("{count} x {item}") } else { item };
    match groups.is_empty() {
        true => "none".to_owned(),
        false => groups.into_iter().map(shown).collect::<Vec<_>>().join(", "),
    }
}
