//! Which shadow rays a method has the occluder cache asked for.

use super::OccluderCacheSettings;

/// Queries that ask the occluder cache before a ray is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cached {
    /// None.
    Nothing,
    /// Rays of single points.
    Single,
    /// Those, and packets. Embree's answers in coherent packets depend, for a ray in some ten million, on which other rays
    /// are traced with it: without those that the cache answers, one in 23 million was no longer found occluded.
    All,
}

/// How a method uses the occluder cache. Asked for single rays it changes the time that a picture takes, and nothing in
/// the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowSettings {
    /// What asks the cache; `None` for what is fastest.
    pub cached: Option<Cached>,
    /// Its size.
    pub cache: OccluderCacheSettings,
}

impl ShadowSettings {
    /// What asks the cache for eye samples, which share cuts with their neighbours, or do not.
    ///
    /// As `lightsplat bench shadow` has it: the cache pays for samples that all have cuts of their own. Where they share
    /// cuts, packets gain no more than the cache costs, and the few single rays in between have nobody to learn from.
    pub fn for_samples(&self, shared: bool) -> Cached {
        self.cached.unwrap_or(if shared { Cached::Nothing } else { Cached::Single })
    }

    /// What asks the cache for records: they lie too far apart to have occluders in common.
    pub fn for_records(&self) -> Cached {
        self.cached.unwrap_or(Cached::Nothing)
    }
}
