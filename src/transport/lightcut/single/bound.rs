//! Upper bound of the light that can reach a receiver from a cluster.
//!
//! Paper: Walter et al. 2005, section 3.2: bound = I · M⁺ · G⁺, visibility bounded by 1.
//! Units: values per unit intensity, before visibility.

use super::{OffsetBox, max_cos_to_cone, max_cos_to_cone_signed};
use crate::lightcut::expected::{Outlook, expected_share, lobe_at};
use crate::lightcut::{Receiver, Transfer};
use crate::lights::{LightNode, VplKind};
use base::math::{Frame, Rgb};
use glam::Vec3;
use world::material::LobeShape;

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
    #[inline]
    pub fn bound(&self, receiver: &Receiver, node: &LightNode) -> Bound {
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
        let lobed = node.kind() == VplKind::Lobed;
        let (emitted, emitted_centre) = if directional || node.cos_beta <= -1.0 && !lobed {
            (1.0, centre_sq.sqrt())
        } else {
            let turned = offsets.turned(&Frame::from_normal(-node.axis));
            let (most, z) = (turned.max_cos_z(), turned.centre().z);
            if lobed {
                let cos = max_cos_to_cone_signed(most, node.cos_beta, node.sin_beta());
                (LobeShape::max_share(cos, node.width_sq()), lobe_at(z, centre_sq.sqrt(), node.width_sq()))
            } else {
                (max_cos_to_cone(most, node.cos_beta, node.sin_beta()), z)
            }
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
