//! Settings of shadow rays.

use super::OccluderCacheSettings;
use base::setting::settings;

settings! {
    /// Use of the occluder cache by a method, for single rays only. It changes the time that a picture takes, and
    /// nothing in the picture.
    ///
    /// Packets do not use it: it was never worth its cost where that was measured, and Embree's answers in
    /// coherent packets depend, for a ray in some ten million, on the other rays traced with it, so that leaving
    /// out those that the cache could answer would change a picture now and then.
    pub struct ShadowSettings in "Lightcuts" {
        /// Cache of occluders that single shadow rays test first, for speed; `auto`: where cuts are not shared.
        cached: Option<bool> = None => [.named("occluder_cache")];
        /// Size of the cache.
        cache: OccluderCacheSettings = OccluderCacheSettings::default() => [group];
    }
}

impl ShadowSettings {
    /// Returns true if rays from eye samples use it; `shared` if neighbouring samples share cuts.
    ///
    /// Measured by `lightsplat bench shadow`: the cache is worth its cost for samples that all have cuts of
    /// their own. Where they share cuts, the few single rays in between have hardly any occluders in common.
    pub fn for_samples(&self, shared: bool) -> bool {
        self.cached.unwrap_or(!shared)
    }
}
