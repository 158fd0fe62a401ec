//! Path tracing: the unbiased reference.
//!
//! Use it for references. It converges in any scene whose light can be found by next-event estimation or by chance. The
//! noise falls with the square root of the samples. It does not converge in reasonable time if small lights shine
//! through glass.
//!
//! Every pixel averages Owen-scrambled Sobol samples over a box one pixel wide. Next-event estimation and BSDF sampling
//! are combined by the power heuristic. The variance of a pixel is the sample variance over the number of samples. It
//! is a conservative estimate, since stratification makes the true variance smaller.
//!
//! An interrupted image consists of complete passes of its tiles, and states the samples of each pixel. So it can be
//! merged with others, and resumed ([`PartialImage`]).

mod pixels;
mod render;
mod tile;

pub use pixels::{PixelPaths, PixelSampling, pixel_means};
pub use render::Settings;
pub use tile::PartialImage;
pub use transport::paths::RayCounts;
