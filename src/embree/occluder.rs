//! Occlusion queries that also return the occluding triangle and its distance.
//!
//! `rtcOccluded` reports neither. So a filter of the query accepts and records each candidate, behind Embree's query
//! context. The cost is a few per cent.
//!
//! The occluder is the first triangle that the traversal finds, not the closest. It may differ between a packet and a
//! single ray, and with the packet's other lanes.

use super::numbers::{HitIds, Numbers, OwnNumbers, PlacedNumbers};
use super::query::query_flags;
use super::ray::OCCLUDING;
use super::{Accel, Ray, Rays16, Width};
use base::stats::meter;
use embree4_sys as sys;

/// Identifier of a triangle of an [`Accel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TriangleId {
    /// Index of the mesh.
    pub geometry: u32,
    /// Index of the triangle in that mesh.
    pub primitive: u32,
}

impl TriangleId {
    /// Id of no triangle.
    pub const NONE: TriangleId = TriangleId { geometry: u32::MAX, primitive: u32::MAX };
}

/// A triangle that occludes a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// Ray parameter of the intersection.
    pub t: f32,
    /// Index of the mesh.
    pub geometry: u32,
    /// Index of the triangle in that mesh.
    pub primitive: u32,
}

impl Occluder {
    /// Returns the identifier of the triangle.
    #[inline]
    pub fn id(&self) -> TriangleId {
        TriangleId { geometry: self.geometry, primitive: self.primitive }
    }
}

/// Occluders of sixteen rays. Lanes without occlusion stay unchanged.
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

/// Context of a query. Filters find it in `RTCFilterFunctionNArguments::context`.
#[repr(C)]
pub(super) struct Query<N, Found> {
    pub context: sys::RTCRayQueryContext,
    /// Numbering of the meshes.
    pub numbers: N,
    /// Data of the filters.
    pub found: Found,
}

impl<N, Found> Query<N, Found> {
    /// Returns the query's arguments, with `filter` for every candidate. They point into `self`.
    #[inline]
    pub fn arguments(
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

pub(super) const CONTEXT: sys::RTCRayQueryContext = sys::RTCRayQueryContext {
    instID: [sys::RTC_INVALID_GEOMETRY_ID],
    instPrimID: [sys::RTC_INVALID_GEOMETRY_ID],
};

/// Word offsets, times the packet's size, of the fields of `RTCRayN` and `RTCHitN` that filters read.
pub(super) mod word {
    pub const RAY_T_FAR: usize = 8;
    pub const RAY_ID: usize = 10;
    pub const HIT_U: usize = 3;
    pub const HIT_V: usize = 4;
    pub const HIT_PRIMITIVE: usize = 5;
    pub const HIT_GEOMETRY: usize = 6;
    pub const HIT_INSTANCE: usize = 7;
    pub const HIT_PLACE: usize = 8;
}

/// Returns where the ids of a filter's hits are.
///
/// # Safety
/// The arguments must be those that Embree passes to a filter.
#[inline(always)]
pub(super) unsafe fn ids(arguments: &sys::RTCFilterFunctionNArguments) -> HitIds {
    let (n, hit) = (arguments.N as usize, arguments.hit.cast::<u32>());
    // SAFETY: a hit of N lanes has N words at each of these offsets.
    unsafe {
        HitIds {
            geometry: hit.add(word::HIT_GEOMETRY * n),
            instance: hit.add(word::HIT_INSTANCE * n),
            place: hit.add(word::HIT_PLACE * n),
        }
    }
}

impl Accel {
    /// Returns the occluder of a ray; see [`Accel::occluded`].
    #[inline]
    pub fn occluder(&self, ray: &Ray) -> Option<Occluder> {
        match self.placed_numbers() {
            None => self.occluder_numbered(ray, OwnNumbers),
            Some(numbers) => self.occluder_numbered(ray, numbers),
        }
    }

    #[inline(always)]
    fn occluder_numbered<N: Numbers>(&self, ray: &Ray, numbers: N) -> Option<Occluder> {
        let mut shadow_ray = ray.to_embree(OCCLUDING).filter(|_| !self.is_empty())?;
        let found = Occluder { t: 0.0, geometry: u32::MAX, primitive: u32::MAX };
        let mut query = Query { context: CONTEXT, numbers, found };
        let mut arguments = query.arguments(false, record_occluder::<N>);
        // SAFETY: the scene is committed; ray, arguments and the query they point to are ours, outlive
        // the call and have the library's layout; the filter fits the query's record.
        let trace = || unsafe { sys::rtcOccluded1(self.scene(), &mut shadow_ray, &mut arguments) };
        meter::query(meter::Query::Shadows, || 1, trace);
        (shadow_ray.tfar == f32::NEG_INFINITY).then_some(query.found)
    }

    /// Returns the occluded lanes like [`Accel::occluded16`], and writes their occluders to `found`.
    #[inline]
    pub fn occluders16(&self, rays: &Rays16, valid: u16, coherent: bool, found: &mut Occluders16) -> u16 {
        self.occluders_by(self.widest(), rays, valid, coherent, found)
    }

    /// Does [`Accel::occluders16`] with queries of `width` rays, at least four.
    #[inline]
    pub(super) fn occluders_by(
        &self,
        width: Width,
        rays: &Rays16,
        valid: u16,
        coherent: bool,
        found: &mut Occluders16,
    ) -> u16 {
        match self.placed_numbers() {
            None => {
                let mut query = Query { context: CONTEXT, numbers: OwnNumbers, found };
                let mut arguments = query.arguments(coherent, record_occluders::<OwnNumbers>);
                // SAFETY: arguments and query outlive the call; the filter fits the query's record.
                unsafe { self.occluded_with(width, rays, valid, &mut arguments) }
            }
            Some(numbers) => {
                let mut query = Query { context: CONTEXT, numbers, found };
                let mut arguments = query.arguments(coherent, record_occluders::<&PlacedNumbers>);
                // SAFETY: as above.
                unsafe { self.occluded_with(width, rays, valid, &mut arguments) }
            }
        }
    }
}

/// Records the occluder of a single ray, as a filter.
///
/// # Safety
/// For Embree to call during a query whose context is the head of a `Query<N, Occluder>`.
unsafe extern "C" fn record_occluder<N: Numbers>(arguments: *const sys::RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments for packets of N = 1: one valid lane, a ray and a hit of the word
    // offsets above. The context is that of the query, alive and not borrowed elsewhere while the query runs
    // on this thread.
    unsafe {
        let arguments = &*arguments;
        let query = &mut *arguments.context.cast::<Query<N, Occluder>>();
        query.found = Occluder {
            t: *arguments.ray.cast::<f32>().add(word::RAY_T_FAR),
            geometry: query.numbers.of(ids(arguments), 0),
            primitive: *arguments.hit.cast::<u32>().add(word::HIT_PRIMITIVE),
        };
    }
}

/// Records the occluders of a packet of sixteen, as a filter.
///
/// The filter processes and blends all lanes, so that it compiles to vector instructions. A loop over the valid lanes
/// costs several times as much.
///
/// # Safety
/// For Embree to call during a query whose context is the head of a `Query<N, &mut Occluders16>`. The rays carry
/// their lane as their id.
unsafe extern "C" fn record_occluders<N: Numbers>(arguments: *const sys::RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments; the context is that of the query, alive and not borrowed
    // elsewhere while the query runs on this thread.
    let (arguments, numbers, found) = unsafe {
        let arguments = &*arguments;
        let query = &mut *arguments.context.cast::<Query<N, &mut Occluders16>>();
        (arguments, query.numbers, &mut *query.found)
    };
    let n = arguments.N as usize;
    if n != 16 {
        // SAFETY: as above.
        return unsafe { record_split_packet(arguments, numbers, found) };
    }
    // SAFETY: with N = 16, mask, ray and hit are arrays of 16 words at these offsets, none of which
    // overlaps our record. The mask's words are 0 or -1.
    let (valid, t, primitive, ids) = unsafe {
        (
            &*arguments.valid.cast::<[u32; 16]>(),
            &*arguments.ray.cast::<f32>().add(16 * word::RAY_T_FAR).cast::<[f32; 16]>(),
            &*arguments.hit.cast::<u32>().add(16 * word::HIT_PRIMITIVE).cast::<[u32; 16]>(),
            ids(arguments),
        )
    };
    for i in 0..16 {
        found.t[i] = f32::from_bits(blend(valid[i], t[i].to_bits(), found.t[i].to_bits()));
    }
    for i in 0..16 {
        // SAFETY: the ids have 16 lanes. Those of invalid lanes may be anything, which numbers stand.
        found.geometry[i] = blend(valid[i], unsafe { numbers.of(ids, i) }, found.geometry[i]);
    }
    for i in 0..16 {
        found.primitive[i] = blend(valid[i], primitive[i], found.primitive[i]);
    }
}

/// Returns `new` where the mask is all ones, `old` where it is zero.
#[inline]
fn blend(mask: u32, new: u32, old: u32) -> u32 {
    (mask & new) | (!mask & old)
}

/// Records occluders of a split packet, for processors without sixteen-wide kernels. The ray's id is its lane.
///
/// # Safety
/// As for [`record_occluders`], from which it is called.
unsafe fn record_split_packet<N: Numbers>(
    arguments: &sys::RTCFilterFunctionNArguments,
    numbers: N,
    found: &mut Occluders16,
) {
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
                numbers.of(ids(arguments), i),
                *hit.add(word::HIT_PRIMITIVE * n + i),
            )
        };
        found.t[lane] = t;
        found.geometry[lane] = geometry;
        found.primitive[lane] = primitive;
    }
}
