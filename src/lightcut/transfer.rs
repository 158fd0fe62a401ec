//! What reaches a receiver from one VPL, and the upper bound of what can reach it from a cluster.
//!
//! Paper: Walter et al. 2005, section 3.2: bound = I · M⁺ · G⁺, visibility bounded by 1.
//! Units: all per unit intensity, before visibility.

use super::expected::{Outlook, expected_share};
use super::{OffsetBox, Receiver, max_cos_to_cone};
use crate::light_tree::{LightTrees, Node};
use crate::math::{Frame, Rgb};
use crate::vpl::{Vpl, VplKind, min_dist_sq, near_sq_of_size};
use glam::Vec3;

/// What the transfer from all VPLs of a scene has in common.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    /// All VPLs and their clusters.
    pub trees: &'a LightTrees,
    /// Least squared distance that the geometry term divides by.
    pub min_dist_sq: f32,
    /// Whether VPLs on area lights divide by no less than the area that they stand for: what lies closer sees more of
    /// the light than one point can stand for, and short rays find it (see [`crate::compensation`]).
    pub patches: bool,
}

impl<'a> Transfer<'a> {
    /// From the VPLs of `trees` in a scene of the given diagonal.
    pub fn new(trees: &'a LightTrees, diagonal: f32) -> Transfer<'a> {
        Transfer { trees, min_dist_sq: min_dist_sq(diagonal), patches: false }
    }

    /// Least squared distance that the geometry term of a VPL divides by.
    #[inline]
    pub fn near_sq(&self, vpl: &Vpl, kind: VplKind) -> f32 {
        match kind {
            VplKind::Oriented if self.patches => near_sq_of_size(vpl.size(), self.min_dist_sq),
            _ => self.min_dist_sq,
        }
    }

    /// Contribution of a VPL of unit intensity, if visible.
    #[inline]
    pub fn unshadowed(&self, receiver: &Receiver, vpl: &Vpl, kind: VplKind) -> Rgb {
        if kind == VplKind::Directional {
            return receiver.response(vpl.position);
        }
        let offset = vpl.position - receiver.position();
        let dist_sq = offset.length_squared();
        if dist_sq == 0.0 {
            return Rgb::ZERO; // on the receiver itself: no direction, no light
        }
        let wi = offset / dist_sq.sqrt();
        let emitted = match kind {
            VplKind::Oriented => -vpl.normal().dot(wi),
            _ => match vpl.spot_profile() {
                None => 1.0,
                Some(profile) => self.trees.spots[profile].falloff(-wi),
            },
        };
        if emitted <= 0.0 {
            return Rgb::ZERO;
        }
        receiver.response(wi) * (emitted / dist_sq.max(self.near_sq(vpl, kind)))
    }

    /// What is known of a cluster of unit intensity.
    #[inline]
    pub fn bound(&self, receiver: &Receiver, node: &Node) -> Bound {
        let directional = node.kind() == VplKind::Directional;
        let x = if directional { Vec3::ZERO } else { receiver.position() };
        let offsets = OffsetBox::new(node.min - x, node.max - x);
        let local = offsets.turned(receiver.frame());
        let response = receiver.max_response(&offsets, &local);
        if response == Rgb::ZERO {
            return Bound { most: Rgb::ZERO, share: 0.0 };
        }
        let centre_sq = offsets.centre().length_squared();
        let near_sq = if directional { centre_sq } else { offsets.min_dist_sq().max(self.min_dist_sq) };
        let (emitted, emitted_centre) = if node.cos_beta <= -1.0 || directional {
            (1.0, centre_sq.sqrt())
        } else {
            let turned = offsets.turned(&Frame::from_normal(-node.axis));
            (max_cos_to_cone(turned.max_cos_z(), node.cos_beta, node.sin_beta), turned.centre().z)
        };
        let share = expected_share(Outlook {
            near_sq,
            centre_sq,
            at_centre: [local.centre().z, emitted_centre],
            largest: [local.max_cos_z(), emitted],
        });
        Bound { most: if directional { response } else { response * (emitted / near_sq) }, share }
    }
}

/// Upper bound of a cluster of unit intensity, before visibility, and the error to expect.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// No smaller, in any channel, than the contribution of any member.
    pub most: Rgb,
    /// Error to expect, relative to `most`: see [`super::expected`].
    pub share: f32,
}

/// Whether a receiver sees a VPL.
pub trait Visibility {
    /// True if nothing lies between the surface point `x` with geometric normal `normal` and the VPL, which
    /// represents `node`.
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool;
}

/// No surfaces at all: everything is visible.
#[derive(Clone, Copy, Debug)]
pub struct Unoccluded;

impl Visibility for Unoccluded {
    #[inline]
    fn visible(&self, _: Vec3, _: Vec3, _: &Vpl, _: &Node) -> bool {
        true
    }
}
