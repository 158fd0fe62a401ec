//! Places of the instances of a node's mesh (`EXT_mesh_gpu_instancing`).

use super::document::GltfFile;
use super::transform::quaternion;
use crate::error::SceneError;
use crate::findings::Findings;
use glam::{DMat4, DVec3};
use gltf_json::{Index, Node};
use serde_json::Value;

/// Name of the extension.
const NAME: &str = "EXT_mesh_gpu_instancing";

/// Returns the transforms of a node's instances to the node's coordinates; `None` for a node with one mesh.
///
/// Instances whose transforms are not finite are left out, and named.
pub(super) fn places(
    document: &GltfFile,
    node: usize,
    report: &mut Findings,
) -> Result<Option<Vec<DMat4>>, SceneError> {
    let extensions = document.root.nodes.get(node).and_then(|node: &Node| node.extensions.as_ref());
    let Some(extension) = extensions.and_then(|extensions| extensions.others.get(NAME)) else {
        return Ok(None);
    };
    let what = format!("{NAME} of node {node}");
    let accessor = |name: &str| match extension.get("attributes").and_then(|all| all.get(name)) {
        None => Ok(None),
        Some(value) => {
            let index = Value::as_u64(value).and_then(|index| u32::try_from(index).ok());
            let wrong = || document.wrong(format!("{what}: {name} is no accessor"));
            index.map(Index::new).map(Some).ok_or_else(wrong)
        }
    };
    let vectors = |name| accessor(name)?.map(|at| document.vectors::<3>(at, &what)).transpose();
    let (translations, scales) = (vectors("TRANSLATION")?, vectors("SCALE")?);
    let rotations = accessor("ROTATION")?.map(|at| document.vectors::<4>(at, &what)).transpose()?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let Some(count) = counts.into_iter().flatten().next() else {
        return Err(document.wrong(format!("{what} has no TRANSLATION, ROTATION or SCALE")));
    };
    if counts.into_iter().flatten().any(|other| other != count) {
        return Err(document.wrong(format!("{what} has attributes of different lengths")));
    }
    if count == 0 {
        report.lacks("a list of instances is empty", "the mesh is left out; export the model again", &what);
    }
    let vector = |all: &Option<Vec<[f32; 3]>>, i: usize, default: DVec3| {
        all.as_ref().map_or(default, |all| DVec3::from(all[i].map(f64::from)))
    };
    let place = |i: usize| {
        let rotation = rotations.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |all| all[i]);
        let rotation = quaternion(rotation.map(f64::from));
        let (scale, translation) = (vector(&scales, i, DVec3::ONE), vector(&translations, i, DVec3::ZERO));
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    };
    let mut places: Vec<DMat4> = (0..count).map(place).collect();
    places.retain(DMat4::is_finite);
    if places.len() < count {
        let lack = "transforms of instances are not finite";
        report.lacks(lack, "these instances are left out; repair or re-export the model", &what);
    }
    Ok(Some(places))
}
