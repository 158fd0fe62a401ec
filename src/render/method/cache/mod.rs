//! The radiance cache: direct light drawn at every visibility sample, indirect light computed at some thousand
//! points and extrapolated to the shading points between them.
//!
//! Paper: Herzog et al. 2009, records splatted onto all eye samples; LCache1 with isotropic, LCache2 with
//! anisotropic footprints. Beyond it: footprints and gradients that include the edges of occluders
//! (`occlusion`).
//!
//! By default the records are of indirect light; direct light, whose shadows are fine, is drawn by the eye pass, and
//! leaves noise for a denoiser. Reconstruction cuts, as in [`super::reconstruction`], light shading points whose
//! reflection is too sharp for records, where a record would serve too few of them, and where records still
//! disagree visibly after the last pass; and either layer where that is asked for.
//!
//! Use it as the default. Noise of drawn light is unbiased; virtual lights and records are not.

pub mod direct_sampling;
mod render;
pub mod resolve;

pub use render::Settings;
