//! Quality of acceleration structures.

use embree4_sys as sys;

/// Effort of Embree's build, and size of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// Morton order: fastest build, slowest traversal.
    Low,
    /// Binned surface-area heuristic. It is the fastest quality without significant loss of hits: occlusion differs
    /// from `Robust` for about one ray in a million.
    #[default]
    Medium,
    /// Quality `Medium` with spatial splits.
    High,
    /// Quality `Medium`, with traversal that rounds outwards.
    Robust,
}

impl BuildQuality {
    /// Returns the quality and the flags of scenes in Embree's terms.
    pub(super) fn to_embree(self) -> (sys::RTCBuildQuality, sys::RTCSceneFlags) {
        match self {
            BuildQuality::Low => (sys::RTC_BUILD_QUALITY_LOW, sys::RTC_SCENE_FLAG_NONE),
            BuildQuality::Medium => (sys::RTC_BUILD_QUALITY_MEDIUM, sys::RTC_SCENE_FLAG_NONE),
            BuildQuality::High => (sys::RTC_BUILD_QUALITY_HIGH, sys::RTC_SCENE_FLAG_NONE),
            BuildQuality::Robust => (sys::RTC_BUILD_QUALITY_MEDIUM, sys::RTC_SCENE_FLAG_ROBUST),
        }
    }
}
