//! The renderers compared, one folder each; they share every stage they can.

pub mod cache;
mod chosen;
mod counts;
pub mod lightcuts;
pub mod lights;
pub mod output;
pub mod path;
pub mod photon_cache;

pub use chosen::Method;
pub use output::Output;

// Parts of the methods' settings.
pub use crate::eye::Look;
pub use crate::light_tree::Family;
pub use crate::lightcut::CutSettings;
pub use crate::radiance_cache::{CacheSettings, Footprints, FoundBy, LayerSettings};
pub use crate::shadow::{OccluderCacheSettings, ShadowSettings};
pub use crate::vpl::LightPassSettings;
