//! Lists of what a scene contains: cameras, lights, its box, and what is not supported.

use super::opened::grouped;
use base::shown::shown_line;
use glam::{DVec3, Vec3};
use readers::{Severity, Warning};
use scene::{DeltaLight, Environment, Scene};
use serde_json::{Value, json};

/// Returns numbers and names of cameras for users.
pub fn cameras(names: &Value) -> String {
    let names = names.as_array().map_or(&[][..], Vec::as_slice);
    let shown = |(i, name): (usize, &Value)| match name.as_str().unwrap_or_default() {
        "" => (i + 1).to_string(),
        name => format!("{} ({})", i + 1, shown_line(name)),
    };
    match names {
        [] => "none; the whole scene is framed".to_owned(),
        _ => names.iter().enumerate().map(shown).collect::<Vec<_>>().join(", "),
    }
}

/// Returns all lights: kind, name and size of emitting meshes, and positions in units of the file.
pub fn lights(scene: &Scene) -> Vec<Value> {
    let corners = scene.seen_bounds(|_| true).into_iter().flatten();
    let largest = corners.map(|corner| in_file(scene, corner).abs().max_element()).fold(0.0, f64::max);
    let position = |local: Vec3| rounded(in_file(scene, local), largest);
    let delta = |light: &DeltaLight| match light {
        DeltaLight::Point { position: at, .. } => json!({ "kind": "point", "position": position(*at) }),
        DeltaLight::Spot { position: at, .. } => json!({ "kind": "spot", "position": position(*at) }),
        DeltaLight::Projector { position: at, .. } => {
            json!({ "kind": "projector", "position": position(*at) })
        }
        DeltaLight::Directional { direction, .. } => {
            json!({ "kind": "directional", "direction": rounded(direction.as_dvec3(), 1.0) })
        }
    };
    let emitters = scene.meshes.iter().filter(|mesh| mesh.emission.is_some());
    let area =
        emitters.map(|mesh| json!({ "kind": "area", "name": mesh.name, "triangles": mesh.triangles.len() }));
    let disc = scene.discs.iter().map(|disc| {
        json!({
            "kind": "distant disc",
            "direction": rounded(disc.direction.as_dvec3(), 1.0),
            "half_angle_degrees": disc.half_angle.to_degrees(),
        })
    });
    let environment = scene.environment.iter().map(|environment| match environment {
        Environment::Constant(_) => json!({ "kind": "constant environment" }),
        Environment::Map(map) => json!({ "kind": "environment map", "size": [map.width, map.height] }),
    });
    scene.lights.iter().map(delta).chain(area).chain(disc).chain(environment).collect()
}

/// Returns the box around all triangles in units of the file; null without any.
pub fn bounds(scene: &Scene) -> Value {
    match scene.seen_bounds(|_| true).into_iter().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]) {
        Some([low, high]) => {
            let corners = [low, high].map(|corner| in_file(scene, corner));
            let largest = corners.map(|corner| corner.abs().max_element()).into_iter().fold(0.0, f64::max);
            let [low, high] = corners.map(|corner| rounded(corner, largest));
            json!({ "min": low, "max": high })
        }
        None => Value::Null,
    }
}

/// Returns what the file asks for and the model lacks, with what takes its place.
pub fn unsupported(warnings: &[Warning]) -> Vec<Value> {
    let fact = |(warning, times): (&Warning, usize)| {
        json!({
            "place": warning.place.to_string(),
            "severity": match warning.severity {
                Severity::Note => "note",
                Severity::Warning => "warning",
            },
            "what": warning.what,
            "instead": warning.fallback,
            "places": times,
        })
    };
    grouped(warnings).into_iter().map(fact).collect()
}

fn in_file(scene: &Scene, local: Vec3) -> DVec3 {
    scene.centre + local.as_dvec3() * scene.unit()
}

/// Returns coordinates with six digits of the `largest` one: positions are 32-bit.
fn rounded(position: DVec3, largest: f64) -> [f64; 3] {
    let scale = 10f64.powi(6 - largest.max(1e-30).log10().ceil() as i32);
    let round = |x: f64| if scale.is_finite() && scale > 0.0 { (x * scale).round() / scale + 0.0 } else { x };
    position.to_array().map(round)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use scene::{MaterialId, Mesh};

    /// Returns a mesh with a triangle of its first three positions.
    pub fn triangle(positions: Vec<Vec3>) -> Mesh {
        Mesh {
            name: String::new(),
            positions,
            normals: Vec::new(),
            uvs: Vec::new(),
            tangents: Vec::new(),
            triangles: vec![[0, 1, 2]],
            material: MaterialId(0),
            emission: None,
            attributes: Vec::new(),
        }
    }

    #[test]
    fn boxes_are_in_units_of_the_file() {
        let positions =
            vec![Vec3::new(-1.0, 0.0, 2.0), Vec3::new(3.0, 1.0, 0.0), Vec3::ZERO, Vec3::splat(9.0)];
        let mesh = triangle(positions);
        let centre = DVec3::new(100.0, 0.0, 0.1);
        let scene = Scene { meshes: vec![mesh], centre, exponent: 1, ..Scene::default() };
        assert_eq!(bounds(&scene), json!({ "min": [98.0, 0.0, 0.1], "max": [106.0, 2.0, 4.1] }));
        assert_eq!(bounds(&Scene::default()), Value::Null);
    }

    #[test]
    fn cameras_are_listed_by_number_and_name() {
        assert_eq!(cameras(&json!(["Camera", ""])), "1 (Camera), 2");
        assert!(cameras(&json!([])).contains("framed"));
    }
}
