//! A minimal loop over rays of each width: the baseline for benchmarks of the renderer's queries.
//!
//! Rays are stored in the library's layout, copied (a query writes to them) and traced, with no other work.

use super::packet::LaneMask;
use super::query::{EmbreePacket, occluded_arguments};
use super::ray::OCCLUDING;
use super::{Accel, Rays16, Width};
use embree4_sys as sys;

/// Rays in the layout of queries of one width.
pub struct PreparedRays(Form);

enum Form {
    One(Vec<sys::RTCRay>),
    Four(Vec<(LaneMask, sys::RTCRay4)>),
    Eight(Vec<(LaneMask, sys::RTCRay8)>),
    Sixteen(Vec<(LaneMask, sys::RTCRay16)>),
}

impl PreparedRays {
    /// Stores the rays in the given lanes of `packets`, in order, for [`PreparedRays::occluded`]. Narrower packets are
    /// cut from them. Packets without traceable rays are left out.
    pub fn new<'a>(packets: impl IntoIterator<Item = (&'a Rays16, u16)>, width: Width) -> PreparedRays {
        let packets = packets.into_iter();
        PreparedRays(match width {
            Width::One => Form::One(
                packets
                    .flat_map(|(rays, valid)| {
                        let valid = rays.lanes(valid).mask_where(|_| true);
                        base::math::lanes_in(valid).filter_map(move |i| rays.get(i).to_embree(OCCLUDING))
                    })
                    .collect(),
            ),
            Width::Four => Form::Four(prepare(packets, 4)),
            Width::Eight => Form::Eight(prepare(packets, 8)),
            Width::Sixteen => Form::Sixteen(prepare(packets, 16)),
        })
    }

    /// Returns the number of queries.
    pub fn queries(&self) -> usize {
        match &self.0 {
            Form::One(rays) => rays.len(),
            Form::Four(packets) => packets.len(),
            Form::Eight(packets) => packets.len(),
            Form::Sixteen(packets) => packets.len(),
        }
    }

    /// Traces all rays; returns the number of occluded rays.
    pub fn occluded(&self, accel: &Accel, coherent: bool) -> u64 {
        if accel.is_empty() {
            return 0;
        }
        match &self.0 {
            Form::One(rays) => {
                let mut arguments = occluded_arguments(coherent);
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

/// Cuts packets of sixteen into packets of `width`, each with the mask of its lanes.
fn prepare<'a, P: EmbreePacket>(
    packets: impl Iterator<Item = (&'a Rays16, u16)>,
    width: usize,
) -> Vec<(LaneMask, P)> {
    let mut prepared = Vec::new();
    for (rays, valid) in packets {
        let all = rays.lanes(valid);
        for first in (0..16).step_by(width) {
            let mut lanes = LaneMask([0; 16]);
            lanes.0[..width].copy_from_slice(&all.0[first..first + width]);
            if lanes.any() {
                prepared.push((lanes, P::of(rays, first, OCCLUDING)));
            }
        }
    }
    prepared
}

fn trace<P: EmbreePacket>(packets: &[(LaneMask, P)], accel: &Accel, coherent: bool) -> u64 {
    let mut arguments = occluded_arguments(coherent);
    let mut occluded = 0;
    for (lanes, packet) in packets {
        // SAFETY: the scene is committed, and the mask is 64-byte aligned and of sixteen words.
        let found = unsafe { packet.occluded(lanes.0.as_ptr(), accel.scene(), &mut arguments) };
        occluded += u64::from(found.count_ones());
    }
    occluded
}
