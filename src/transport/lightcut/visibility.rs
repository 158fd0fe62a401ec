//! Visibility of virtual lights in a scene: from a single point and from a packet.

use super::{ReceiverPacket, to_vpl};
use crate::lights::{LightNode, Vpl};
use base::math::{Rgb, Vec3x16, first_lanes};
use embree::Rays16;
use glam::Vec3;
use world::World;
use world::shadow::Engine;

/// Visibility of a VPL from a single point.
pub trait Visibility {
    /// True if nothing lies between the surface point `x` with geometric normal `normal` and the VPL, which
    /// represents `node`.
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> bool;

    /// Transmittance of the thin sheets between the point and a visible VPL.
    fn transmittance(&self, _x: Vec3, _normal: Vec3, _vpl: &Vpl, _node: &LightNode) -> Rgb {
        Rgb::ONE
    }
}

/// Visibility of a VPL from the points of a packet.
pub trait PacketVisibility {
    /// Returns the lanes of `lanes` that see the VPL, which represents `node`.
    fn visible16(&self, receivers: &ReceiverPacket, lanes: u16, vpl: &Vpl, node: &LightNode) -> u16;

    /// Multiplies the `light` in `lanes`, which see the VPL, by the transmittance of the thin sheets on its way.
    fn attenuate16(
        &self,
        _receivers: &ReceiverPacket,
        _lanes: u16,
        _vpl: &Vpl,
        _node: &LightNode,
        _light: &mut Vec3x16,
    ) {
    }
}

/// Visibility along rays to VPLs, one VPL per ray.
pub trait RayVisibility {
    /// Returns the lanes of the first `count` whose rays are not occluded. Multiplies their `light` by the
    /// transmittance of the thin sheets on its way.
    fn arriving16(&self, rays: &Rays16, count: usize, light: &mut Vec3x16) -> u16;
}

impl Visibility for Engine<'_> {
    #[inline]
    fn visible(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> bool {
        !self.occluded(&to_vpl(x, normal, vpl, node.kind()), node.representative() as u32)
    }

    #[inline]
    fn transmittance(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> Rgb {
        match self.world().has_sheets() {
            true => self.world().transmittance(&to_vpl(x, normal, vpl, node.kind())),
            false => Rgb::ONE,
        }
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
        vpl: &Vpl,
        node: &LightNode,
        light: &mut Vec3x16,
    ) {
        if self.world().has_sheets() {
            let rays = receivers.shadow_rays(vpl, node.kind());
            let attenuate = |lane, transmittance| light.set(lane, light.get(lane) * transmittance);
            self.world().transmittance16(&rays, lanes, u32::MAX, attenuate);
        }
    }
}

impl RayVisibility for Engine<'_> {
    #[inline]
    fn arriving16(&self, rays: &Rays16, count: usize, light: &mut Vec3x16) -> u16 {
        let lanes = first_lanes(count);
        let free = lanes & !self.occluded16(rays, lanes);
        if self.world().has_sheets() {
            let attenuate = |lane, transmittance| light.set(lane, light.get(lane) * transmittance);
            self.world().transmittance16(rays, free, u32::MAX, attenuate);
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
    fn transmittance(&self, x: Vec3, normal: Vec3, vpl: &Vpl, node: &LightNode) -> Rgb {
        Visibility::transmittance(&Engine::new(self), x, normal, vpl, node)
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
        vpl: &Vpl,
        node: &LightNode,
        light: &mut Vec3x16,
    ) {
        Engine::new(self).attenuate16(receivers, lanes, vpl, node, light)
    }
}

impl RayVisibility for World {
    #[inline]
    fn arriving16(&self, rays: &Rays16, count: usize, light: &mut Vec3x16) -> u16 {
        Engine::new(self).arriving16(rays, count, light)
    }
}
