//! The tree of nodes of a scene.

use super::document::GltfFile;
use super::transform::{Local, Place};
use crate::error::SceneError;
use crate::selection::PartSelection;
use gltf_json::{Index, Node};

/// A node in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    /// Index in the file.
    pub node: usize,
    /// Index of the parent in the tree.
    pub parent: Option<usize>,
    pub place: Place,
    /// True if the selection contains the node.
    pub selected: bool,
}

/// Returns the nodes of the file's default scene, parents before their children; `local` returns the transform of a
/// node by its index.
pub(super) fn tree(
    document: &GltfFile,
    selection: &PartSelection,
    local: impl Fn(usize) -> Local,
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
        let local = local(index.value());
        let place = above.map_or_else(Place::default, |above| above.place).child(&local);
        tree.push(Placed { node: index.value(), parent, place, selected });
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
