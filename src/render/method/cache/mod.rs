//! The radiance cache: direct light is sampled at every visibility sample. Indirect light is computed at some thousand
//! points and extrapolated to the shading points between them.
//!
//! Paper: Herzog et al. 2009, records splatted onto all eye samples; LCache1 with isotropic, LCache2 with anisotropic
//! footprints.
//! Deviations: the default footprints and gradients account for the edges of occluders (`occlusion`). Records hold
//! indirect light only. The eye pass samples direct light, whose shadows are fine, and leaves noise for a denoiser.
//! Reconstruction cuts, as in [`super::reconstruction`], light the shading points
//!
//! - whose reflection is too sharp for records,
//! - where a record would reach too few points,
//! - where records still disagree visibly after the last pass.
//!
//! Settings choose records or cuts for either layer of light.
//!
//! Use it as the default. The noise of sampled light is unbiased; virtual lights and records are not.

pub mod direct_sampling;
mod render;
pub mod resolve;

pub use render::Settings;
