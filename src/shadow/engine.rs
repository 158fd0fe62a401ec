//! Answers whether segments are free, by what they are occluded, and how far away.
//!
//! One for each thread, or made where it is needed: without a cache it is a reference and counters that nobody reads.

use super::cache::{OccluderCache, OccluderCacheSettings};
use super::counts::{Counters, Counts};
use super::{Batch, Packing};
use crate::embree::{ALL_GEOMETRY, Occluder, Occluders16, Ray, Rays16, TriangleId, Width};
use crate::math::{first_lanes, lanes_in};
use crate::world::World;
use std::cell::RefCell;

const NO_SKIP: [TriangleId; 2] = [TriangleId::NONE; 2];

/// Shadow queries in a world.
pub struct Engine<'w> {
    world: &'w World,
    width: Width,
    cache: Option<RefCell<OccluderCache>>,
    /// Whether packets ask the cache too.
    packets_cached: bool,
    counters: Counters,
}

impl<'w> Engine<'w> {
    /// Without an occluder cache.
    #[inline]
    pub fn new(world: &'w World) -> Engine<'w> {
        let width = world.accel.widest();
        Engine { world, width, cache: None, packets_cached: false, counters: Counters::default() }
    }

    /// With an occluder cache, asked for single rays and for packets alike.
    pub fn with_cache(world: &'w World, settings: OccluderCacheSettings) -> Engine<'w> {
        Engine { packets_cached: true, ..Engine::with(world, true, settings) }
    }

    /// With an occluder cache for single rays, if they are to be `cached`.
    pub fn with(world: &'w World, cached: bool, settings: OccluderCacheSettings) -> Engine<'w> {
        let cache = cached.then(|| RefCell::new(OccluderCache::new(settings)));
        Engine { cache, ..Engine::new(world) }
    }

    /// With packets of another width than the processor's.
    pub fn with_width(self, width: Width) -> Engine<'w> {
        Engine { width, ..self }
    }

    /// Empties the cache. To be called at boundaries of the work that do not depend on the number of threads.
    pub fn begin_chunk(&self) {
        if let Some(cache) = &self.cache {
            cache.borrow_mut().forget();
        }
    }

    /// What was asked since the last call.
    pub fn take_counts(&self) -> Counts {
        self.counters.take()
    }

    /// Whether a ray is occluded. `key` names the light to the cache.
    #[inline]
    pub fn occluded(&self, ray: &Ray, key: u32) -> bool {
        if self.cache.is_some() {
            return self.occluder(ray, key).is_some();
        }
        let occluded = self.world.accel.occluded(ray);
        self.counters.count(Packing::Single, 1, u32::from(occluded), 0);
        occluded
    }

    /// What occludes a ray; which of several is not specified.
    #[inline]
    pub fn occluder(&self, ray: &Ray, key: u32) -> Option<Occluder> {
        let (found, saved) = self.ask(ray, key, NO_SKIP);
        self.counters.count(Packing::Single, 1, u32::from(found.is_some()), u32::from(saved));
        found
    }

    /// What occludes a ray, and whether the cache knew.
    #[inline]
    fn ask(&self, ray: &Ray, key: u32, skip: [TriangleId; 2]) -> (Option<Occluder>, bool) {
        let Some(cache) = &self.cache else {
            return (self.world.accel.occluder_except(ray, skip, ALL_GEOMETRY), false);
        };
        let mut cache = cache.borrow_mut();
        let known = cache.occluder(key, ray, skip);
        if known.is_some() {
            return (known, true);
        }
        let found = self.world.accel.occluder_except(ray, skip, ALL_GEOMETRY);
        if let Some(occluder) = found {
            self.keep(&mut cache, key, occluder.id());
        }
        (found, false)
    }

    /// The cache, if rays packed so ask it.
    #[inline]
    fn cache_of(&self, packing: Packing) -> Option<&RefCell<OccluderCache>> {
        self.cache.as_ref().filter(|_| self.packets_cached || packing == Packing::Single)
    }

    #[inline]
    fn keep(&self, cache: &mut OccluderCache, key: u32, id: TriangleId) {
        let (corner, edges) = self.world.corner_and_edges(id);
        cache.keep(key, id, corner, edges);
    }

    /// The lanes of `valid` that are occluded, of rays all towards the light `key` or, if `packing` is not
    /// [`Packing::Neighbours`], towards others like it.
    #[inline]
    pub fn occluded16(&self, rays: &Rays16, valid: u16, packing: Packing, key: u32) -> u16 {
        if self.cache_of(packing).is_some() {
            return self.occluders16(rays, valid, packing, key, &mut Occluders16::default());
        }
        let width = if packing.packed() { self.width } else { Width::One };
        let occluded = self.world.accel.occluded_by(width, rays, valid, packing.coherent());
        self.counters.count(packing, valid.count_ones(), occluded.count_ones(), 0);
        occluded
    }

    /// As [`Engine::occluded16`], and says by what: the returned lanes of `found` are written.
    #[inline]
    pub fn occluders16(
        &self,
        rays: &Rays16,
        valid: u16,
        packing: Packing,
        key: u32,
        found: &mut Occluders16,
    ) -> u16 {
        let accel = &self.world.accel;
        let cache = self.cache_of(packing);
        let mut known = 0;
        if let Some(cache) = cache {
            known = cache.borrow().occluders16(key, rays, valid, |lane, occluder| put(found, lane, occluder));
        }
        let left = valid & !known;
        let new = if packing.packed() {
            accel.occluders16(rays, left, packing.coherent(), found)
        } else {
            one_by_one(left, found, |lane| accel.occluder(&rays.get(lane)))
        };
        if let (Some(cache), Some(lane)) = (cache, lanes_in(new).next()) {
            self.keep(&mut cache.borrow_mut(), key, id_of(found, lane));
        }
        self.counters.count(packing, valid.count_ones(), (known | new).count_ones(), known.count_ones());
        known | new
    }

    /// The segments of `batch` that are occluded, from the first on as bits, and by what.
    pub fn trace(&self, batch: &Batch, found: &mut Occluders16) -> u16 {
        let accel = &self.world.accel;
        let valid = first_lanes(batch.count);
        let cache = self.cache_of(batch.packing);
        let mut known = 0;
        if let Some(cache) = cache {
            let cache = cache.borrow();
            known = one_by_one(valid, found, |lane| {
                cache.occluder(batch.keys[lane], &batch.rays.get(lane), batch.skip.get(lane))
            });
        }
        let left = valid & !known;
        let new = if batch.packing.packed() {
            accel.occluders16_except(&batch.rays, left, batch.packing.coherent(), &batch.skip, found)
        } else {
            one_by_one(left, found, |lane| {
                accel.occluder_except(&batch.rays.get(lane), batch.skip.get(lane), ALL_GEOMETRY)
            })
        };
        if let Some(cache) = cache {
            let mut cache = cache.borrow_mut();
            for lane in lanes_in(new) {
                self.keep(&mut cache, batch.keys[lane], id_of(found, lane));
            }
        }
        self.counters.count(
            batch.packing,
            valid.count_ones(),
            (known | new).count_ones(),
            known.count_ones(),
        );
        known | new
    }
}

/// Asks for each lane of `lanes` by itself.
#[inline(always)]
fn one_by_one(lanes: u16, found: &mut Occluders16, mut ask: impl FnMut(usize) -> Option<Occluder>) -> u16 {
    let mut occluded = 0;
    for lane in lanes_in(lanes) {
        if let Some(occluder) = ask(lane) {
            put(found, lane, occluder);
            occluded |= 1 << lane;
        }
    }
    occluded
}

#[inline(always)]
fn put(found: &mut Occluders16, lane: usize, occluder: Occluder) {
    found.t[lane] = occluder.t;
    found.geometry[lane] = occluder.geometry;
    found.primitive[lane] = occluder.primitive;
}

#[inline(always)]
fn id_of(found: &Occluders16, lane: usize) -> TriangleId {
    TriangleId { geometry: found.geometry[lane], primitive: found.primitive[lane] }
}
