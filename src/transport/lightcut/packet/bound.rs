//! Upper bounds of a cluster's light at all receivers of a packet.

use super::ReceiverPacket;
use super::cluster_box::ClusterBox;
use crate::lightcut::Transfer;
use crate::lights::LightNode;
use base::math::{F32x16, LANES, LUMINANCE, Lane, Mask16, f32x16, lanes_in, luminance};
use world::material::DirectionBound;

impl Transfer<'_> {
    /// Returns the expected error of each receiver's luminance from a cluster; 0 in lanes without a receiver.
    pub fn errors16(&self, receivers: &ReceiverPacket, node: &LightNode) -> F32x16 {
        let (bounds, shares) = self.bounds16(receivers, node);
        (bounds * shares).to_array()
    }

    /// Returns the upper bound of each receiver's luminance, 0 in lanes without a receiver, and the expected error
    /// relative to it.
    #[inline(always)]
    pub(super) fn bounds16(&self, receivers: &ReceiverPacket, node: &LightNode) -> (f32x16, f32x16) {
        let cluster = ClusterBox::new(receivers.reach, node);
        let seen = self.geometry(&cluster, receivers, node);
        let cosines = seen.geometry * seen.cos_x;
        let mut bounds = receivers.brdf_luminance.load().along(node.intensity) * cosines;
        // Lanes whose lobes a part of the cluster may reach; many clusters have none.
        let general = Mask16::of(receivers.general);
        let lit = (general & cosines.is_positive()).bits();
        if lit != 0 {
            let directions = cluster.directions(receivers, seen.cos_x);
            let reflected = match &receivers.glossy {
                Some(glossy) => glossy.bound(&directions).along(node.intensity * LUMINANCE),
                None => one_by_one(receivers, node, lit, &directions),
            };
            bounds = f32x16::pick(general, reflected * seen.geometry, bounds);
        }
        (bounds.keep(Mask16::of(receivers.valid)), seen.share)
    }
}

/// Bounds the reflection of each lane on its own.
fn one_by_one(
    receivers: &ReceiverPacket,
    node: &LightNode,
    lanes: u16,
    directions: &DirectionBound<f32x16>,
) -> f32x16 {
    let (max, min) = (directions.cos_i_max.to_array(), directions.cos_i_min.to_array());
    let mirror = directions.cos_mirror_max.to_array();
    let mut reflected = [0.0; LANES];
    for l in lanes_in(lanes) {
        let bound = DirectionBound { cos_i_max: max[l], cos_i_min: min[l], cos_mirror_max: mirror[l] };
        reflected[l] = luminance(receivers.get(l).max_reflection(&bound) * node.intensity);
    }
    f32x16::new(reflected)
}
