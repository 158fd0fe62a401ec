//! Pose of a model: transforms of its nodes and weights of its morph targets, at rest or at a time of its animation.

use super::animation::{self, Track};
use super::document::GltfFile;
use super::nodes::{Local, Placed};
use crate::error::SceneError;
use gltf_json::Node;
use gltf_json::mesh::Mesh;
use std::collections::BTreeSet;
use std::iter::successors;

/// Pose of a model. The default is its pose at rest.
#[derive(Default)]
pub(super) struct Pose {
    tracks: Vec<Track>,
    /// Time in seconds.
    time: f64,
}

impl Pose {
    /// Returns the pose at a time of the first animation, in seconds; at rest without a time or an animation.
    pub fn at(document: &GltfFile, time: Option<f64>) -> Result<Pose, SceneError> {
        match (time, document.root.animations.first()) {
            (Some(time), Some(animation)) => {
                Ok(Pose { tracks: animation::tracks(document, animation, |_| true)?, time })
            }
            _ => Ok(Pose::default()),
        }
    }

    /// Returns the local transform of the node of index `index`.
    pub fn local(&self, index: usize, node: &Node) -> Local {
        let mut local = Local::of(node);
        self.of(index).for_each(|track| track.apply(&mut local, self.time));
        local
    }

    /// Returns the weights of the morph targets of the node of index `index` and its mesh; further weights are 0.
    pub fn weights(&self, index: usize, node: &Node, mesh: &Mesh) -> Vec<f32> {
        let animated = self.of(index).find_map(|track| track.weights(self.time));
        animated.or_else(|| node.weights.clone()).or_else(|| mesh.weights.clone()).unwrap_or_default()
    }

    /// Returns true if the animation moves a mesh or a light of the tree, or changes the weights of a mesh.
    pub fn moves(&self, document: &GltfFile, tree: &[Placed]) -> bool {
        let joints: BTreeSet<usize> =
            document.root.skins.iter().flat_map(|skin| &skin.joints).map(|joint| joint.value()).collect();
        let is_moved = |at: usize| {
            let mut chain = successors(Some(at), |&at| tree[at].parent);
            chain.any(|at| self.of(tree[at].node).any(|track| track.moves() && track.varies()))
        };
        tree.iter().enumerate().any(|(at, placed)| {
            let node = &document.root.nodes[placed.node];
            let mut weights = self.of(placed.node).filter(|track| !track.moves() && track.varies());
            let is_light = node.extensions.as_ref().is_some_and(|e| e.khr_lights_punctual.is_some());
            let is_placed = node.mesh.is_some() || is_light || joints.contains(&placed.node);
            node.mesh.is_some() && weights.next().is_some() || is_placed && is_moved(at)
        })
    }

    fn of(&self, index: usize) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(move |track| track.node == index)
    }
}

/// Returns the first and the last time of the first animation, in seconds; `None` without an animation.
pub(super) fn span(document: &GltfFile) -> Result<Option<[f64; 2]>, SceneError> {
    let Some(animation) = document.root.animations.first() else { return Ok(None) };
    let tracks = animation::tracks(document, animation, |_| true)?;
    let spans = tracks.iter().map(|track| track.span().map(f64::from));
    Ok(spans.reduce(|[a, b], [start, end]| [a.min(start), b.max(end)]))
}
