//! Sum over all VPLs, with one shadow ray each: the reference for tests of lightcuts.

use crate::lightcut::{Receiver, Transfer, Visibility, to_vpl};
use base::math::{Rgb, Vec3x16};
use embree::Rays16;
use glam::DVec3;

/// Gathers the light of all VPLs at `receiver`, without clamping.
pub fn gather_all<V: Visibility>(transfer: &Transfer, visibility: &V, receiver: &Receiver) -> Rgb {
    let (x, normal) = (receiver.position(), receiver.geometric_normal());
    let (mut rays, mut sum) = (Rays16::default(), DVec3::ZERO);
    for leaf in transfer.trees.leaves() {
        let (vpl, before) = transfer.trees.representative(leaf);
        let contribution = leaf.intensity * transfer.unshadowed(receiver, vpl, leaf.kind());
        rays.set(0, &to_vpl(x, normal, vpl, leaf.kind()));
        if contribution != Rgb::ZERO && visibility.visible16(&rays, 1, None) != 0 {
            let mut light = Vec3x16::splat(contribution);
            visibility.attenuate16(&rays, 1, |_| receiver.sheets(before), &mut light);
            sum += light.get(0).as_dvec3();
        }
    }
    sum.as_vec3()
}
