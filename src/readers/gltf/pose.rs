//! Pose of a model: transforms of its nodes and weights of its morph targets, at rest or at a time of its animation.

use super::animation::Clip;
use super::document::GltfFile;
use super::nodes::Placed;
use super::transform::Local;
use crate::findings::Findings;
use gltf_json::Node;
use gltf_json::mesh::Mesh;
use std::collections::BTreeSet;
use std::iter::successors;

/// Pose of a model. The default is its pose at rest.
#[derive(Default)]
pub(super) struct Pose {
    pub clip: Clip,
    /// Time in seconds; `None` at rest.
    pub time: Option<f64>,
}

impl Pose {
    /// Returns the local transform of the node of index `index`.
    pub fn local(&self, document: &GltfFile, index: usize) -> Local {
        self.local_at(document, index, self.time)
    }

    /// Returns the local transform of a node at another time.
    pub fn local_at(&self, document: &GltfFile, index: usize, time: Option<f64>) -> Local {
        let mut local = document.locals[index];
        if let Some(time) = time {
            self.clip.of_node(index).for_each(|track| track.apply(&mut local, time));
        }
        local
    }

    /// Returns the weights of the morph targets of the node of index `index` and its mesh; further weights are 0.
    pub fn weights(&self, index: usize, node: &Node, mesh: &Mesh) -> Vec<f32> {
        let animated =
            self.time.and_then(|time| self.clip.of_node(index).find_map(|track| track.weights(time)));
        animated.or_else(|| node.weights.clone()).or_else(|| mesh.weights.clone()).unwrap_or_default()
    }

    /// Returns true if the animation moves a mesh or a light of the tree, or changes the weights of a mesh.
    pub fn moves(&self, document: &GltfFile, tree: &[Placed]) -> bool {
        let joints: BTreeSet<usize> =
            document.root.skins.iter().flat_map(|skin| &skin.joints).map(|joint| joint.value()).collect();
        let is_moved = |at: usize| {
            let mut chain = successors(Some(at), |&at| tree[at].parent);
            chain.any(|at| self.clip.of_node(tree[at].node).any(|track| track.moves() && track.varies()))
        };
        tree.iter().enumerate().any(|(at, placed)| {
            let node = &document.root.nodes[placed.node];
            let mut weights = self.clip.of_node(placed.node).filter(|track| !track.moves() && track.varies());
            let is_light = node.extensions.as_ref().is_some_and(|e| e.khr_lights_punctual.is_some());
            let is_placed = node.mesh.is_some() || is_light || joints.contains(&placed.node);
            node.mesh.is_some() && weights.next().is_some() || is_placed && is_moved(at)
        })
    }

    /// Notes what of the animation the pose does not show. The animation has `frames` frames; `walk` renders them if
    /// the model `is_scene`.
    pub fn report(
        &self,
        document: &GltfFile,
        tree: &[Placed],
        is_scene: bool,
        frames: usize,
        report: &mut Findings,
    ) {
        for name in &self.clip.left_out {
            report.note("an animation moves what another one moves", "the first of them plays", name);
        }
        if self.time.is_some() || frames == 0 {
            return;
        }
        if is_scene {
            let what = format!("there is an animation of {frames} frames");
            report.note(&what, "this is the pose at rest; walk renders all frames, and --frame N one", "");
        } else if self.moves(document, tree) {
            let what = "a model in a TOML scene does not move";
            report.lacks(what, "`time` of the mesh chooses its pose; walk of the model alone moves it", "");
        }
    }
}
