//! The renderers compared, one folder each; they share every stage they can.
//!
//! A method is a [`Renderer`]: a struct of settings with a name and a render function. [`Method`] is any of
//! them.

pub mod cache;
mod counts;
mod drawn_pixels;
mod kept;
mod ladder;
pub mod lightcuts;
mod lights;
pub mod output;
pub mod path;
pub mod photon_cache;
mod photon_store;
mod prepared;
pub mod reconstruction;
mod registry;
mod renderer;
mod sampling;

pub use drawn_pixels::{DrawnPixels, PILOT_SPP};
pub use ladder::{Move, RUNGS};
pub use lights::LightStore;
pub use output::Output;
pub use prepared::Prepared;
pub use registry::Method;
pub use renderer::{Before, Renderer, render};
pub use sampling::{Sampled, Sampling};

// Parts of the methods' settings.
pub use transport::lightcut::CutSettings;
pub use transport::lights::{Family, LightPassSettings};
pub use transport::paths::Estimand;
pub use transport::radiance_cache::retained::{RetainedRecords, RetentionLimits};
pub use transport::radiance_cache::{CacheSettings, DirectBy, Footprints, FoundBy};
pub use world::shadow::{OccluderCacheSettings, ShadowSettings};
