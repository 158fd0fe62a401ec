//! The methods: path tracing, and light by virtual point lights with its presets.
//!
//! A method is a [`Renderer`]: a struct of settings with a name and a render function. [`Method`] is any of them.
//! Two further abilities are traits of their own: [`Walks`] and [`Resumes`].

mod lights;
mod outlook;
pub mod path;
mod photon_store;
mod prepared;
mod registry;
mod renderer;
mod sampling;
mod scale;
mod tally;
pub mod vpl;

pub use lights::LightStore;
pub use outlook::Outlook;
pub use registry::Method;
pub use renderer::{FormerFrames, Output, PILOT_SPP, Renderer, Resumes, SampledPixels, Walks, render};
pub use sampling::{HasSampling, Sampling};
pub use scale::{Demand, LEVELS, Move, SPP, ScaleLimits};

// Parts of the methods' settings.
pub use transport::lightcut::CutSettings;
pub use transport::lights::LightPassSettings;
pub use transport::paths::Estimand;
pub use transport::radiance_cache::retained::{RetainedRecords, RetentionLimits};
pub use transport::radiance_cache::{CacheSettings, DirectBy, Footprints, FoundBy};
pub use vpl::Preset;
pub use world::shadow::{OccluderCacheSettings, ShadowSettings};
