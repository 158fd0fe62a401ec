//! The sum over all VPLs, one shadow ray each: the reference that a lightcut approximates, and is tested
//! against.

use crate::lightcut::{Receiver, Transfer, Visibility};
use base::math::Rgb;
use glam::DVec3;

/// Gathers the light of all VPLs at `receiver`. Time is proportional to their number; nothing is clamped.
pub fn gather_all<V: Visibility>(transfer: &Transfer, visibility: &V, receiver: &Receiver) -> Rgb {
    let mut sum = DVec3::ZERO;
    for leaf in transfer.trees.leaves() {
        let vpl = &transfer.trees.vpls[leaf.representative()];
        let contribution = leaf.intensity * transfer.unshadowed(receiver, vpl, leaf.kind());
        let (x, normal) = (receiver.position(), receiver.geometric_normal());
        if contribution != Rgb::ZERO && visibility.visible(x, normal, vpl, leaf) {
            sum += (contribution * visibility.transmittance(x, normal, vpl, leaf)).as_dvec3();
        }
    }
    sum.as_vec3()
}
