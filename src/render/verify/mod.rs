//! Error of an image, measured without a reference: some of its pixels are path-traced.
//!
//! | setting | default | meaning |
//! |---|---|---|
//! | `pixels` | - | approximate number of pixels traced; all, if the image has no more |
//! | `estimand` | that of the method | quantity of a pixel: mean over its square, or over the image's own eye samples |
//! | `seed` | 0 | seed of the choice of pixels and of their paths |
//! | `max_depth` | the scene's | maximum path length in edges |
//! | `max_samples` | 4096 | maximum number of paths per pixel |
//!
//! A short pilot estimates the number of paths that each pixel needs for a standard error of 1 % of its radiance. The
//! paths are then traced again, so that the stopping rule does not bias them. The error has a 95 % confidence interval,
//! which covers the random choice of pixels and the noise of their paths.
//!
//! Images whose pixels estimate the same quantity can be compared with one [`Truth`]. Images that were selected for
//! their small error against it need another, with another seed.
//!
//! The path tracer limits the measure: light that it hardly finds (small lights through glass) is missing from the
//! truth or widens the interval.

mod interval;
mod measure;
mod picks;
mod trace;
mod truth;

pub use interval::{Estimate, NORMAL_975};
pub use trace::VerifySettings;
pub use truth::{Truth, Verified, verify};
