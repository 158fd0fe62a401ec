//! Settings of shadow rays.

use super::OccluderCacheSettings;
use base::setting::settings;

settings! {
    /// Use of the occluder cache by a method. It changes the render time and nothing in the image.
    ///
    /// Single rays use the cache, packets do not. Embree's answers in coherent packets depend, for very few rays, on
    /// the other rays of the packet. If cached rays were left out, images could change.
    pub struct ShadowSettings in "Lightcuts" {
        /// Test recent occluders before the scene with single shadow rays, for speed. `auto` does so if samples do not
        /// share cuts.
        cached: Option<bool> = None => [.named("occluder_cache")];
        /// Size of the cache.
        cache: OccluderCacheSettings = OccluderCacheSettings::default() => [group];
    }
}

impl ShadowSettings {
    /// Returns true if rays from eye samples use the cache. `shared` is true if neighbouring samples share cuts: the
    /// few single rays then have hardly any occluders in common.
    pub fn for_samples(&self, shared: bool) -> bool {
        self.cached.unwrap_or(!shared)
    }
}
