//! What reaches a receiver from one VPL, and the upper bound of what can reach it from a cluster.
//!
//! Paper: Walter et al. 2005, section 3.2: bound = I · M⁺ · G⁺, visibility bounded by 1.
//! Units: all per unit intensity, before visibility.

use super::geometry::{OffsetBox, max_cos_to_cone};
use super::receiver::Receiver;
use crate::light_tree::Node;
use crate::math::{Frame, Rgb};
use crate::vpl::{SpotProfile, Vpl, VplKind};
use glam::Vec3;

/// Distances below this fraction of the scene's diagonal count as this: it keeps a VPL on the receiver finite.
pub const MIN_DISTANCE: f32 = 1e-5;

/// What the transfer from all VPLs of a scene has in common.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    /// Profiles that omni VPLs refer to.
    pub spots: &'a [SpotProfile],
    /// Least squared distance that the geometry term divides by.
    pub min_dist_sq: f32,
}

impl<'a> Transfer<'a> {
    /// For a scene of the given diagonal.
    pub fn new(spots: &'a [SpotProfile], diagonal: f32) -> Transfer<'a> {
        let min_distance = (diagonal * MIN_DISTANCE).max(1e-18);
        Transfer { spots, min_dist_sq: min_distance * min_distance }
    }

    /// Contribution of a VPL of unit intensity, if visible.
    #[inline]
    pub fn unshadowed<R: Receiver>(&self, receiver: &R, vpl: &Vpl, kind: VplKind) -> Rgb {
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
                Some(profile) => self.spots[profile].falloff(-wi),
            },
        };
        if emitted <= 0.0 {
            return Rgb::ZERO;
        }
        receiver.response(wi) * (emitted / dist_sq.max(self.min_dist_sq))
    }

    /// No smaller, in any channel, than the contribution of any member of a cluster at unit intensity.
    #[inline]
    pub fn bound<R: Receiver>(&self, receiver: &R, node: &Node) -> Rgb {
        if node.kind() == VplKind::Directional {
            return receiver.max_response(&OffsetBox::new(node.min, node.max));
        }
        let x = receiver.position();
        let offsets = OffsetBox::new(node.min - x, node.max - x);
        let response = receiver.max_response(&offsets);
        if response == Rgb::ZERO {
            return Rgb::ZERO;
        }
        let emitted = if node.cos_beta <= -1.0 {
            1.0
        } else {
            let cos_theta = offsets.turned(&Frame::from_normal(-node.axis)).max_cos_z();
            max_cos_to_cone(cos_theta, node.cos_beta, node.sin_beta)
        };
        response * (emitted / offsets.min_dist_sq().max(self.min_dist_sq))
    }
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
