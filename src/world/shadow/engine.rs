//! Shadow queries in a world, counted, with or without an occluder cache.
//!
//! Each thread has its own engine. An engine without a cache is cheap to create: a reference and counters.

use super::cache::{OccluderCache, OccluderCacheSettings};
use super::counts::{Counters, ShadowCounts};
use crate::World;
use base::math::lanes_in;
use embree::{Occluder, Occluders16, Ray, Rays16, TriangleId};
use std::cell::RefCell;

/// Shadow queries in a world.
pub struct Engine<'w> {
    world: &'w World,
    /// Occluder cache. The packets of methods do not use it (see [`super::ShadowSettings`]).
    cache: Option<RefCell<OccluderCache>>,
    /// True if packets hold rays from neighbouring points.
    coherent: bool,
    counters: Counters,
}

impl<'w> Engine<'w> {
    /// Creates an engine without an occluder cache.
    #[inline]
    pub fn new(world: &'w World) -> Engine<'w> {
        Engine { world, cache: None, coherent: true, counters: Counters::default() }
    }

    /// Creates an engine without an occluder cache for packets of rays from distant points, which Embree traces one by
    /// one.
    pub fn scattered(world: &'w World) -> Engine<'w> {
        Engine { coherent: false, ..Engine::new(world) }
    }

    /// Creates an engine, with an occluder cache if `cached`.
    pub fn with(world: &'w World, cached: bool, settings: OccluderCacheSettings) -> Engine<'w> {
        let cache = cached.then(|| RefCell::new(OccluderCache::new(settings)));
        Engine { cache, ..Engine::new(world) }
    }

    /// Returns the world.
    #[inline]
    pub fn world(&self) -> &'w World {
        self.world
    }

    /// Clears the cache. Callers do this at boundaries of the work that do not depend on the number of threads.
    pub fn begin_chunk(&self) {
        if let Some(cache) = &self.cache {
            cache.borrow_mut().forget();
        }
    }

    /// Returns the counts since the last call.
    pub fn take_counts(&self) -> ShadowCounts {
        self.counters.take()
    }

    /// Returns true if a ray is occluded. `key` identifies the light in the cache.
    #[inline]
    pub fn occluded(&self, ray: &Ray, key: u32) -> bool {
        if self.cache.is_some() {
            return self.occluder(ray, key).is_some();
        }
        let occluded = self.world.accel.occluded(ray);
        self.counters.single.count(1, u32::from(occluded), 0);
        occluded
    }

    /// Returns any triangle that occludes a ray. `key` identifies the light in the cache.
    #[inline]
    pub fn occluder(&self, ray: &Ray, key: u32) -> Option<Occluder> {
        let cached = self.cache.as_ref().and_then(|cache| cache.borrow().occluder(key, ray));
        let occluder = cached.or_else(|| self.world.accel.occluder(ray));
        if let (Some(cache), None, Some(new)) = (&self.cache, cached, occluder) {
            let (corner, edges) = self.world.corner_and_edges(new.id());
            cache.borrow_mut().keep(key, new.id(), corner, edges);
        }
        self.counters.single.count(1, u32::from(occluder.is_some()), u32::from(cached.is_some()));
        occluder
    }

    /// Returns the lanes of `valid` whose rays are occluded. All rays go to one light.
    #[inline]
    pub fn occluded16(&self, rays: &Rays16, valid: u16) -> u16 {
        let occluded = self.world.accel.occluded16(rays, valid, self.coherent);
        self.counters.packets.count(valid.count_ones(), occluded.count_ones(), 0);
        occluded
    }

    /// Like [`Engine::occluded16`], but asks the occluder cache about each ray before the others are traced. `key`
    /// identifies the light in the cache.
    ///
    /// Methods do not call it (see [`super::ShadowSettings`]); a benchmark tells its gain.
    pub fn occluded16_cached(&self, rays: &Rays16, valid: u16, key: u32) -> u16 {
        let Some(cache) = &self.cache else { return self.occluded16(rays, valid) };
        let mut cache = cache.borrow_mut();
        let is_known = |lane: &usize| cache.occluder(key, &rays.get(*lane)).is_some();
        let known = lanes_in(valid).filter(is_known).fold(0, |mask, lane| mask | 1 << lane);
        let mut found = Occluders16::default();
        let traced = match valid & !known {
            0 => 0,
            rest => self.world.accel.occluders16(rays, rest, self.coherent, &mut found),
        };
        for lane in lanes_in(traced) {
            let id = TriangleId { geometry: found.geometry[lane], primitive: found.primitive[lane] };
            let (corner, edges) = self.world.corner_and_edges(id);
            cache.keep(key, id, corner, edges);
        }
        let occluded = known | traced;
        self.counters.packets.count(valid.count_ones(), occluded.count_ones(), known.count_ones());
        occluded
    }

    /// Returns the lanes of `valid` whose rays are occluded, and writes their occluders to these lanes of `found`.
    #[inline]
    pub fn occluders16(&self, rays: &Rays16, valid: u16, found: &mut Occluders16) -> u16 {
        let occluded = self.world.accel.occluders16(rays, valid, self.coherent, found);
        self.counters.packets.count(valid.count_ones(), occluded.count_ones(), 0);
        occluded
    }
}
