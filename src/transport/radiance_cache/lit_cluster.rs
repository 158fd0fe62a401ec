//! Clusters of a cut, and their light at the points of up to sixteen records.

use super::cells::Candidate;
use crate::lightcut::Transfer;
use crate::lights::{LightNode, LobeProfile, Vpl, VplKind};
use base::math::{F32x16, Frame, LANES, Vec3x16, lanes_in};
use glam::Vec3;
use world::material::Materials;

/// Cluster of a cut, lit through its representative.
#[derive(Clone, Copy)]
pub struct LitCluster<'t> {
    /// Transfer from the virtual lights.
    pub transfer: &'t Transfer<'t>,
    /// Node of the cluster.
    pub node: &'t LightNode,
    /// Representative of the cluster.
    pub vpl: &'t Vpl,
}

impl<'t> LitCluster<'t> {
    /// Returns the cluster of a node.
    #[inline]
    pub fn new(transfer: &'t Transfer<'t>, node: u32) -> LitCluster<'t> {
        let node = &transfer.trees.nodes[node as usize];
        LitCluster { transfer, node, vpl: &transfer.trees.vpls[node.representative()] }
    }

    /// Returns the lobe of the representative, if it radiates by one.
    #[inline]
    pub fn lobe(&self) -> Option<&'t LobeProfile> {
        let is_lobed = self.node.kind() == VplKind::Lobed;
        is_lobed.then(|| &self.transfer.trees.profiles.lobes[self.vpl.lobe()])
    }

    /// Returns the minimum squared distance by which the geometry term of the representative is divided.
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
    /// Tangents, bitangents and normals of the points' frames.
    pub(super) axes: [Vec3x16; 3],
    /// Lanes whose light passes a coat.
    coated: u16,
}

/// Light of one cluster at up to sixteen points.
pub struct Arriving16 {
    /// Irradiance after clamping and the coat.
    pub passed: Vec3x16,
    /// Unit direction to the representative, in each point's frame.
    pub direction: Vec3x16,
    /// Inverse of the distance, in 1/m; 0 for a directional light.
    pub inverse: F32x16,
    /// Share of the light that clamping retains.
    pub retained: F32x16,
}

impl<'a> RecordPoints<'a> {
    /// Returns the points of the first sixteen `candidates`.
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

    /// Returns the light of a cluster at the points. `responses` is the irradiance of the representative at unit
    /// intensity; clamping retains the share `retained` of it.
    #[inline]
    pub fn arriving(&self, cluster: &LitCluster, responses: &Vec3x16, retained: F32x16) -> Arriving16 {
        let distant = cluster.node.kind() == VplKind::Directional;
        let intensity = cluster.node.intensity;
        let (passed, direction) = (Vec3x16::ZERO, Vec3x16::ZERO);
        let mut light = Arriving16 { passed, direction, inverse: [0.0; LANES], retained };
        for l in 0..LANES {
            let q = if distant { cluster.vpl.position } else { cluster.vpl.position - self.position.get(l) };
            let dist_sq = q.length_squared();
            let inverse = if dist_sq > 0.0 { 1.0 / dist_sq.sqrt() } else { 0.0 };
            let q = q * if distant { 1.0 } else { inverse };
            let [t, b, n] = &self.axes;
            let local = Vec3::new(q.dot(t.get(l)), q.dot(b.get(l)), q.dot(n.get(l)));
            light.direction.set(l, local);
            light.inverse[l] = if distant { 0.0 } else { inverse };
            let share = if local.z > 0.0 { retained[l] } else { 0.0 };
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
