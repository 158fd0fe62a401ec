//! Stages 4 to 6: cache records, splatted onto the eye samples around them, and adapted until no seam is visible.
//!
//! Paper: Herzog et al. 2009, sections 5 (records and footprints), 6 (splatting), 8 of the method (adaptation).
//!
//! - [`record`]: what is stored at a point; [`footprint`]: the ellipse within which it is used;
//! - [`gather`]: from a converged cut to irradiance, its gradient and the distance to what casts light and shadow;
//! - [`probe`], [`edges`], [`occlusion_hessian`]: what a record's point sees, and how the edges of occluders change its light
//!   as it moves;
//! - [`compute`]: the records of one wave, neighbours sharing cuts; [`occluder_distance`]: how far away what hides lights
//!   is;
//! - [`series`]: the same for glossy surfaces: radiance as a series, and what lobes reflect of it;
//! - [`compensate`]: what clamping near virtual lights took away, found by short rays;
//! - [`splat`]: the records of direct or of indirect light, and their weighted sums at the eye samples;
//! - [`placement`]: where records are needed next;
//! - [`adapt`]: footprints that disagree visibly are shrunk.

pub mod adapt;
pub mod compensate;
pub mod compute;
pub mod edges;
pub mod fill;
pub mod footprint;
pub mod gather;
pub mod inspect;
pub mod occluder_distance;
pub mod occlusion_hessian;
pub mod placement;
pub mod probe;
pub mod record;
pub mod series;
pub mod settings;
pub mod splat;
#[cfg(test)]
mod tests;

pub use settings::{CacheSettings, Footprints, FoundBy};
