//! Queries of packets.
//!
//! The speed of a packet depends on the rays that share it. With the `coherent` hint, rays from neighbouring
//! points towards one light run two to three times as fast as single rays; unrelated rays run at half the
//! speed. Coherent packets should start at the receivers: a packet that starts at the light and fans out lost
//! some 1e-4 of its hits.

use super::packet::LANE_IDS;
use super::ray::{ALL_GEOMETRY, OCCLUDING};
use super::{Accel, Hits16, Rays16, Width};
use embree4_sys as sys;

/// Query flags for a coherence hint.
#[inline]
pub(super) fn query_flags(coherent: bool) -> sys::RTCRayQueryFlags {
    if coherent { sys::RTC_RAY_QUERY_FLAG_COHERENT } else { sys::RTC_RAY_QUERY_FLAG_INCOHERENT }
}

/// Arguments of an occlusion query without a filter.
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

/// A packet of Embree's own layout.
pub(super) trait EmbreePacket: Copy {
    /// Takes lanes `first..first + width` of sixteen.
    fn of(rays: &Rays16, first: usize) -> Self;
    /// Traces the lanes of the mask `lanes`, and returns those found occluded as bits from 0 on.
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
        impl EmbreePacket for sys::$packet {
            #[inline(always)]
            fn of(rays: &Rays16, first: usize) -> Self {
                // Copied as whole vectors, as Embree reads them.
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
                    mask: [OCCLUDING; $width],
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
                // SAFETY: by contract; the packet has its type's alignment, which Embree requires.
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

impl Accel {
    /// [`Accel::closest_hit`] for the lanes in `valid`. Returns the lanes that hit, and writes those of
    /// `hits`. `coherent` is a hint that origins and directions are similar: it may change the last bits and
    /// the speed, not the meaning.
    #[inline]
    pub fn closest_hit16(&self, rays: &Rays16, valid: u16, coherent: bool, hits: &mut Hits16) -> u16 {
        let lanes = rays.lanes(valid);
        if self.is_empty() || !lanes.any() {
            return 0;
        }
        const NONE: [u32; 16] = [sys::RTC_INVALID_GEOMETRY_ID; 16];
        let mut rayhit = sys::RTCRayHit16 {
            ray: rays.to_embree(ALL_GEOMETRY),
            hit: sys::RTCHit16 {
                Ng_x: [0.0; 16],
                Ng_y: [0.0; 16],
                Ng_z: [0.0; 16],
                u: [0.0; 16],
                v: [0.0; 16],
                primID: NONE,
                geomID: NONE,
                instID: [NONE],
                instPrimID: [NONE],
            },
        };
        let mut arguments = sys::RTCIntersectArguments {
            flags: query_flags(coherent),
            feature_mask: sys::RTC_FEATURE_FLAG_ALL,
            context: std::ptr::null_mut(),
            filter: None,
            intersect: None,
        };
        // SAFETY: the scene is committed; mask, packet and arguments are ours, outlive the call, have the
        // library's layout (the version is checked) and the required 64-byte alignment.
        unsafe { sys::rtcIntersect16(lanes.0.as_ptr(), self.scene(), &mut rayhit, &mut arguments) };
        let hit = &rayhit.hit;
        let found = lanes.mask_where(|i| hit.geomID[i] != sys::RTC_INVALID_GEOMETRY_ID);
        for i in 0..16 {
            if (found >> i) & 1 != 0 {
                hits.t[i] = rayhit.ray.tfar[i];
                hits.u[i] = hit.u[i];
                hits.v[i] = hit.v[i];
                hits.geometry[i] = hit.geomID[i];
                hits.primitive[i] = hit.primID[i];
            }
        }
        found
    }

    /// [`Accel::occluded`] for the lanes in `valid`. Returns those that are occluded. For `coherent`
    /// see [`Accel::closest_hit16`].
    #[inline]
    pub fn occluded16(&self, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        let lanes = rays.lanes(valid);
        if self.is_empty() || !lanes.any() {
            return 0;
        }
        let mut packet = rays.to_embree(OCCLUDING);
        let mut arguments = occluded_arguments(coherent);
        // SAFETY: as for `rtcIntersect16` above.
        unsafe { sys::rtcOccluded16(lanes.0.as_ptr(), self.scene(), &mut packet, &mut arguments) };
        lanes.mask_where(|i| packet.tfar[i] == f32::NEG_INFINITY)
    }

    /// [`Accel::occluded16`] by queries of `width` rays.
    #[inline]
    pub fn occluded_by(&self, width: Width, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        match width {
            Width::One => crate::math::lanes_in(valid)
                .filter(|&lane| self.occluded(&rays.get(lane)))
                .fold(0, |occluded, lane| occluded | 1 << lane),
            Width::Four => self.occluded_in::<sys::RTCRay4>(4, rays, valid, coherent),
            Width::Eight => self.occluded_in::<sys::RTCRay8>(8, rays, valid, coherent),
            Width::Sixteen => self.occluded16(rays, valid, coherent),
        }
    }

    #[inline]
    fn occluded_in<P: EmbreePacket>(&self, width: usize, rays: &Rays16, valid: u16, coherent: bool) -> u16 {
        if self.is_empty() {
            return 0;
        }
        let lanes = rays.lanes(valid);
        let mut arguments = occluded_arguments(coherent);
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
