//! Visibility of virtual lights in a scene: from a single point and from a packet.

use super::{Receiver, ReceiverPacket, to_vpl};
use crate::lights::{LightNode, LightTrees, Vpl};
use base::math::{LANES, Rgb, Vec3x16, first_lanes, lanes_in};
use embree::{Ray, Rays16};
use glam::Vec3;
use world::World;
use world::shadow::Engine;

/// Visibility of a VPL from a single point.
pub trait Visibility {
    /// True if nothing lies between the surface point `x` with geometric normal `normal` and the VPL, which
    /// represents `node`.
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> bool;

    /// Transmittance of the thin sheets between the receiver and the VPL that represents `node`, which is visible; 0 if
    /// light would take more edges than it may.
    fn transmittance(&self, _receiver: &Receiver, _trees: &LightTrees, _node: &LightNode) -> Rgb {
        Rgb::ONE
    }
}

/// Visibility of a VPL from the points of a packet.
pub trait PacketVisibility {
    /// Returns the lanes of `lanes` that see the VPL, which represents `node`.
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &LightNode) -> u16;

    /// Multiplies the `light` in `lanes`, which see the VPL that represents `node`, by
    /// [`Visibility::transmittance`].
    fn attenuate16(
        &self,
        _receivers: &ReceiverPacket,
        _lanes: u16,
        _trees: &LightTrees,
        _node: &LightNode,
        _light: &mut Vec3x16,
    ) {
    }
}

/// Visibility along rays to VPLs, one VPL per ray.
pub trait RayVisibility {
    /// Returns the lanes of the first `count` whose rays are not occluded. Multiplies their `light` by the
    /// transmittance of the thin sheets on its way, of which it may pass at most `sheets` (see [`Receiver::sheets`]).
    fn arriving16(
        &self,
        rays: &Rays16,
        count: usize,
        sheets: &[Option<u32>; LANES],
        light: &mut Vec3x16,
    ) -> u16;
}

/// Returns the transmittance of at most `sheets` sheets on a segment; 0 if there are more, or if `sheets` is `None`.
fn through(world: &World, segment: &Ray, sheets: Option<u32>) -> Rgb {
    sheets.map_or(Rgb::ZERO, |most| world.transmittance_of(segment, most))
}

impl Visibility for Engine<'_> {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> bool {
        !self.occluded(&to_vpl(x, normal, vpl, node.kind()), node.representative() as u32)
    }

    #[inline]
    fn transmittance(&self, receiver: &Receiver, trees: &LightTrees, node: &LightNode) -> Rgb {
        if !self.world().has_sheets() {
            return Rgb::ONE;
        }
        let (vpl, before) = trees.representative(node);
        let segment = to_vpl(receiver.position(), receiver.geometric_normal(), vpl, node.kind());
        through(self.world(), &segment, receiver.sheets(before))
    }
}

impl PacketVisibility for Engine<'_> {
    #[inline]
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &LightNode) -> u16 {
        let rays = receivers.shadow_rays(vpl, node.kind());
        lanes & !self.occluded16(&rays, lanes)
    }

    #[inline]
    fn attenuate16(
        &self,
        receivers: &ReceiverPacket,
        lanes: u16,
        trees: &LightTrees,
        node: &LightNode,
        light: &mut Vec3x16,
    ) {
        if self.world().has_sheets() {
            let (vpl, before) = trees.representative(node);
            let rays = receivers.shadow_rays(vpl, node.kind());
            for lane in lanes_in(lanes) {
                let sheets = receivers.get(lane).sheets(before);
                light.set(lane, light.get(lane) * through(self.world(), &rays.get(lane), sheets));
            }
        }
    }
}

impl RayVisibility for Engine<'_> {
    #[inline]
    fn arriving16(
        &self,
        rays: &Rays16,
        count: usize,
        sheets: &[Option<u32>; LANES],
        light: &mut Vec3x16,
    ) -> u16 {
        let lanes = first_lanes(count);
        let free = lanes & !self.occluded16(rays, lanes);
        if self.world().has_sheets() {
            for lane in lanes_in(free) {
                light.set(lane, light.get(lane) * through(self.world(), &rays.get(lane), sheets[lane]));
            }
        }
        free
    }
}

impl Visibility for World {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> bool {
        Visibility::visible(&Engine::new(self), x, normal, vpl, node)
    }

    #[inline]
    fn transmittance(&self, receiver: &Receiver, trees: &LightTrees, node: &LightNode) -> Rgb {
        Visibility::transmittance(&Engine::new(self), receiver, trees, node)
    }
}

impl PacketVisibility for World {
    #[inline]
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &LightNode) -> u16 {
        Engine::new(self).visible16(receivers, lanes, vpl, node)
    }

    #[inline]
    fn attenuate16(
        &self,
        receivers: &ReceiverPacket,
        lanes: u16,
        trees: &LightTrees,
        node: &LightNode,
        light: &mut Vec3x16,
    ) {
        Engine::new(self).attenuate16(receivers, lanes, trees, node, light)
    }
}

impl RayVisibility for World {
    #[inline]
    fn arriving16(
        &self,
        rays: &Rays16,
        count: usize,
        sheets: &[Option<u32>; LANES],
        light: &mut Vec3x16,
    ) -> u16 {
        Engine::new(self).arriving16(rays, count, sheets, light)
    }
}
