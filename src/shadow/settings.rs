//! Settings of shadow rays.

use super::OccluderCacheSettings;

/// Use of the occluder cache by a method: single rays ask it, if any. It changes the time that a picture takes, and
/// nothing in the picture.
///
/// Packets do not ask it: it never paid for them where that was measured, and Embree's answers in coherent packets
/// depend, for a ray in some ten million, on which others are traced with it, so that leaving out those that the
/// cache could answer would change a picture now and then.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowSettings {
    /// Whether single rays ask it; `None` for what is fastest.
    pub cached: Option<bool>,
    /// Its size.
    pub cache: OccluderCacheSettings,
}

impl ShadowSettings {
    /// Whether rays from eye samples ask it, which share cuts with their neighbours, or do not.
    ///
    /// As `lightsplat bench shadow` has it: the cache pays for samples that all have cuts of their own. Where they
    /// share cuts, the few single rays in between have nobody to learn from.
    pub fn for_samples(&self, shared: bool) -> bool {
        self.cached.unwrap_or(!shared)
    }

    /// Whether rays from records do: they lie too far apart to have occluders in common.
    pub fn for_records(&self) -> bool {
        self.cached.unwrap_or(false)
    }
}
