//! Upper bound of the light that can reach a receiver from a cluster.
//!
//! Paper: Walter et al. 2005, section 3.2: bound = I · M⁺ · G⁺, visibility bounded by 1.
//! Units: values per unit intensity, before visibility.

use crate::lightcut::cluster_box::{ClusterBox, Place};
use crate::lightcut::{Receiver, Transfer};
use crate::lights::LightNode;
use base::math::{Frame, Rgb, V3};

/// Upper bound of a cluster of unit intensity, before visibility, and its expected error.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Upper bound, by channel, of the contribution of any member.
    pub most: Rgb,
    /// Expected error relative to `most` (see [`crate::lightcut::expected`]).
    pub share: f32,
}

impl Transfer<'_> {
    /// Returns the bound of a cluster of unit intensity, and its expected error.
    #[inline(never)]
    pub fn bound(&self, receiver: &Receiver, node: &LightNode) -> Bound {
        let cluster = ClusterBox::new(receiver.reach(), node);
        let seen = self.geometry(&cluster, receiver, node);
        if !(seen.cos_x > 0.0) {
            return Bound { most: Rgb::ZERO, share: 0.0 };
        }
        let response = match receiver.lambert_brdf() {
            Some(brdf) => brdf * seen.cos_x,
            None => receiver.max_reflection(&cluster.directions(receiver, seen.cos_x)),
        };
        Bound { most: response * seen.geometry, share: seen.share }
    }
}

impl Place<f32> for Receiver<'_> {
    #[inline(always)]
    fn position(&self) -> V3<f32> {
        V3::splat(self.place().0)
    }
    #[inline(always)]
    fn frame(&self) -> [V3<f32>; 3] {
        axes(Receiver::frame(self))
    }
    #[inline(always)]
    fn mirror(&self) -> [V3<f32>; 3] {
        axes(Receiver::mirror(self))
    }
    #[inline(always)]
    fn reach(&self) -> f32 {
        Receiver::position(self).abs().max_element()
    }
}

#[inline(always)]
fn axes(frame: &Frame) -> [V3<f32>; 3] {
    [V3::splat(frame.tangent), V3::splat(frame.bitangent), V3::splat(frame.normal)]
}
