//! Occlusion by packets of any width that Embree has, and the barest loop over rays of each width.
//!
//! [`Accel::occluded_by`] is what a renderer calls. [`Prepared`] is the yardstick to judge it by: rays laid out as the
//! library takes them, copied (a query writes to them) and traced, with nothing around it.

use super::packet::{LANE_IDS, Lanes, query_flags};
use super::{Accel, Rays16};
use embree4_sys as sys;

/// Rays of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Width {
    /// One: `rtcOccluded1`.
    One,
    /// `rtcOccluded4`.
    Four,
    /// `rtcOccluded8`.
    Eight,
    /// `rtcOccluded16`.
    Sixteen,
}

impl Width {
    /// All, the narrowest first.
    pub const ALL: [Width; 4] = [Width::One, Width::Four, Width::Eight, Width::Sixteen];

    /// How many rays.
    pub fn rays(self) -> usize {
        match self {
            Width::One => 1,
            Width::Four => 4,
            Width::Eight => 8,
            Width::Sixteen => 16,
        }
    }
}

/// A packet of Embree's.
trait Packet: Copy {
    /// Lanes `first..first + width` of sixteen.
    fn of(rays: &Rays16, first: usize) -> Self;
    /// Traces the lanes that `lanes` says, and returns those found occluded as bits from 0 on.
    ///
    /// # Safety
    /// The scene is committed, and `lanes` is as long as the packet is wide and as aligned as the packet.
    unsafe fn occluded(
        self,
        lanes: *const i32,
        scene: sys::RTCScene,
        arguments: &mut sys::RTCOccludedArguments,
    ) -> u16;
}

macro_rules! packet {
    ($packet:ident, $width:literal, $query:ident) => {
        impl Packet for sys::$packet {
            #[inline(always)]
            fn of(rays: &Rays16, first: usize) -> Self {
                // Whole vectors, for Embree reads them so.
                fn part<T: Copy + Default>(row: &[T; 16], first: usize) -> [T; $width] {
                    let mut part = [T::default(); $width];
                    part.copy_from_slice(&row[first..first + $width]);
                    part
                }
                let row = |row: &[f32; 16]| part(row, first);
                sys::$packet {
                    org_x: row(&rays.origin_x),
                    org_y: row(&rays.origin_y),
                    org_z: row(&rays.origin_z),
                    tnear: row(&rays.t_near),
                    dir_x: row(&rays.direction_x),
                    dir_y: row(&rays.direction_y),
                    dir_z: row(&rays.direction_z),
                    time: [0.0; $width],
                    tfar: row(&rays.t_far),
                    mask: part(&rays.mask, first),
                    id: part(&LANE_IDS, first),
                    flags: [0; $width],
                }
            }

            #[inline(always)]
            unsafe fn occluded(
                mut self,
                lanes: *const i32,
                scene: sys::RTCScene,
                arguments: &mut sys::RTCOccludedArguments,
            ) -> u16 {
                // SAFETY: by contract; the packet has its type's alignment, which is what Embree asks for.
                unsafe { sys::$query(lanes, scene, &mut self, arguments) };
                let mut bits = [0u32; $width];
                for (i, bit) in bits.iter_mut().enumerate() {
                    *bit = if self.tfar[i] == f32::NEG_INFINITY { 1 << i } else { 0 };
                }
                bits.into_iter().fold(0, |mask, bit| mask | bit) as u16
            }
        }
    };
}

packet!(RTCRay4, 4, rtcOccluded4);
packet!(RTCRay8, 8, rtcOccluded8);
packet!(RTCRay16, 16, rtcOccluded16);

fn arguments(coherent: bool) -> sys::RTCOccludedArguments {
    sys::RTCOccludedArguments {
        flags: query_flags(coherent),
        feature_mask: sys::RTC_FEATURE_FLAG_ALL,
        context: std::ptr::null_mut(),
        filter: None,
        occluded: None,
    }
}

impl Accel {
    /// [`Accel::occluded16`] by queries of `width` rays.
    #[inline]
    pub fn occluded_by(&self, width: Width, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        match width {
            Width::One => crate::math::lanes_in(valid)
                .filter(|&lane| self.occluded_masked(&rays.get(lane), rays.mask[lane]))
                .fold(0, |occluded, lane| occluded | 1 << lane),
            Width::Four => self.occluded_in::<sys::RTCRay4>(4, rays, valid, coherent),
            Width::Eight => self.occluded_in::<sys::RTCRay8>(8, rays, valid, coherent),
            Width::Sixteen => self.occluded16(rays, valid, coherent),
        }
    }

    #[inline]
    fn occluded_in<P: Packet>(&self, width: usize, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        if self.is_empty() {
            return 0;
        }
        let lanes = rays.lanes(valid);
        let mut arguments = arguments(coherent);
        let mut occluded = 0;
        for first in (0..16).step_by(width) {
            let part = &lanes.0[first..first + width];
            if part.iter().any(|&lane| lane != 0) {
                // SAFETY: the scene is committed; the mask is 64-byte aligned as a whole, and so its parts of
                // 4 and 8 words as the packets of that width.
                let found =
                    unsafe { P::of(rays, first).occluded(part.as_ptr(), self.scene(), &mut arguments) };
                occluded |= found << first;
            }
        }
        // Lanes that were not traced keep a `t_far` that may be minus infinity.
        occluded & lanes.mask_where(|_| true)
    }
}

/// Rays as queries of one width take them.
pub struct Prepared(Form);

enum Form {
    One(Vec<sys::RTCRay>),
    Four(Vec<(Lanes, sys::RTCRay4)>),
    Eight(Vec<(Lanes, sys::RTCRay8)>),
    Sixteen(Vec<(Lanes, sys::RTCRay16)>),
}

impl Prepared {
    /// The rays in the given lanes of `packets`, in their order; narrower packets are cut from them, and those
    /// without a ray to be traced left out.
    pub fn new<'a>(packets: impl IntoIterator<Item = (&'a Rays16, u16)>, width: Width) -> Prepared {
        let packets = packets.into_iter();
        Prepared(match width {
            Width::One => Form::One(
                packets
                    .flat_map(|(rays, valid)| {
                        let valid = rays.lanes(valid).mask_where(|_| true);
                        crate::math::lanes_in(valid).filter_map(|i| rays.get(i).to_embree(rays.mask[i]))
                    })
                    .collect(),
            ),
            Width::Four => Form::Four(prepare(packets, 4)),
            Width::Eight => Form::Eight(prepare(packets, 8)),
            Width::Sixteen => Form::Sixteen(prepare(packets, 16)),
        })
    }

    /// How many queries they make.
    pub fn queries(&self) -> usize {
        match &self.0 {
            Form::One(rays) => rays.len(),
            Form::Four(packets) => packets.len(),
            Form::Eight(packets) => packets.len(),
            Form::Sixteen(packets) => packets.len(),
        }
    }

    /// Traces them all; how many are occluded.
    pub fn occluded(&self, accel: &Accel, coherent: bool) -> u64 {
        if accel.is_empty() {
            return 0;
        }
        match &self.0 {
            Form::One(rays) => {
                let mut arguments = arguments(coherent);
                let mut occluded = 0;
                for ray in rays {
                    let mut ray = *ray;
                    // SAFETY: the scene is committed; ray and arguments are ours, outlive the call, and have
                    // the library's layout.
                    unsafe { sys::rtcOccluded1(accel.scene(), &mut ray, &mut arguments) };
                    occluded += u64::from(ray.tfar == f32::NEG_INFINITY);
                }
                occluded
            }
            Form::Four(packets) => trace(packets, accel, coherent),
            Form::Eight(packets) => trace(packets, accel, coherent),
            Form::Sixteen(packets) => trace(packets, accel, coherent),
        }
    }
}

/// Cuts packets of sixteen into ones of `width`, each with the mask of its lanes.
fn prepare<'a, P: Packet>(packets: impl Iterator<Item = (&'a Rays16, u16)>, width: usize) -> Vec<(Lanes, P)> {
    let mut prepared = Vec::new();
    for (rays, valid) in packets {
        let all = rays.lanes(valid);
        for first in (0..16).step_by(width) {
            let mut lanes = Lanes([0; 16]);
            lanes.0[..width].copy_from_slice(&all.0[first..first + width]);
            if lanes.any() {
                prepared.push((lanes, P::of(rays, first)));
            }
        }
    }
    prepared
}

fn trace<P: Packet>(packets: &[(Lanes, P)], accel: &Accel, coherent: bool) -> u64 {
    let mut arguments = arguments(coherent);
    let mut occluded = 0;
    for (lanes, packet) in packets {
        // SAFETY: the scene is committed, and the mask is 64-byte aligned and of sixteen words.
        let found = unsafe { packet.occluded(lanes.0.as_ptr(), accel.scene(), &mut arguments) };
        occluded += u64::from(found.count_ones());
    }
    occluded
}
