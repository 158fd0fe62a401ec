//! Statements of glTF files, and those of a file that are not read.
//!
//! A statement's name is the path of its property, without the numbers of lists and without "extensions". The
//! properties of references to textures stand below "textureInfo".

use crate::statements::Fate;
use crate::statements::Statement;
use crate::statements::fate;
use serde_json::Value;
use std::collections::BTreeSet;

const fn read(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Read, note }
}

const fn named(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Named, note }
}

const fn no_effect(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::NoEffect, note }
}

/// Statements of glTF 2.0 and its extensions.
pub(super) const STATEMENTS: &[Statement] = &[
    no_effect("extras", "data of applications, anywhere"),
    read("name", "in messages, and for `group`, `except` and `--camera`"),
    no_effect("KHR_xmp_json_ld", "metadata, anywhere"),
    read("asset.version", "2.0; another one is an error"),
    read("asset.minVersion", "more than 2.0 is an error"),
    read("asset.generator", "units of lights and solid glass of Blender's exporter"),
    no_effect("asset.copyright", ""),
    read("extensionsUsed", "an extension that is not read is named"),
    read("extensionsRequired", "an extension that is not read is an error"),
    read("scene", ""),
    read("scenes.nodes", "of the default scene"),
    named("scenes.EXT_lights_image_based", ""),
    read("nodes.camera", ""),
    read("nodes.children", ""),
    read("nodes.matrix", ""),
    read("nodes.mesh", ""),
    read("nodes.rotation", ""),
    read("nodes.scale", "mirrors keep the outside outside"),
    read("nodes.translation", ""),
    read("nodes.skin", "joints place the mesh"),
    read("nodes.weights", "of morph targets"),
    read("nodes.KHR_lights_punctual.light", ""),
    read("nodes.EXT_mesh_gpu_instancing.attributes.TRANSLATION", ""),
    read("nodes.EXT_mesh_gpu_instancing.attributes.ROTATION", ""),
    read("nodes.EXT_mesh_gpu_instancing.attributes.SCALE", ""),
    no_effect("nodes.EXT_mesh_gpu_instancing.attributes._*", "attributes of applications"),
    named("nodes.KHR_node_visibility", ""),
    read("meshes.primitives.attributes.POSITION", "of any type of component"),
    read("meshes.primitives.attributes.NORMAL", ""),
    read("meshes.primitives.attributes.TANGENT", "for normal maps and anisotropy"),
    read("meshes.primitives.attributes.TEXCOORD_n", "of the set that the material asks for"),
    read("meshes.primitives.attributes.COLOR_0", "a factor on the base colour; its alpha, on the opacity"),
    named("meshes.primitives.attributes.COLOR_n", "sets beyond the first"),
    read("meshes.primitives.attributes.JOINTS_n", "all sets"),
    read("meshes.primitives.attributes.WEIGHTS_n", "all sets"),
    no_effect("meshes.primitives.attributes._*", "attributes of applications"),
    read("meshes.primitives.indices", ""),
    read("meshes.primitives.material", ""),
    read(
        "meshes.primitives.mode",
        "triangles, strips and fans; points and lines are left out with a warning",
    ),
    read("meshes.primitives.targets.POSITION", ""),
    read("meshes.primitives.targets.NORMAL", ""),
    read("meshes.primitives.targets.TANGENT", ""),
    read("meshes.primitives.KHR_draco_mesh_compression.bufferView", ""),
    read("meshes.primitives.KHR_draco_mesh_compression.attributes", ""),
    named("meshes.primitives.KHR_materials_variants", "the default material is used"),
    read("meshes.weights", ""),
    read("accessors.bufferView", ""),
    read("accessors.byteOffset", ""),
    read("accessors.componentType", ""),
    read("accessors.count", ""),
    read("accessors.type", ""),
    read("accessors.normalized", ""),
    read("accessors.sparse.count", ""),
    read("accessors.sparse.indices.bufferView", ""),
    read("accessors.sparse.indices.byteOffset", ""),
    read("accessors.sparse.indices.componentType", ""),
    read("accessors.sparse.values.bufferView", ""),
    read("accessors.sparse.values.byteOffset", ""),
    no_effect("accessors.min", ""),
    no_effect("accessors.max", ""),
    read("bufferViews.buffer", ""),
    read("bufferViews.byteOffset", ""),
    read("bufferViews.byteLength", ""),
    read("bufferViews.byteStride", ""),
    no_effect("bufferViews.target", ""),
    read("bufferViews.EXT_meshopt_compression.buffer", ""),
    read("bufferViews.EXT_meshopt_compression.byteOffset", ""),
    read("bufferViews.EXT_meshopt_compression.byteLength", ""),
    read("bufferViews.EXT_meshopt_compression.byteStride", ""),
    read("bufferViews.EXT_meshopt_compression.count", ""),
    read("bufferViews.EXT_meshopt_compression.mode", ""),
    read("bufferViews.EXT_meshopt_compression.filter", ""),
    read("bufferViews.KHR_meshopt_compression.buffer", ""),
    read("bufferViews.KHR_meshopt_compression.byteOffset", ""),
    read("bufferViews.KHR_meshopt_compression.byteLength", ""),
    read("bufferViews.KHR_meshopt_compression.byteStride", ""),
    read("bufferViews.KHR_meshopt_compression.count", ""),
    read("bufferViews.KHR_meshopt_compression.mode", ""),
    read("bufferViews.KHR_meshopt_compression.filter", ""),
    read("buffers.uri", ""),
    read("buffers.byteLength", ""),
    read("buffers.EXT_meshopt_compression.fallback", "a fallback is not opened"),
    read("buffers.KHR_meshopt_compression.fallback", "a fallback is not opened"),
    read("images.uri", ""),
    read("images.bufferView", ""),
    no_effect("images.mimeType", "the bytes tell"),
    read("samplers.magFilter", ""),
    no_effect("samplers.minFilter", "colours are averaged over pixels"),
    read("samplers.wrapS", ""),
    read("samplers.wrapT", "as `wrapS`, with a warning if they differ"),
    read("textures.sampler", ""),
    read("textures.source", ""),
    read("textures.EXT_texture_webp.source", "if there is no `source`"),
    named("textures.KHR_texture_basisu", "the `source` is used; without one the texture is left out"),
    named("textures.EXT_texture_avif", "the `source` is used; without one the texture is left out"),
    named("textures.MSFT_texture_dds", "the `source` is used; without one the texture is left out"),
    read("textureInfo.index", ""),
    read("textureInfo.texCoord", "one set per material; another is named"),
    read("textureInfo.scale", "of normal maps"),
    no_effect("textureInfo.strength", "of occlusion"),
    read("textureInfo.KHR_texture_transform.offset", ""),
    read("textureInfo.KHR_texture_transform.rotation", ""),
    read("textureInfo.KHR_texture_transform.scale", ""),
    read("textureInfo.KHR_texture_transform.texCoord", ""),
    read("materials.pbrMetallicRoughness.baseColorFactor", ""),
    read("materials.pbrMetallicRoughness.baseColorTexture", ""),
    read("materials.pbrMetallicRoughness.metallicFactor", ""),
    read("materials.pbrMetallicRoughness.roughnessFactor", ""),
    read("materials.pbrMetallicRoughness.metallicRoughnessTexture", ""),
    read("materials.normalTexture", ""),
    read("materials.emissiveTexture", ""),
    read("materials.emissiveFactor", ""),
    read("materials.alphaMode", ""),
    read("materials.alphaCutoff", ""),
    read("materials.doubleSided", "of emission; surfaces have two sides"),
    no_effect("materials.occlusionTexture", "light in crevices is computed"),
    read("materials.KHR_materials_anisotropy.anisotropyStrength", ""),
    read("materials.KHR_materials_anisotropy.anisotropyRotation", ""),
    read("materials.KHR_materials_anisotropy.anisotropyTexture", ""),
    read("materials.KHR_materials_clearcoat.clearcoatFactor", "a quarter of the coat, with a warning"),
    read("materials.KHR_materials_clearcoat.clearcoatTexture", ""),
    read("materials.KHR_materials_clearcoat.clearcoatRoughnessFactor", ""),
    named("materials.KHR_materials_clearcoat.clearcoatRoughnessTexture", "left out"),
    named("materials.KHR_materials_clearcoat.clearcoatNormalTexture", "left out"),
    read("materials.KHR_materials_emissive_strength.emissiveStrength", ""),
    read("materials.KHR_materials_ior.ior", ""),
    read("materials.KHR_materials_sheen.sheenColorFactor", "its strength, with a warning"),
    named("materials.KHR_materials_sheen.sheenColorTexture", "sheen is white and soft"),
    named("materials.KHR_materials_sheen.sheenRoughnessFactor", "sheen is white and soft"),
    named("materials.KHR_materials_sheen.sheenRoughnessTexture", "sheen is white and soft"),
    read("materials.KHR_materials_specular.specularFactor", ""),
    read("materials.KHR_materials_specular.specularColorFactor", "its strength; other hues are named"),
    named("materials.KHR_materials_specular.specularTexture", "only the factors are used"),
    named("materials.KHR_materials_specular.specularColorTexture", "only the factors are used"),
    read(
        "materials.KHR_materials_transmission.transmissionFactor",
        "sheets transmit fully or not at all, with a warning",
    ),
    read("materials.KHR_materials_transmission.transmissionTexture", ""),
    named("materials.KHR_materials_unlit", "the surface shines in its colour"),
    read("materials.KHR_materials_volume.thicknessFactor", ""),
    read("materials.KHR_materials_volume.attenuationDistance", ""),
    read("materials.KHR_materials_volume.attenuationColor", ""),
    no_effect("materials.KHR_materials_volume.thicknessTexture", "the geometry has the thickness"),
    named("materials.KHR_materials_diffuse_transmission", ""),
    named("materials.KHR_materials_dispersion", ""),
    named("materials.KHR_materials_iridescence", ""),
    named("materials.KHR_materials_pbrSpecularGlossiness", ""),
    named("materials.KHR_materials_subsurface", ""),
    named("materials.KHR_materials_volume_scatter", ""),
    read("skins.joints", ""),
    read("skins.inverseBindMatrices", ""),
    no_effect("skins.skeleton", ""),
    read("cameras.type", ""),
    read("cameras.perspective.aspectRatio", ""),
    read("cameras.perspective.yfov", ""),
    read("cameras.perspective.zfar", ""),
    read("cameras.perspective.znear", ""),
    read("cameras.orthographic.xmag", ""),
    read("cameras.orthographic.ymag", ""),
    read("cameras.orthographic.zfar", ""),
    read("cameras.orthographic.znear", ""),
    read("animations.channels.sampler", ""),
    read("animations.channels.target.node", "by `walk`, or at `--frame` or `time`; else named"),
    read("animations.channels.target.path", ""),
    named("animations.channels.target.KHR_animation_pointer", "the property stands still"),
    read("animations.samplers.input", ""),
    read("animations.samplers.interpolation", ""),
    read("animations.samplers.output", ""),
    read("KHR_lights_punctual.lights.type", ""),
    read("KHR_lights_punctual.lights.color", ""),
    read("KHR_lights_punctual.lights.intensity", ""),
    read("KHR_lights_punctual.lights.spot.innerConeAngle", ""),
    read("KHR_lights_punctual.lights.spot.outerConeAngle", ""),
    no_effect("KHR_lights_punctual.lights.range", "lights reach any distance"),
    named("KHR_lights_punctual.lights.EXT_lights_ies", "the light shines evenly"),
    named("KHR_materials_variants", "the default materials are used"),
    named("EXT_lights_image_based", ""),
    named("EXT_lights_ies", "lights shine evenly"),
];

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
        let is_listed = STATEMENTS.iter().any(|statement| statement.name == path);
        let is_below =
            |name: &str| name.strip_prefix(path.as_str()).is_some_and(|rest| rest.starts_with('.'));
        match fate(STATEMENTS, &path) {
            Fate::Named if !is_listed && STATEMENTS.iter().any(|statement| is_below(statement.name)) => {
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
    use crate::statements::assert_page_lists;
    use serde_json::json;

    #[test]
    fn the_page_lists_the_statements() {
        assert_page_lists("glTF", STATEMENTS);
    }

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
        for Statement { name, fate, .. } in STATEMENTS {
            let found = unread(&file(name)).findings;
            let is_named = *fate == Fate::Named && !NAMED_ELSEWHERE.contains(name);
            assert_eq!(found.len(), usize::from(is_named), "{name}: {found:?}");
        }
        for name in NAMED_ELSEWHERE {
            assert_eq!(fate(STATEMENTS, name), Fate::Named, "{name}");
            assert!(STATEMENTS.iter().any(|statement| statement.name == *name), "{name}");
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
