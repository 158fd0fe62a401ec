//! Path tracing: the unbiased reference.
//!
//! Use it to know the truth; it converges in any scene whose light can be found by next-event estimation or
//! by chance, with noise that falls with the square root of the samples. It does not converge in reasonable time
//! where small lights shine through glass.
//!
//! Every pixel averages Owen-scrambled Sobol samples over a box one pixel wide. Next-event estimation and BSDF
//! sampling are joined by the power heuristic. The variance beside the picture is the sample variance over
//! the number of samples: an estimate on the safe side, since stratification makes the true one smaller.
//!
//! An interrupted picture holds whole passes of its tiles and states the samples of each pixel, so that it can be
//! merged with others, and go on ([`Begun`]).

mod begun;
mod pixels;
mod render;

pub use begun::Begun;
pub use pixels::{Wanted, pixel_means};
pub use render::Settings;
pub use transport::paths::RayCounts;
