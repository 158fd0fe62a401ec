//! Queries of packets.
//!
//! The speed of a packet depends on its rays. With the `coherent` hint, rays from neighbouring points towards one light
//! are faster than single rays; unrelated rays are slower. Coherent packets should start at the receivers. A packet
//! that fans out from the light loses about 1e-4 of its hits.

use super::numbers::PlacedNumbers;
use super::packet::LANE_IDS;
use super::ray::{ALL_GEOMETRY, OCCLUDING};
use super::{Accel, Hits16, Rays16, Width};
use base::stats::meter::{self, Query};
use embree4_sys as sys;
use std::mem::MaybeUninit;

/// Returns the query flags of a coherence hint.
#[inline]
pub(super) fn query_flags(coherent: bool) -> sys::RTCRayQueryFlags {
    if coherent { sys::RTC_RAY_QUERY_FLAG_COHERENT } else { sys::RTC_RAY_QUERY_FLAG_INCOHERENT }
}

/// Returns the arguments of an occlusion query without a filter.
#[inline]
pub(super) fn occluded_arguments(coherent: bool) -> sys::RTCOccludedArguments {
    sys::RTCOccludedArguments {
        flags: query_flags(coherent),
        feature_mask: sys::RTC_FEATURE_FLAG_ALL,
        context: std::ptr::null_mut(),
        filter: None,
        occluded: None,
    }
}

/// Returns the arguments of a closest-hit query, without a filter.
#[inline(always)]
pub(super) fn intersect_arguments(coherent: bool) -> sys::RTCIntersectArguments {
    sys::RTCIntersectArguments {
        flags: query_flags(coherent),
        feature_mask: sys::RTC_FEATURE_FLAG_ALL,
        context: std::ptr::null_mut(),
        filter: None,
        intersect: None,
    }
}

/// Returns the number of lanes of a mask.
fn traced(lanes: &[i32]) -> u32 {
    lanes.iter().filter(|&&lane| lane != 0).count() as u32
}

/// A packet in Embree's own layout.
pub(super) trait EmbreePacket: Copy {
    /// Returns lanes `first..first + width` of sixteen as a packet; `mask` selects the meshes to query.
    fn of(rays: &Rays16, first: usize, mask: u32) -> Self;
    /// Traces the lanes of the mask `lanes`; returns the occluded ones as bits from 0 on.
    ///
    /// # Safety
    /// The scene must be committed. `lanes` must be as long as the packet is wide, and as aligned as the packet.
    /// Filters in the arguments must fit their context, which must outlive the call.
    unsafe fn occluded(
        self,
        lanes: *const i32,
        scene: sys::RTCScene,
        arguments: &mut sys::RTCOccludedArguments,
    ) -> u16;
    /// Traces the lanes of the mask `lanes`, and writes hits from a lane on; returns the lanes with hits as bits from 0
    /// on.
    ///
    /// # Safety
    /// See [`EmbreePacket::occluded`].
    unsafe fn closest_hit(
        self,
        lanes: *const i32,
        scene: sys::RTCScene,
        arguments: &mut sys::RTCIntersectArguments,
        to: HitLanes,
    ) -> u16;
}

/// Lanes to which a packet writes its hits.
pub(super) struct HitLanes<'a> {
    pub hits: &'a mut Hits16,
    /// Lane of the packet's lane 0.
    pub first: usize,
    /// Numbering of the meshes, if there are groups.
    pub numbers: Option<&'a PlacedNumbers>,
}

macro_rules! packet {
    ($packet:ident, $hit:ident, $both:ident, $width:literal, $occluded:ident, $intersect:ident) => {
        impl EmbreePacket for sys::$packet {
            #[inline(always)]
            fn of(rays: &Rays16, first: usize, mask: u32) -> Self {
                // Whole vectors are copied, as Embree reads them.
                #[inline(always)]
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
                    mask: [mask; $width],
                    id: part(&LANE_IDS, first),
                    flags: [0; $width],
                }
            }

            #[inline(always)]
            unsafe fn occluded(
                self,
                lanes: *const i32,
                scene: sys::RTCScene,
                arguments: &mut sys::RTCOccludedArguments,
            ) -> u16 {
                // The packet is followed by room for hits. Without kernels of this width, Embree copies single rays out
                // of the packet and back as if hits followed it.
                let mut both = MaybeUninit::<sys::$both>::uninit();
                let mut bits = [0u32; $width];
                // SAFETY: by contract. The packet is written before it is read, has its type's alignment, which Embree
                // requires, and the pointer is to all of `both`.
                unsafe {
                    let packet = &raw mut (*both.as_mut_ptr()).ray;
                    packet.write(self);
                    sys::$occluded(lanes, scene, packet, arguments);
                    for (i, bit) in bits.iter_mut().enumerate() {
                        *bit = if (*packet).tfar[i] == f32::NEG_INFINITY { 1 << i } else { 0 };
                    }
                }
                bits.into_iter().fold(0, |mask, bit| mask | bit) as u16
            }

            #[inline(always)]
            unsafe fn closest_hit(
                self,
                lanes: *const i32,
                scene: sys::RTCScene,
                arguments: &mut sys::RTCIntersectArguments,
                HitLanes { hits, first, numbers }: HitLanes,
            ) -> u16 {
                const NONE: [u32; $width] = [sys::RTC_INVALID_GEOMETRY_ID; $width];
                let mut both = sys::$both {
                    ray: self,
                    hit: sys::$hit {
                        Ng_x: [0.0; $width],
                        Ng_y: [0.0; $width],
                        Ng_z: [0.0; $width],
                        u: [0.0; $width],
                        v: [0.0; $width],
                        primID: NONE,
                        geomID: NONE,
                        instID: [NONE],
                        instPrimID: [NONE],
                    },
                };
                // SAFETY: by contract; the packet has its type's alignment, which Embree requires.
                unsafe { sys::$intersect(lanes, scene, &mut both, arguments) };
                let mut bits = [0u32; $width];
                for (i, bit) in bits.iter_mut().enumerate() {
                    *bit = if both.hit.geomID[i] == sys::RTC_INVALID_GEOMETRY_ID { 0 } else { 1 << i };
                }
                let found = bits.into_iter().fold(0, |mask, bit| mask | bit);
                for i in 0..$width {
                    if (found >> i) & 1 != 0 {
                        hits.t[first + i] = both.ray.tfar[i];
                        hits.u[first + i] = both.hit.u[i];
                        hits.v[first + i] = both.hit.v[i];
                        hits.geometry[first + i] = both.hit.geomID[i];
                        hits.primitive[first + i] = both.hit.primID[i];
                    }
                }
                if let Some(numbers) = numbers {
                    let [instance, place] = [&both.hit.instID[0], &both.hit.instPrimID[0]];
                    for i in base::math::lanes_in(found as u16) {
                        hits.geometry[first + i] = numbers.number(both.hit.geomID[i], instance[i], place[i]);
                    }
                }
                found as u16
            }
        }
    };
}

packet!(RTCRay4, RTCHit4, RTCRayHit4, 4, rtcOccluded4, rtcIntersect4);
packet!(RTCRay8, RTCHit8, RTCRayHit8, 8, rtcOccluded8, rtcIntersect8);
packet!(RTCRay16, RTCHit16, RTCRayHit16, 16, rtcOccluded16, rtcIntersect16);

impl Accel {
    /// Traces the lanes in `valid` like [`Accel::closest_hit`]; returns the lanes with hits, and writes these to
    /// `hits`.
    ///
    /// `coherent` is a hint that origins and directions are similar. It may change the last bits and the speed.
    #[inline]
    pub fn closest_hit16(&self, rays: &Rays16, valid: u16, coherent: bool, hits: &mut Hits16) -> u16 {
        match self.widest() {
            Width::Sixteen => self.closest_hit_in::<sys::RTCRay16>(16, rays, valid, coherent, hits),
            Width::Eight => self.closest_hit_in::<sys::RTCRay8>(8, rays, valid, coherent, hits),
            _ => self.closest_hit_in::<sys::RTCRay4>(4, rays, valid, coherent, hits),
        }
    }

    #[inline]
    fn closest_hit_in<P: EmbreePacket>(
        &self,
        width: usize,
        rays: &Rays16,
        valid: u16,
        coherent: bool,
        hits: &mut Hits16,
    ) -> u16 {
        if self.is_empty() {
            return 0;
        }
        let mut arguments = intersect_arguments(coherent);
        let kind = if coherent { Query::CoherentHits } else { Query::Hits };
        let lanes = rays.lanes(valid);
        let mut found = 0;
        for first in (0..16).step_by(width) {
            let part = &lanes.0[first..first + width];
            if part.iter().any(|&lane| lane != 0) {
                let packet = P::of(rays, first, ALL_GEOMETRY);
                let to = HitLanes { hits: &mut *hits, first, numbers: self.placed_numbers() };
                // SAFETY: the scene is committed; mask, packet and arguments are ours, outlive the call and have the
                // library's layout (the version is checked). The mask is 64-byte aligned as a whole, and so its parts
                // of 4 and 8 words as the packets of that width.
                let trace = || unsafe { packet.closest_hit(part.as_ptr(), self.scene(), &mut arguments, to) };
                let bits = meter::query(kind, || traced(part), trace);
                found |= bits << first;
            }
        }
        found
    }

    /// Returns the lanes in `valid` that are occluded; see [`Accel::occluded`], and [`Accel::closest_hit16`] for
    /// `coherent`.
    #[inline]
    pub fn occluded16(&self, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        self.occluded_by(self.widest(), rays, valid, coherent)
    }

    /// Does [`Accel::occluded16`] with queries of `width` rays.
    #[inline]
    pub fn occluded_by(&self, width: Width, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        match width {
            Width::One => base::math::lanes_in(valid)
                .filter(|&lane| self.occluded(&rays.get(lane)))
                .fold(0, |occluded, lane| occluded | 1 << lane),
            // SAFETY: the arguments have no filter.
            _ => unsafe { self.occluded_with(width, rays, valid, &mut occluded_arguments(coherent)) },
        }
    }

    /// Returns the lanes that queries of `width` rays, at least four, find occluded.
    ///
    /// # Safety
    /// Filters in the arguments must fit their context, which must outlive the call.
    #[inline]
    pub(super) unsafe fn occluded_with(
        &self,
        width: Width,
        rays: &Rays16,
        valid: u16,
        arguments: &mut sys::RTCOccludedArguments,
    ) -> u16 {
        // SAFETY: by contract.
        unsafe {
            match width {
                Width::Sixteen => self.occluded_in::<sys::RTCRay16>(16, rays, valid, arguments),
                Width::Eight => self.occluded_in::<sys::RTCRay8>(8, rays, valid, arguments),
                _ => self.occluded_in::<sys::RTCRay4>(4, rays, valid, arguments),
            }
        }
    }

    /// Returns the occluded lanes of queries of packets of type `P`.
    ///
    /// # Safety
    /// See [`Accel::occluded_with`].
    #[inline]
    unsafe fn occluded_in<P: EmbreePacket>(
        &self,
        width: usize,
        rays: &Rays16,
        valid: u16,
        arguments: &mut sys::RTCOccludedArguments,
    ) -> u16 {
        if self.is_empty() {
            return 0;
        }
        let lanes = rays.lanes(valid);
        let mut occluded = 0;
        for first in (0..16).step_by(width) {
            let part = &lanes.0[first..first + width];
            if part.iter().any(|&lane| lane != 0) {
                let packet = P::of(rays, first, OCCLUDING);
                // SAFETY: the scene is committed; the mask is 64-byte aligned as a whole, and so its parts of
                // 4 and 8 words as the packets of that width; the rest by contract.
                let trace = || unsafe { packet.occluded(part.as_ptr(), self.scene(), arguments) };
                let found = meter::query(Query::Shadows, || traced(part), trace);
                occluded |= found << first;
            }
        }
        // Lanes that were not traced keep a `t_far` that may be -inf.
        occluded & lanes.mask_where(|_| true)
    }
}
