//! Sum over all VPLs, with one shadow ray each: the reference for tests of lightcuts.

use crate::lightcut::{Receiver, Transfer, Visibility};
use base::math::Rgb;
use glam::DVec3;

/// Gathers the light of all VPLs at `receiver`, without clamping.
pub fn gather_all<V: Visibility>(transfer: &Transfer, visibility: &V, receiver: &Receiver) -> Rgb {
    let mut sum = DVec3::ZERO;
    for leaf in transfer.trees.leaves() {
        let vpl = &transfer.trees.vpls[leaf.representative()];
        let contribution = leaf.intensity * transfer.unshadowed(receiver, vpl, leaf.kind());
        let (x, normal) = (receiver.position(), receiver.geometric_normal());
        if contribution != Rgb::ZERO && visibility.visible(x, normal, vpl, leaf) {
            sum += (contribution * visibility.transmittance(receiver, transfer.trees, leaf)).as_dvec3();
        }
    }
    sum.as_vec3()
}
