//! Irradiance of photons on surfaces.
//!
//! - [`map`]: photons, ordered so that neighbours in space are neighbours in memory;
//! - [`density`]: irradiance from the photons around a point; [`disc`]: the part of the disc around the point that
//!   is surface;
//! - [`lookup`]: look-ups of irradiance anywhere;
//! - [`path_ends`]: ends of eye paths at diffuse surfaces.

pub mod density;
mod disc;
mod lookup;
pub mod map;
mod path_ends;

pub use disc::MIN_COS;
pub use lookup::IrradianceMap;
pub use map::PhotonMap;
pub use path_ends::{Arrival, EndsWanted, PathEnds};
