//! Statements of glTF files, and those of a file that are not read.
//!
//! A statement's name is the path of its property, without the numbers of lists and without "extensions". The
//! properties of references to textures stand below "textureInfo".

use crate::statements::{Fate, Statement, fate, listed, table};
use serde_json::Value;
use std::collections::BTreeSet;

/// Returns the statements of glTF 2.0 and its extensions.
fn gltf() -> &'static [Statement] {
    table("glTF")
}

/// Statements that are named where materials and textures are read.
const NAMED_ELSEWHERE: &[&str] = &[
    "textures.KHR_texture_basisu",
    "textures.EXT_texture_avif",
    "textures.MSFT_texture_dds",
    "materials.KHR_materials_clearcoat.clearcoatRoughnessTexture",
    "materials.KHR_materials_clearcoat.clearcoatNormalTexture",
    "materials.KHR_materials_sheen.sheenColorTexture",
    "materials.KHR_materials_sheen.sheenRoughnessFactor",
    "materials.KHR_materials_sheen.sheenRoughnessTexture",
    "materials.KHR_materials_specular.specularTexture",
    "materials.KHR_materials_specular.specularColorTexture",
    "materials.KHR_materials_unlit",
];

/// Statements that any object may have.
const ANYWHERE: [&str; 3] = ["extras", "name", "KHR_xmp_json_ld"];

/// Statements of a file that are not read.
#[derive(Default)]
pub(super) struct Unread {
    /// Warnings, and the objects that they are about.
    pub findings: Vec<(String, String)>,
    /// Names of all extensions that objects of the file have.
    pub extensions: BTreeSet<String>,
}

/// Returns the statements of a file that are not read.
pub(super) fn unread(root: &Value) -> Unread {
    let mut unread = Unread::default();
    unread.look_into(root, "", "");
    unread
}

impl Unread {
    /// Looks into an object of the path `path`, or a list of such; `owner` is the name of the object around it.
    fn look_into(&mut self, value: &Value, path: &str, owner: &str) {
        match value {
            Value::Object(object) => {
                for (key, value) in object {
                    match (key.as_str(), value) {
                        ("extensions", Value::Object(extensions)) => {
                            for (name, value) in extensions {
                                self.extensions.insert(name.clone());
                                let what = format!("the extension {name} is not supported");
                                self.look_at(name, value, path, owner, Some(what));
                            }
                        }
                        _ => self.look_at(key, value, path, owner, None),
                    }
                }
            }
            Value::Array(list) => {
                let kind = if path == "meshes" { "mesh" } else { path.strip_suffix('s').unwrap_or(path) };
                for (i, value) in list.iter().enumerate() {
                    match (path.contains('.'), value.get("name").and_then(Value::as_str)) {
                        (true, _) => self.look_into(value, path, owner),
                        (false, Some(name)) => self.look_into(value, path, name),
                        (false, None) => self.look_into(value, path, &format!("{kind} {i}")),
                    }
                }
            }
            _ => {}
        }
    }

    /// Looks at a statement of an object of the path `above`; `what` is the warning if it is not read.
    fn look_at(&mut self, key: &str, value: &Value, above: &str, owner: &str, what: Option<String>) {
        if ANYWHERE.contains(&key) {
            return;
        }
        let path = match above {
            "" => key.to_owned(),
            _ => format!("{above}.{}", general(key, above)),
        };
        let is_listed = listed(gltf(), &path).is_some();
        let is_below =
            |name: &str| name.strip_prefix(path.as_str()).is_some_and(|rest| rest.starts_with('.'));
        match fate(gltf(), &path) {
            Fate::Named if !is_listed && gltf().iter().any(|statement| is_below(statement.name)) => {
                self.look_into(value, &path, owner);
            }
            Fate::Named if NAMED_ELSEWHERE.contains(&path.as_str()) => {}
            Fate::Named => {
                let what = what.unwrap_or_else(|| format!("{path} is not read"));
                self.findings.push((what, owner.to_owned()));
            }
            _ if key.ends_with("Texture") => self.look_into(value, "textureInfo", owner),
            _ => {}
        }
    }
}

/// Returns the name that stands for `key` in the list, if the key is numbered or one of an application.
fn general(key: &str, above: &str) -> String {
    let is_attribute = above.ends_with(".attributes") || above.ends_with(".targets");
    match key.rsplit_once('_') {
        _ if is_attribute && key.starts_with('_') => "_*".to_owned(),
        Some(("COLOR", "0")) => key.to_owned(),
        Some((name, number)) if is_attribute && number.parse::<u32>().is_ok() => format!("{name}_n"),
        _ => key.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Returns a file with the statement of a path.
    fn file(path: &str) -> Value {
        let path = path.replace("_*", "_OWN").replace("_n", "_1");
        let path = match path.strip_prefix("textureInfo.") {
            Some(rest) => format!("materials.normalTexture.{rest}"),
            None => path,
        };
        path.rsplit('.').fold(json!(1), |value, key| match key.split_once('_') {
            Some((vendor @ ("KHR" | "EXT" | "MSFT"), _)) if !vendor.is_empty() => {
                json!({ "extensions": { key: value } })
            }
            _ => json!({ key: value }),
        })
    }

    #[test]
    fn statements_are_named_if_they_are_not_read() {
        for Statement { name, fate, .. } in gltf() {
            let found = unread(&file(name)).findings;
            let is_named = *fate == Fate::Named && !NAMED_ELSEWHERE.contains(name);
            assert_eq!(found.len(), usize::from(is_named), "{name}: {found:?}");
        }
        for name in NAMED_ELSEWHERE {
            assert_eq!(fate(gltf(), name), Fate::Named, "{name}");
            assert!(gltf().iter().any(|statement| statement.name == *name), "{name}");
        }
    }

    #[test]
    fn what_no_list_has_is_named_with_its_owner() {
        let file = json!({
            "nodes": [{}, { "name": "lamp", "extensions": { "EXT_a": { "b": 1 } }, "extras": { "c": 1 } }],
            "meshes": [{ "primitives": [{ "targets": [{ "COLOR_0": 1, "POSITION": 2 }], "attributes": { "FOO_0": 3 } }] }],
            "materials": [{ "normalTexture": { "index": 0, "extensions": { "EXT_d": {} } }, "shine": 1 }],
        });
        let mut found = unread(&file);
        found.findings.sort();
        let expected = [
            ("materials.shine is not read", "material 0"),
            ("meshes.primitives.attributes.FOO_n is not read", "mesh 0"),
            ("meshes.primitives.targets.COLOR_0 is not read", "mesh 0"),
            ("the extension EXT_a is not supported", "lamp"),
            ("the extension EXT_d is not supported", "material 0"),
        ];
        assert_eq!(found.findings, expected.map(|(what, owner)| (what.to_owned(), owner.to_owned())));
        assert!(found.extensions.contains("EXT_d") && unread(&Value::Null).findings.is_empty());
    }
}
