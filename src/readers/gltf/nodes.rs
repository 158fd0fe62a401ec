//! The tree of nodes of a scene, and their transforms.

use super::document::GltfFile;
use crate::error::SceneError;
use crate::selection::PartSelection;
use glam::{DMat4, DQuat, DVec3};
use gltf_json::{Index, Node};

/// Local transform of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Local {
    Matrix(DMat4),
    /// Transform in three steps: scale, rotation, translation.
    Steps {
        scale: DVec3,
        rotation: DQuat,
        translation: DVec3,
    },
}

impl Local {
    pub fn of(node: &Node) -> Local {
        let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        match node.matrix {
            Some(matrix) => Local::Matrix(DMat4::from_cols_array(&matrix.map(f64::from))),
            None => Local::Steps {
                scale: vector(node.scale.unwrap_or([1.0; 3])),
                rotation: quaternion(node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0)),
                translation: vector(node.translation.unwrap_or_default()),
            },
        }
    }

    pub fn matrix(&self) -> DMat4 {
        match *self {
            Local::Matrix(matrix) => matrix,
            Local::Steps { scale, rotation, translation } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// Returns a unit quaternion; the identity for a quaternion without direction.
pub(super) fn quaternion(xyzw: [f32; 4]) -> DQuat {
    let q = DQuat::from_array(xyzw.map(f64::from));
    if q.is_finite() && q.length_squared() > 0.0 { q.normalize() } else { DQuat::IDENTITY }
}

/// A node in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    /// Index in the file.
    pub node: usize,
    /// Index of the parent in the tree.
    pub parent: Option<usize>,
    /// Transform from local coordinates to the file's.
    pub to_file: DMat4,
    /// True if the selection contains the node.
    pub selected: bool,
}

/// Returns the nodes of the file's default scene, parents before their children; `local` returns the transform of a
/// node by its index.
pub(super) fn tree(
    document: &GltfFile,
    selection: &PartSelection,
    local: impl Fn(usize, &Node) -> Local,
) -> Result<Vec<Placed>, SceneError> {
    let nodes = &document.root.nodes;
    let mut seen = vec![false; nodes.len()];
    let mut tree: Vec<Placed> = Vec::new();
    let mut waiting: Vec<(Index<Node>, Option<usize>)> =
        roots(document)?.into_iter().map(|n| (n, None)).collect();
    waiting.reverse();
    while let Some((index, parent)) = waiting.pop() {
        let node = document.get(index, "node")?;
        if std::mem::replace(&mut seen[index.value()], true) {
            let what = format!("node {} has two parents, or is below itself", index.value());
            return Err(document.wrong(what));
        }
        let above = parent.map(|at| &tree[at]);
        let is = |names: &[String]| node.name.as_ref().is_some_and(|name| names.contains(name));
        let selected = match above {
            _ if is(&selection.except) => false,
            _ if is(&selection.only) => true,
            Some(above) => above.selected,
            None => selection.only.is_empty(),
        };
        let to_file =
            above.map_or(DMat4::IDENTITY, |above| above.to_file) * local(index.value(), node).matrix();
        tree.push(Placed { node: index.value(), parent, to_file, selected });
        let at = tree.len() - 1;
        waiting.extend(node.children.iter().flatten().rev().map(|child| (*child, Some(at))));
    }
    Ok(tree)
}

/// Returns the roots of the file's scene, or of all nodes if the file has no scene.
fn roots(document: &GltfFile) -> Result<Vec<Index<Node>>, SceneError> {
    let root = &document.root;
    let scene = match root.scene {
        Some(index) => Some(document.get(index, "scene")?),
        None => root.scenes.first(),
    };
    if let Some(scene) = scene {
        return Ok(scene.nodes.clone());
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        document.get(*child, "node")?;
        is_child[child.value()] = true;
    }
    Ok((0..root.nodes.len()).filter(|&i| !is_child[i]).map(|i| Index::new(i as u32)).collect())
}
