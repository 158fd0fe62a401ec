//! Visibility of virtual lights in a scene: from a single point and from a packet.

use super::{ReceiverPacket, to_vpl};
use crate::light_tree::Node;
use crate::shadow::Engine;
use crate::vpl::Vpl;
use crate::world::World;
use glam::Vec3;

/// Visibility of a VPL from a single point.
pub trait Visibility {
    /// True if nothing lies between the surface point `x` with geometric normal `normal` and the VPL, which
    /// represents `node`.
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool;
}

/// Visibility of a VPL from the points of a packet.
pub trait PacketVisibility {
    /// The lanes of `lanes` that see the VPL, which represents `node`.
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16;
}

impl Visibility for Engine<'_> {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool {
        !self.occluded(&to_vpl(x, normal, vpl, node.kind()), node.representative() as u32)
    }
}

impl PacketVisibility for Engine<'_> {
    #[inline]
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16 {
        let rays = receivers.shadow_rays(vpl, node.kind());
        lanes & !self.occluded16(&rays, lanes)
    }
}

impl Visibility for World {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool {
        Visibility::visible(&Engine::new(self), x, normal, vpl, node)
    }
}

impl PacketVisibility for World {
    #[inline]
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16 {
        Engine::new(self).visible16(receivers, lanes, vpl, node)
    }
}
