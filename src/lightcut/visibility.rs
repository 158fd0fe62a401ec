//! Visibility in a real scene: shadow rays of single points and of groups.

use super::{PacketVisibility, ReceiverPacket, Visibility, to_vpl};
use crate::light_tree::Node;
use crate::shadow::Engine;
use crate::vpl::Vpl;
use crate::world::World;
use glam::Vec3;

impl Visibility for Engine<'_> {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &Node) -> bool {
        !self.occluded(&to_vpl(x, normal, vpl, node.kind()), node.representative() as u32)
    }
}

impl PacketVisibility for Engine<'_> {
    #[inline]
    fn visible16(&self, points: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16 {
        let rays = points.shadow_rays(vpl, node.kind());
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
    fn visible16(&self, points: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &Node) -> u16 {
        Engine::new(self).visible16(points, lanes, vpl, node)
    }
}
