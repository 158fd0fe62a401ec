//! Reconstruction cuts: sixteen eye samples of a patch share a cut, from which the light of the others is
//! reconstructed.
//!
//! Paper: Walter et al. 2005, *Lightcuts: A Scalable Approach to Illumination*, section 5; see
//! [`transport::lightcut::ReconstructionCut`], also for its deviations.
//!
//! Use it for pictures without noise that are not to be denoised: against records of both layers of light
//! ([`super::cache`]) it takes as long and errs less, most of all where shadows are fine. The patch's cut
//! corresponds to a record, a linear fit to its gradient, and rays correct it where the sixteen disagree. Light that
//! reaches visible surfaces through glass or by mirrors is found as in [`super::lightcuts`], with noise.

mod render;
mod settings;

pub use settings::Settings;
