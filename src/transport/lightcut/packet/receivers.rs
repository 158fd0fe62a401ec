//! Receivers of a packet, lane by lane.

use crate::lightcut::{Receiver, Visibility, to_vpl};
use crate::lights::{LightNode, LightTrees, Vpl, VplKind};
use base::math::{F32x16, Frame, LANES, LUMINANCE, Rgb, V3, Vec3x16, f32x16, first_lanes, lanes_in};
use embree::Rays16;
use world::material::AlikeBsdfs16;

/// Up to sixteen receivers as a structure of arrays.
///
/// Lanes without a receiver repeat the first receiver and are masked.
#[derive(Default)]
pub struct ReceiverPacket<'m> {
    receivers: Vec<Receiver<'m>>,
    /// Lanes that hold a receiver.
    pub(in crate::lightcut) valid: u16,
    /// Lanes whose material is not just Lambertian.
    pub(in crate::lightcut) general: u16,
    /// Materials of the general lanes, if they have equal lobes. Otherwise responses and bounds are computed one by
    /// one.
    pub(in crate::lightcut) glossy: Option<AlikeBsdfs16<'m>>,
    pub(in crate::lightcut) position: Vec3x16,
    /// Maximum absolute coordinate of any position.
    pub(in crate::lightcut) reach: f32,
    pub(in crate::lightcut) geometric_normal: Vec3x16,
    /// Shading frames.
    pub(in crate::lightcut) frame: Frames16,
    /// Frames about the mirror direction of the direction to the eye.
    pub(in crate::lightcut) mirror: Frames16,
    /// Luminance of other reflected light.
    pub(in crate::lightcut) baseline: F32x16,
    /// Lambertian BRDF.
    pub(in crate::lightcut) brdf: Vec3x16,
    /// BRDF of the base, for light that has already passed the coat.
    pub(in crate::lightcut) base: Vec3x16,
    /// Lambertian BRDF times the weights of the luminance.
    pub(in crate::lightcut) brdf_luminance: Vec3x16,
}

impl<'m> ReceiverPacket<'m> {
    /// Creates a packet without receivers.
    pub fn new() -> ReceiverPacket<'m> {
        ReceiverPacket::default()
    }

    /// Replaces the receivers. Receivers beyond [`LANES`] are left out.
    pub fn set(&mut self, receivers: impl IntoIterator<Item = Receiver<'m>>) {
        self.receivers.clear();
        self.receivers.extend(receivers.into_iter().take(LANES));
        self.valid = first_lanes(self.receivers.len());
        (self.general, self.reach) = (0, 0.0);
        let Some(first) = self.receivers.first().copied() else { return };
        for lane in 0..LANES {
            let r = self.receivers.get(lane).copied().unwrap_or(first);
            self.reach = self.reach.max(r.position().abs().max_element());
            self.position.set(lane, r.position());
            self.geometric_normal.set(lane, r.geometric_normal());
            self.frame.set(lane, r.frame());
            self.mirror.set(lane, r.mirror());
            self.baseline[lane] = r.baseline_luminance();
            let brdf = r.lambert_brdf();
            self.general |= u16::from(brdf.is_none()) << lane & self.valid;
            let brdf = brdf.unwrap_or(Rgb::ZERO);
            self.brdf.set(lane, brdf);
            self.base.set(lane, r.base_brdf());
            self.brdf_luminance.set(lane, brdf * LUMINANCE);
        }
        let bsdf = |lane: usize| self.receivers.get(lane).and_then(Receiver::bsdf);
        let any = lanes_in(self.general).next().and_then(bsdf);
        self.glossy = any.and_then(|any| AlikeBsdfs16::new(|lane| bsdf(lane).unwrap_or(any)));
    }

    /// Number of receivers.
    pub fn len(&self) -> usize {
        self.receivers.len()
    }

    /// True if there are no receivers.
    pub fn is_empty(&self) -> bool {
        self.receivers.is_empty()
    }

    /// Returns the rays to a VPL, in all lanes.
    #[inline]
    pub fn shadow_rays(&self, vpl: &Vpl, kind: VplKind) -> Rays16 {
        to_vpl(self.position.load(), self.geometric_normal.load(), vpl, kind).into()
    }

    /// Returns the lanes of `lanes` that see the VPL, which represents `node`.
    #[inline]
    pub fn visible(&self, visibility: &impl Visibility, lanes: u16, vpl: &Vpl, node: &LightNode) -> u16 {
        let rays = self.shadow_rays(vpl, node.kind());
        visibility.visible16(&rays, lanes, Some(node.representative() as u32))
    }

    /// Multiplies the `light` in `lanes`, which see the VPL that represents `node`, by the transmittance of the thin
    /// sheets on its way.
    #[inline]
    pub fn attenuate(
        &self,
        visibility: &impl Visibility,
        lanes: u16,
        trees: &LightTrees,
        node: &LightNode,
        light: &mut Vec3x16,
    ) {
        if visibility.sheets().is_some() {
            let (vpl, before) = trees.representative(node);
            let rays = self.shadow_rays(vpl, node.kind());
            visibility.attenuate(&rays, lanes, |lane| self.get(lane).sheets(before), light);
        }
    }

    /// Returns receiver number `lane`.
    pub fn get(&self, lane: usize) -> &Receiver<'m> {
        &self.receivers[lane]
    }
}

/// Orthonormal frames, one per receiver.
#[derive(Default)]
pub(in crate::lightcut) struct Frames16 {
    /// Tangents, bitangents and normals.
    pub axes: [Vec3x16; 3],
}

impl Frames16 {
    /// Z axes.
    #[inline(always)]
    pub fn normal(&self) -> &Vec3x16 {
        &self.axes[2]
    }

    /// Axes of all frames.
    #[inline(always)]
    pub fn load(&self) -> [V3<f32x16>; 3] {
        let [x, y, z] = &self.axes;
        [x.load(), y.load(), z.load()]
    }

    fn set(&mut self, lane: usize, frame: &Frame) {
        for (i, axis) in [frame.tangent, frame.bitangent, frame.normal].into_iter().enumerate() {
            self.axes[i].set(lane, axis);
        }
    }
}
