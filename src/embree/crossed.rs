//! All triangles along a segment, in one traversal.
//!
//! A filter of an occlusion query passes each candidate to the caller and rejects it. So the traversal goes on until
//! the caller stops it.

use super::numbers::{Numbers, OwnNumbers};
use super::occluder::{CONTEXT, Query, ids, word};
use super::ray::ALL_GEOMETRY;
use super::{Accel, Hit, Ray};
use base::stats::meter;
use embree4_sys as sys;

impl Accel {
    /// Calls `visit` for every triangle that the segment crosses, of all meshes and in no particular order, until it
    /// returns false; returns true if it never did.
    #[inline]
    pub fn each_crossed<Visit: FnMut(Hit) -> bool>(&self, ray: &Ray, visit: Visit) -> bool {
        match self.placed_numbers() {
            None => self.each_numbered(ray, OwnNumbers, visit),
            Some(numbers) => self.each_numbered(ray, numbers, visit),
        }
    }

    #[inline(always)]
    fn each_numbered<N: Numbers, Visit: FnMut(Hit) -> bool>(
        &self,
        ray: &Ray,
        numbers: N,
        mut visit: Visit,
    ) -> bool {
        let Some(mut segment) = ray.to_embree(ALL_GEOMETRY).filter(|_| !self.is_empty()) else { return true };
        let mut query = Query { context: CONTEXT, numbers, found: &mut visit };
        let mut arguments = query.arguments(false, pass_on::<N, Visit>);
        // SAFETY: the scene is committed; ray, arguments and the query they point to are ours, outlive the call and
        // have the library's layout; the filter fits the query's record.
        let trace = || unsafe { sys::rtcOccluded1(self.scene(), &mut segment, &mut arguments) };
        meter::query(meter::Query::Hits, || 1, trace);
        segment.tfar != f32::NEG_INFINITY
    }
}

/// Accepts a candidate of a single ray if `Visit` returns false.
///
/// # Safety
/// For Embree to call during a query whose context is the head of a `Query<N, &mut Visit>`.
unsafe extern "C" fn pass_on<N: Numbers, Visit: FnMut(Hit) -> bool>(
    arguments: *const sys::RTCFilterFunctionNArguments,
) {
    // SAFETY: Embree passes valid arguments for packets of N = 1: one valid lane, a ray and a hit of the word offsets
    // in `word`. The context is that of the query, alive and not borrowed elsewhere while the query runs on this
    // thread.
    unsafe {
        let arguments = &*arguments;
        let query = &mut *arguments.context.cast::<Query<N, &mut Visit>>();
        let hit = arguments.hit.cast::<u32>();
        let hit = Hit {
            t: *arguments.ray.cast::<f32>().add(word::RAY_T_FAR),
            u: *hit.cast::<f32>().add(word::HIT_U),
            v: *hit.cast::<f32>().add(word::HIT_V),
            geometry: query.numbers.of(ids(arguments), 0),
            primitive: *hit.add(word::HIT_PRIMITIVE),
        };
        if (query.found)(hit) {
            *arguments.valid = 0;
        }
    }
}
