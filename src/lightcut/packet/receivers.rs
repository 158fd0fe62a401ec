//! The points of a group, lane by lane.

use super::{LANES, Lanes};
use crate::embree::Rays16;
use crate::lightcut::Receiver;
use crate::lightcut::shadow_rays::to_vpl16;
use crate::material::AlikeBsdfs16;
use crate::math::{Frame, LUMINANCE, Rgb};
use crate::vpl::{Vpl, VplKind};
use glam::Vec3;

/// Three numbers for each point.
pub(in crate::lightcut) type Vec3Lanes = [Lanes; 3];

/// Up to sixteen reflecting points as a structure of arrays.
///
/// Lanes without a point repeat the first one's and are masked.
pub struct ReceiverPacket<'m> {
    reflectors: Vec<Receiver<'m>>,
    /// Lanes that hold a point.
    pub(in crate::lightcut) valid: u16,
    /// Lanes whose material is not just Lambert.
    pub(in crate::lightcut) general: u16,
    /// Their materials, if they are alike: else their responses and bounds are computed one by one.
    pub(in crate::lightcut) glossy: Option<AlikeBsdfs16<'m>>,
    pub(in crate::lightcut) position: Vec3Lanes,
    /// Largest coordinate of any position.
    pub(in crate::lightcut) reach: f32,
    pub(in crate::lightcut) geometric_normal: Vec3Lanes,
    /// Shading frame: tangent, bitangent, normal.
    pub(in crate::lightcut) frame: [Vec3Lanes; 3],
    /// The same, absolute values.
    pub(in crate::lightcut) abs_frame: [Vec3Lanes; 3],
    /// Frame about the mirror direction of the eye's.
    pub(in crate::lightcut) mirror: [Vec3Lanes; 3],
    /// The same, absolute values.
    pub(in crate::lightcut) abs_mirror: [Vec3Lanes; 3],
    /// Luminance known from elsewhere.
    pub(in crate::lightcut) known: Lanes,
    /// Lambert BRDF.
    pub(in crate::lightcut) brdf: Vec3Lanes,
    /// BRDF of the base, for light that has passed the coat on its way in.
    pub(in crate::lightcut) base: Vec3Lanes,
    /// Lambert BRDF by what it weighs in the luminance.
    pub(in crate::lightcut) brdf_luminance: Vec3Lanes,
}

impl<'m> ReceiverPacket<'m> {
    /// No points yet.
    pub fn new() -> ReceiverPacket<'m> {
        const ZERO: Vec3Lanes = [[0.0; LANES]; 3];
        ReceiverPacket {
            reflectors: Vec::with_capacity(LANES),
            valid: 0,
            general: 0,
            glossy: None,
            position: ZERO,
            reach: 0.0,
            geometric_normal: ZERO,
            frame: [ZERO; 3],
            abs_frame: [ZERO; 3],
            mirror: [ZERO; 3],
            abs_mirror: [ZERO; 3],
            known: [0.0; LANES],
            brdf: ZERO,
            base: ZERO,
            brdf_luminance: ZERO,
        }
    }

    /// Replaces the points; all beyond [`LANES`] are left out.
    pub fn set(&mut self, reflectors: impl IntoIterator<Item = Receiver<'m>>) {
        self.reflectors.clear();
        self.reflectors.extend(reflectors.into_iter().take(LANES));
        (self.valid, self.general, self.reach) = (0, 0, 0.0);
        let Some(first) = self.reflectors.first().copied() else { return };
        for lane in 0..LANES {
            let reflector = self.reflectors.get(lane).copied();
            if let Some(r) = &reflector {
                self.valid |= 1 << lane;
                self.general |= u16::from(r.lambert_brdf().is_none()) << lane;
            }
            let r = reflector.unwrap_or(first);
            self.reach = self.reach.max(r.position().abs().max_element());
            put(&mut self.position, lane, r.position());
            put(&mut self.geometric_normal, lane, r.geometric_normal());
            put_frame(&mut self.frame, &mut self.abs_frame, lane, r.frame());
            put_frame(&mut self.mirror, &mut self.abs_mirror, lane, r.mirror());
            self.known[lane] = r.baseline_luminance();
            let brdf = r.lambert_brdf().unwrap_or(Rgb::ZERO);
            put(&mut self.brdf, lane, brdf);
            put(&mut self.base, lane, r.base_brdf());
            put(&mut self.brdf_luminance, lane, brdf * LUMINANCE);
        }
        let bsdf = |lane: usize| self.reflectors.get(lane).and_then(Receiver::bsdf);
        let any = lanes_of(self.general).next().and_then(bsdf);
        self.glossy = any.and_then(|any| AlikeBsdfs16::new(|lane| bsdf(lane).unwrap_or(any)));
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.reflectors.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.reflectors.is_empty()
    }

    /// Rays to a virtual light, in all lanes.
    #[inline]
    pub fn shadow_rays(&self, vpl: &Vpl, kind: VplKind) -> Rays16 {
        to_vpl16(&self.position, &self.geometric_normal, vpl, kind)
    }

    /// Point number `lane`.
    pub fn get(&self, lane: usize) -> &Receiver<'m> {
        &self.reflectors[lane]
    }
}

impl Default for ReceiverPacket<'_> {
    fn default() -> Self {
        ReceiverPacket::new()
    }
}

#[inline]
fn put(lanes: &mut Vec3Lanes, lane: usize, v: Vec3) {
    for (i, row) in lanes.iter_mut().enumerate() {
        row[lane] = v[i];
    }
}

fn put_frame(axes: &mut [Vec3Lanes; 3], abs_axes: &mut [Vec3Lanes; 3], lane: usize, frame: &Frame) {
    for (i, axis) in [frame.tangent, frame.bitangent, frame.normal].into_iter().enumerate() {
        put(&mut axes[i], lane, axis);
        put(&mut abs_axes[i], lane, axis.abs());
    }
}

/// The numbers of the lanes in a mask.
#[inline]
pub(in crate::lightcut) fn lanes_of(mut mask: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (mask != 0).then(|| mask.trailing_zeros() as usize)?;
        mask &= mask - 1;
        Some(lane)
    })
}
