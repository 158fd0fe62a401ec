//! Reconstruction cuts: sixteen eye samples of a patch share a cut, from which the light of the others is
//! reconstructed.
//!
//! Paper: Walter et al. 2005, *Lightcuts: A Scalable Approach to Illumination*, section 5; see
//! [`transport::lightcut::ReconstructionCut`], also for its deviations.
//!
//! Use it for images without noise that are not to be denoised. Compared with records of both layers of light
//! ([`super::cache`]) it takes as long and errs less, above all at fine shadows. The patch's cut corresponds to a
//! record, and a linear fit to its gradient. Further rays correct the fit if the sixteen samples disagree. Light that
//! reaches visible surfaces through glass or over mirrors is found as in [`super::lightcuts`], with noise.

mod render;

pub use render::Settings;
