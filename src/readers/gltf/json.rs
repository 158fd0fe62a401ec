//! JSON as exporters write it: whole numbers with a decimal point, -1 and `null` for what is absent.
//!
//! A file that needs no repair is parsed from its text, so that errors have lines.

use serde_json::{Map, Value};

/// Members that hold an index or a list of indices. Here -1 stands for nothing.
const INDICES: [&str; 20] = [
    "buffer",
    "bufferView",
    "camera",
    "children",
    "index",
    "indices",
    "input",
    "inverseBindMatrices",
    "joints",
    "light",
    "material",
    "mesh",
    "node",
    "nodes",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
];

/// Other members that hold whole numbers.
const WHOLE: [&str; 12] = [
    "byteLength",
    "byteOffset",
    "byteStride",
    "componentType",
    "count",
    "magFilter",
    "minFilter",
    "mode",
    "target",
    "texCoord",
    "wrapS",
    "wrapT",
];

/// Largest number below which all whole numbers are exact.
const MAX_EXACT: f64 = 9_007_199_254_740_992.0;

/// Repairs the members of a file's objects; returns true if any was changed.
pub(super) fn repair(root: &mut Value) -> bool {
    match root {
        Value::Object(members) => repair_object(members, false),
        // Every element is repaired, so nothing may end the search early.
        Value::Array(list) => list.iter_mut().filter_map(|value| repair(value).then_some(())).count() > 0,
        _ => false,
    }
}

/// Repairs an object. If `is_map`, each of its members is an index, whatever its name.
fn repair_object(members: &mut Map<String, Value>, is_map: bool) -> bool {
    let is_index = |key: &str| is_map || INDICES.contains(&key);
    let count = members.len();
    members.retain(|key, value| {
        key == "extras" && !value.is_null()
            || !(value.is_null() || is_index(key) && is_none(value) || refers_to_nothing(value))
    });
    let mut changed = members.len() < count;
    for (key, value) in members.iter_mut().filter(|(key, _)| *key != "extras") {
        let may_be_index = is_index(key);
        changed |= match value {
            Value::Number(_) => (may_be_index || WHOLE.contains(&key.as_str())) && make_whole(value),
            Value::Array(list) if may_be_index => repair_indices(list),
            Value::Object(map) => repair_object(map, key == "attributes"),
            // Each morph target is a map of attributes.
            Value::Array(list) if key == "targets" => {
                let maps = list.iter_mut().filter_map(Value::as_object_mut);
                maps.filter_map(|map| repair_object(map, true).then_some(())).count() > 0
            }
            value => repair(value),
        };
    }
    changed
}

/// Repairs a list of indices, or of objects.
fn repair_indices(list: &mut Vec<Value>) -> bool {
    let count = list.len();
    let are_objects = list.iter().any(Value::is_object);
    list.retain(|value| are_objects || !(value.is_null() || is_none(value)));
    let is_shorter = list.len() < count;
    let change = |value: &mut Value| make_whole(value) || repair(value);
    list.iter_mut().fold(is_shorter, |changed, value| change(value) || changed)
}

/// True if an index stands for nothing.
fn is_none(value: &Value) -> bool {
    value.as_f64() == Some(-1.0)
}

/// True if an object refers to a texture or a light by an index that stands for nothing.
fn refers_to_nothing(value: &Value) -> bool {
    ["index", "light"].iter().any(|key| value.get(key).is_some_and(|value| value.is_null() || is_none(value)))
}

/// Writes a whole number without a decimal point; returns true if it had one.
fn make_whole(value: &mut Value) -> bool {
    match value.as_f64() {
        Some(number) if value.is_f64() && number.fract() == 0.0 && number.abs() < MAX_EXACT => {
            *value = Value::from(number as i64);
            true
        }
        _ => false,
    }
}

/// Takes out the channels of animations that move no node; returns true if there were any.
pub(super) fn drop_pointers(root: &mut Value) -> bool {
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    let mut changed = false;
    for animation in animations.into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let count = channels.len();
        channels.retain(|channel| channel.pointer("/target/node").is_some());
        changed |= channels.len() < count;
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn whole_numbers_and_absent_members_are_written_plainly() {
        let mut file = json!({
            "scene": 0.0, "nodes": [{ "mesh": 1.0, "name": null, "children": [2.0, -1, null], "skin": -1,
                "translation": [1.0, -1.0, 0.0], "extensions": { "KHR_lights_punctual": { "light": -1 } } }],
            "materials": [{ "normalTexture": { "index": -1.0 }, "emissiveFactor": [1.0, 0.0, 0.0] }],
            "meshes": [{ "primitives": [{ "material": -1, "mode": 4.0, "attributes": { "POSITION": 0.0 },
                "targets": [{ "POSITION": 3.0, "NORMAL": -1 }] }], "extras": { "count": 1.0 } }],
            "accessors": [{ "componentType": 5126.0, "count": 4.0, "min": [-1.0] }], "extras": null,
        });
        assert!(repair(&mut file));
        let expected = json!({
            "scene": 0, "nodes": [{ "mesh": 1, "children": [2], "translation": [1.0, -1.0, 0.0], "extensions": {} }],
            "materials": [{ "emissiveFactor": [1.0, 0.0, 0.0] }],
            "meshes": [{ "primitives": [{ "mode": 4, "attributes": { "POSITION": 0 },
                "targets": [{ "POSITION": 3 }] }], "extras": { "count": 1.0 } }],
            "accessors": [{ "componentType": 5126, "count": 4, "min": [-1.0] }],
        });
        assert_eq!(file, expected);
        assert!(!repair(&mut file));
    }

    #[test]
    fn other_numbers_stay() {
        for mut file in [
            json!({ "accessors": [{ "count": 4.5 }, { "count": 1e300 }] }),
            json!({ "cameras": [{ "perspective": { "yfov": 1.0, "znear": 1.0 } }] }),
            json!({ "animations": [{ "channels": [{ "target": { "node": 0, "path": "scale" } }] }] }),
        ] {
            let before = file.clone();
            assert!(!repair(&mut file) && !drop_pointers(&mut file));
            assert_eq!(file, before);
        }
    }
}
