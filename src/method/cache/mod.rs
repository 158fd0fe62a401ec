//! The radiance cache: incident light computed at some thousand points, and extrapolated to the eye samples
//! between them.
//!
//! Paper: Herzog et al. 2009, records splatted onto all eye samples; LCache1 with isotropic, LCache2 with
//! anisotropic footprints. Beyond it: footprints and gradients that include the edges of occluders
//! (`occlusion`).
//!
//! By default the records are of indirect light; direct light, whose shadows are fine, is lit by
//! reconstruction cuts, as in [`super::reconstruction`]. So are eye samples whose reflection is too sharp for
//! records, where a record would serve too few of them, and where records still disagree visibly after the
//! last pass.
//!
//! Use it where light is smooth, or where records are wanted for other uses: they are few, and do not depend
//! on the pixels. Where only the picture matters, reconstruction cuts take as long and err less.

mod render;
pub(crate) mod resolve;

pub use render::Settings;
