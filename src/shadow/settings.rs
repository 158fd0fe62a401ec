//! Which shadow rays a method has the occluder cache asked for.

use super::OccluderCacheSettings;

/// Queries that ask the occluder cache before a ray is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cached {
    /// None.
    Nothing,
    /// Rays of single points.
    Single,
    /// Those, and packets.
    All,
}

/// How a method uses the occluder cache. It changes the time that a picture takes, and nothing in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowSettings {
    /// What asks the cache; `None` for what is fastest.
    pub cached: Option<Cached>,
    /// Its size.
    pub cache: OccluderCacheSettings,
}

impl ShadowSettings {
    /// What asks the cache where neighbouring points share cuts, or do not.
    ///
    /// As `lightsplat bench shadow` has it: it pays for rays of points that all have cuts of their own, and the more the
    /// closer the points lie. Where points share cuts, packets gain less than the cache costs, and the few single rays
    /// in between have nobody to learn from.
    pub fn cached(&self, shared: bool) -> Cached {
        self.cached.unwrap_or(if shared { Cached::Nothing } else { Cached::Single })
    }
}
