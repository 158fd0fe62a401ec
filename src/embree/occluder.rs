//! Occlusion queries that also say which triangle was in the way, and at what distance.
//!
//! `rtcOccluded` reports neither, so a filter passed with the query records each candidate it accepts
//! in a record behind Embree's query context. It can reject candidates too: that is how the triangles
//! at the two ends of a shadow ray are left out. It costs a few per cent against the plain query.
//!
//! The occluder is the first that the traversal came upon, not the closest: which one it is may differ
//! between a packet and a single ray, and with the packet's other lanes.

use super::packet::query_flags;
use super::{ALL_GEOMETRY, Accel, Ray, Rays16};
use embree4_sys as sys;

/// Names a triangle of an [`Accel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TriangleId {
    /// Index of the mesh.
    pub geometry: u32,
    /// Index of the triangle in that mesh.
    pub primitive: u32,
}

impl TriangleId {
    /// No triangle.
    pub const NONE: TriangleId = TriangleId { geometry: u32::MAX, primitive: u32::MAX };
}

/// A triangle found in the way of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// Ray parameter where the ray meets it.
    pub t: f32,
    /// Index of the mesh.
    pub geometry: u32,
    /// Index of the triangle in that mesh.
    pub primitive: u32,
}

impl Occluder {
    /// Which triangle.
    #[inline]
    pub fn id(&self) -> TriangleId {
        TriangleId { geometry: self.geometry, primitive: self.primitive }
    }
}

/// The occluders of sixteen rays. Lanes that are not occluded are left as they were.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Occluders16 {
    /// Ray parameters.
    pub t: [f32; 16],
    /// Indices of the meshes.
    pub geometry: [u32; 16],
    /// Indices of the triangles in their meshes.
    pub primitive: [u32; 16],
}

/// Two triangles for each of sixteen rays that do not occlude it: those that its ends lie on.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Skip16 {
    geometry: [[u32; 16]; 2],
    primitive: [[u32; 16]; 2],
}

impl Default for Skip16 {
    fn default() -> Skip16 {
        Skip16 { geometry: [[u32::MAX; 16]; 2], primitive: [[u32::MAX; 16]; 2] }
    }
}

impl Skip16 {
    /// Sets both triangles of a lane; [`TriangleId::NONE`] for none.
    ///
    /// # Panics
    /// If `lane` is 16 or more.
    #[inline]
    pub fn set(&mut self, lane: usize, skip: [TriangleId; 2]) {
        for (end, id) in skip.into_iter().enumerate() {
            self.geometry[end][lane] = id.geometry;
            self.primitive[end][lane] = id.primitive;
        }
    }

    /// Both triangles of a lane.
    ///
    /// # Panics
    /// If `lane` is 16 or more.
    #[inline]
    pub fn get(&self, lane: usize) -> [TriangleId; 2] {
        [0, 1].map(|end| TriangleId {
            geometry: self.geometry[end][lane],
            primitive: self.primitive[end][lane],
        })
    }
}

/// What the filters find behind `RTCFilterFunctionNArguments::context`.
#[repr(C)]
struct Query<Record> {
    context: sys::RTCRayQueryContext,
    record: Record,
}

impl<Record> Query<Record> {
    /// The query's arguments, with `filter` to be called for every candidate. They point into `self`.
    #[inline]
    fn arguments(
        &mut self,
        coherent: bool,
        filter: unsafe extern "C" fn(*const sys::RTCFilterFunctionNArguments),
    ) -> sys::RTCOccludedArguments {
        sys::RTCOccludedArguments {
            flags: query_flags(coherent) | sys::RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER,
            feature_mask: sys::RTC_FEATURE_FLAG_ALL,
            context: (&raw mut *self).cast(),
            filter: Some(filter),
            occluded: None,
        }
    }
}

const CONTEXT: sys::RTCRayQueryContext = sys::RTCRayQueryContext {
    instID: [sys::RTC_INVALID_GEOMETRY_ID],
    instPrimID: [sys::RTC_INVALID_GEOMETRY_ID],
};

struct Record1 {
    skip: [TriangleId; 2],
    found: Occluder,
}

struct Record16<'a> {
    skip: &'a Skip16,
    found: &'a mut Occluders16,
}

/// Word offsets, times the packet's size, of what the filters read from `RTCRayN` and `RTCHitN`.
mod word {
    pub const RAY_T_FAR: usize = 8;
    pub const RAY_ID: usize = 10;
    pub const HIT_PRIMITIVE: usize = 5;
    pub const HIT_GEOMETRY: usize = 6;
}

impl Accel {
    /// As [`Accel::occluded`], and says by what.
    #[inline]
    pub fn occluder(&self, ray: &Ray) -> Option<Occluder> {
        self.occluder_except(ray, [TriangleId::NONE; 2], ALL_GEOMETRY)
    }

    /// As [`Accel::occluder`], among meshes whose mask has a bit of `mask`, and without the two
    /// triangles in `skip`.
    #[inline]
    pub fn occluder_except(&self, ray: &Ray, skip: [TriangleId; 2], mask: u32) -> Option<Occluder> {
        let mut shadow_ray = ray.to_embree(mask).filter(|_| !self.is_empty())?;
        let found = Occluder { t: 0.0, geometry: u32::MAX, primitive: u32::MAX };
        let mut query = Query { context: CONTEXT, record: Record1 { skip, found } };
        let mut arguments = query.arguments(false, record_occluder);
        // SAFETY: the scene is committed; ray, arguments and the query they point to are ours, outlive
        // the call and have the library's layout; the filter fits the query's record.
        unsafe { sys::rtcOccluded1(self.scene(), &mut shadow_ray, &mut arguments) };
        (shadow_ray.tfar == f32::NEG_INFINITY).then_some(query.record.found)
    }

    /// As [`Accel::occluded16`], and says by what: the returned lanes of `found` are written.
    #[inline]
    pub fn occluders16(&self, rays: &Rays16, valid: u16, coherent: bool, found: &mut Occluders16) -> u16 {
        self.occluders16_except(rays, valid, coherent, &Skip16::default(), found)
    }

    /// As [`Accel::occluders16`], without the two triangles that `skip` names for each lane.
    #[inline]
    pub fn occluders16_except(
        &self,
        rays: &Rays16,
        valid: u16,
        coherent: bool,
        skip: &Skip16,
        found: &mut Occluders16,
    ) -> u16 {
        let lanes = rays.lanes(valid);
        if self.is_empty() || !lanes.any() {
            return 0;
        }
        let mut query = Query { context: CONTEXT, record: Record16 { skip, found } };
        let mut arguments = query.arguments(coherent, record_occluders);
        let mut packet = rays.to_embree();
        // SAFETY: as above; mask and packet have the 64-byte alignment that is asked for.
        unsafe { sys::rtcOccluded16(lanes.0.as_ptr(), self.scene(), &mut packet, &mut arguments) };
        lanes.mask_where(|i| packet.tfar[i] == f32::NEG_INFINITY)
    }
}

/// The filter of a single ray.
///
/// # Safety
/// For Embree to call during a query whose context is the head of a `Query<Record1>`.
unsafe extern "C" fn record_occluder(arguments: *const sys::RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments for packets of N = 1: one lane of the mask, a ray and a hit
    // of the word offsets above. The context is the one that the query was given, alive and not
    // borrowed by anybody while the query runs on this thread.
    unsafe {
        let arguments = &*arguments;
        let record = &mut (*arguments.context.cast::<Query<Record1>>()).record;
        let hit = arguments.hit.cast::<u32>();
        let (geometry, primitive) = (*hit.add(word::HIT_GEOMETRY), *hit.add(word::HIT_PRIMITIVE));
        if record.skip.contains(&TriangleId { geometry, primitive }) {
            *arguments.valid = 0;
        } else {
            let t = *arguments.ray.cast::<f32>().add(word::RAY_T_FAR);
            record.found = Occluder { t, geometry, primitive };
        }
    }
}

/// The filter of a packet of sixteen. It handles all lanes alike and blends, so that it compiles to
/// vector instructions; a loop over the valid lanes costs several times as much.
///
/// # Safety
/// For Embree to call during a query whose context is the head of a `Query<Record16>` and whose rays
/// carry their lane as their id.
unsafe extern "C" fn record_occluders(arguments: *const sys::RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments; the context is the one that the query was given, alive and
    // not borrowed by anybody while the query runs on this thread.
    let (arguments, record) = unsafe {
        let arguments = &*arguments;
        (arguments, &mut (*arguments.context.cast::<Query<Record16>>()).record)
    };
    let n = arguments.N as usize;
    if n != 16 {
        // SAFETY: as above.
        return unsafe { record_split_packet(arguments, record) };
    }
    // SAFETY: with N = 16, mask, ray and hit are arrays of 16 words at these offsets, none of which
    // overlaps our record. The mask's words are 0 or -1.
    let (valid, t, geometry, primitive) = unsafe {
        (
            &mut *arguments.valid.cast::<[u32; 16]>(),
            &*arguments.ray.cast::<f32>().add(16 * word::RAY_T_FAR).cast::<[f32; 16]>(),
            &*arguments.hit.cast::<u32>().add(16 * word::HIT_GEOMETRY).cast::<[u32; 16]>(),
            &*arguments.hit.cast::<u32>().add(16 * word::HIT_PRIMITIVE).cast::<[u32; 16]>(),
        )
    };
    let (skip, found) = (record.skip, &mut *record.found);
    for i in 0..16 {
        // Zero where the triangle is the one to be skipped.
        let differs =
            |end: usize| (geometry[i] ^ skip.geometry[end][i]) | (primitive[i] ^ skip.primitive[end][i]);
        valid[i] &= u32::from((differs(0) != 0) & (differs(1) != 0)).wrapping_neg();
    }
    let accepted = *valid;
    for i in 0..16 {
        found.t[i] = f32::from_bits(blend(accepted[i], t[i].to_bits(), found.t[i].to_bits()));
    }
    for i in 0..16 {
        found.geometry[i] = blend(accepted[i], geometry[i], found.geometry[i]);
    }
    for i in 0..16 {
        found.primitive[i] = blend(accepted[i], primitive[i], found.primitive[i]);
    }
}

/// `new` where the mask is all ones, `old` where it is zero.
#[inline]
fn blend(mask: u32, new: u32, old: u32) -> u32 {
    (mask & new) | (!mask & old)
}

/// The same where Embree has no sixteen-wide kernels and traces the rays of the packet one by one, or
/// in smaller packets: the lane is then the ray's id.
///
/// # Safety
/// As for [`record_occluders`], from which it is called.
unsafe fn record_split_packet(arguments: &sys::RTCFilterFunctionNArguments, record: &mut Record16) {
    let n = arguments.N as usize;
    let (ray, hit) = (arguments.ray.cast::<u32>(), arguments.hit.cast::<u32>());
    for i in 0..n {
        // SAFETY: mask, ray and hit have n lanes of words at these offsets.
        let (lane, t, geometry, primitive) = unsafe {
            if *arguments.valid.add(i) == 0 {
                continue;
            }
            (
                *ray.add(word::RAY_ID * n + i) as usize & 15,
                f32::from_bits(*ray.add(word::RAY_T_FAR * n + i)),
                *hit.add(word::HIT_GEOMETRY * n + i),
                *hit.add(word::HIT_PRIMITIVE * n + i),
            )
        };
        let (skip, found) = (record.skip, &mut *record.found);
        if (0..2).any(|end| skip.geometry[end][lane] == geometry && skip.primitive[end][lane] == primitive) {
            // SAFETY: as above.
            unsafe { *arguments.valid.add(i) = 0 };
        } else {
            found.t[lane] = t;
            found.geometry[lane] = geometry;
            found.primitive[lane] = primitive;
        }
    }
}
