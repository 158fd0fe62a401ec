//! Clusters of a cut, and their light at the points of up to sixteen records.

use super::compensate::Clamps;
use super::source::Candidate;
use crate::lightcut::{Transfer, is_weak};
use crate::lights::{LightNode, LobeProfile, Vpl, VplKind};
use base::math::{F32x16, Frame, LANES, Vec3x16, lanes_in};
use glam::Vec3;
use world::material::Materials;

/// Cluster of a cut, as its representative lights points.
#[derive(Clone, Copy)]
pub struct LitCluster<'t> {
    /// Transfer from the virtual lights.
    pub transfer: &'t Transfer<'t>,
    /// The cluster.
    pub node: &'t LightNode,
    /// Its representative.
    pub vpl: &'t Vpl,
}

impl<'t> LitCluster<'t> {
    /// The cluster of a node.
    #[inline]
    pub fn new(transfer: &'t Transfer<'t>, node: u32) -> LitCluster<'t> {
        let node = &transfer.trees.nodes[node as usize];
        LitCluster { transfer, node, vpl: &transfer.trees.vpls[node.representative()] }
    }

    /// Shares that are kept of its contributions, by the irradiance `responses` to its representative.
    #[inline]
    pub fn kept(&self, clamps: &Clamps, responses: &Vec3x16) -> F32x16 {
        if is_weak(self.node) { clamps.kept(self.node.intensity, responses) } else { [1.0; LANES] }
    }

    /// Lobe by which its representative radiates, if it does.
    #[inline]
    pub fn lobe(&self) -> Option<&'t LobeProfile> {
        let is_lobed = self.node.kind() == VplKind::Lobed;
        is_lobed.then(|| &self.transfer.trees.profiles.lobes[self.vpl.lobe()])
    }

    /// Returns the minimum squared distance that the geometry term of the representative divides by.
    #[inline]
    pub fn near_sq(&self) -> f32 {
        self.transfer.near_sq(self.vpl, self.node.kind())
    }
}

/// Points of up to sixteen records, lane by lane.
pub struct RecordPoints<'a> {
    candidates: &'a [Candidate],
    materials: &'a Materials,
    position: Vec3x16,
    /// Tangents, bitangents and normals of their frames.
    pub(super) axes: [Vec3x16; 3],
    /// Lanes whose light has to pass a coat.
    coated: u16,
}

/// Light of one cluster at the points.
pub struct ArrivingLight {
    /// Irradiance after clamping and coat.
    pub passed: Vec3x16,
    /// Unit direction to the representative, in each point's frame.
    pub direction: Vec3x16,
    /// One over the distance; 0 for a directional light.
    pub inverse: F32x16,
}

impl<'a> RecordPoints<'a> {
    /// Points of `candidates`, of which only sixteen count.
    pub fn new(candidates: &'a [Candidate], materials: &'a Materials) -> RecordPoints<'a> {
        let candidates = &candidates[..candidates.len().min(LANES)];
        let mut points = RecordPoints {
            candidates,
            materials,
            position: Vec3x16::ZERO,
            axes: [Vec3x16::ZERO; 3],
            coated: 0,
        };
        for (lane, candidate) in candidates.iter().enumerate() {
            let frame = Frame::from_normal(candidate.point.normal);
            points.position.set(lane, candidate.point.position);
            for (axis, v) in points.axes.iter_mut().zip([frame.tangent, frame.bitangent, frame.normal]) {
                axis.set(lane, v);
            }
            points.coated |= u16::from(candidate.coat != 0) << lane;
        }
        points
    }

    /// Light of a cluster whose representative, of unit intensity, gives the irradiance `responses`, of which
    /// clamping leaves the share `kept`.
    pub(super) fn arriving(&self, cluster: &LitCluster, responses: &Vec3x16, kept: &F32x16) -> ArrivingLight {
        let distant = cluster.node.kind() == VplKind::Directional;
        let intensity = cluster.node.intensity;
        let mut light =
            ArrivingLight { passed: Vec3x16::ZERO, direction: Vec3x16::ZERO, inverse: [0.0; LANES] };
        for l in 0..LANES {
            let q = if distant { cluster.vpl.position } else { cluster.vpl.position - self.position.get(l) };
            let dist_sq = q.length_squared();
            let inverse = if dist_sq > 0.0 { 1.0 / dist_sq.sqrt() } else { 0.0 };
            let q = q * if distant { 1.0 } else { inverse };
            let [t, b, n] = &self.axes;
            let local = Vec3::new(q.dot(t.get(l)), q.dot(b.get(l)), q.dot(n.get(l)));
            light.direction.set(l, local);
            light.inverse[l] = if distant { 0.0 } else { inverse };
            let share = if local.z > 0.0 { kept[l] } else { 0.0 };
            light.passed.set(l, intensity * responses.get(l) * share);
        }
        for l in lanes_in(self.coated) {
            let cos = light.direction.z[l].min(1.0);
            let passing = self.materials.coat_transmittance(self.candidates[l].coat, cos);
            light.passed.set(l, light.passed.get(l) * passing);
        }
        light
    }
}
