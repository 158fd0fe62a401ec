//! The renderers compared, one folder each. They share every stage they can.
//!
//! A method is a [`Renderer`]: a struct of settings with a name and a render function. [`Method`] is any of them.
//! Further abilities are traits of their own: [`Walks`], [`Resumes`], [`Noisy`], [`Pilots`] and [`Scales`].

pub mod cache;
pub mod lightcuts;
mod lights;
mod memo;
mod outlook;
pub mod output;
mod overlap;
pub mod path;
pub mod photon_cache;
mod photon_store;
mod prepared;
pub mod reconstruction;
mod registry;
mod renderer;
mod sampled_pixels;
mod sampling;
mod scale;
mod tally;

pub use lights::LightStore;
pub use outlook::Outlook;
pub use output::Output;
pub use registry::Method;
pub use renderer::{FormerFrames, Noisy, Pilots, Renderer, Resumes, Walks, render};
pub use sampled_pixels::{PILOT_SPP, SampledPixels};
pub use sampling::{HasSampling, Sampling};
pub use scale::{Demand, LEVELS, Move, ScaleLimits, ScaledSetting, Scales};

// Parts of the methods' settings.
pub use transport::lightcut::CutSettings;
pub use transport::lights::{Family, LightPassSettings};
pub use transport::paths::Estimand;
pub use transport::radiance_cache::retained::{RetainedRecords, RetentionLimits};
pub use transport::radiance_cache::{CacheSettings, DirectBy, Footprints, FoundBy};
pub use world::shadow::{OccluderCacheSettings, ShadowSettings};
