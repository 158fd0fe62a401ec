//! Stages 4 to 6: cache records, splatted onto the eye samples around them, and adapted until no seam is visible.
//!
//! Paper: Herzog et al. 2009, sections 5 (records and footprints), 6 (splatting), 8 of the method (adaptation).
//!
//! Contents of a record:
//! - [`record`]: irradiance at a point; [`footprint`]: the ellipse within which it is used; [`store`]: the records of
//!   a layer, which outlive the frame; [`kept`]: those of a walk-through, from frame to frame;
//! - [`series`]: radiance as a series beside irradiance, for glossy surfaces, and its reflection by lobes.
//!
//! Computation:
//! - [`source`]: the points where records are needed, and the sources that compute them; [`compute`]: by lightcuts,
//!   neighbours sharing them;
//! - [`gather`]: from a converged cut to irradiance, its gradient and the distance of the geometry that casts light and
//!   shadow, [`occluder_distance`] included; [`compensate`]: light lost by clamping near virtual lights, recovered by
//!   short rays;
//! - [`probe`], [`edges`], [`occlusion_hessian`]: surfaces around a record, and the change of its light with the motion
//!   of occluders' edges.
//!
//! Use in a frame:
//! - [`targets`]: the eye samples as far as records light them; [`splat`]: weighted sums there;
//! - [`placement`]: points where records are needed next; [`adapt`]: footprints that disagree visibly are shrunk;
//!   [`fill`]: both, until all is covered;
//! - [`resolve`]: light of records at the eye samples, and the parts left to cuts; [`inspect`]: images of records.

pub mod adapt;
pub mod compensate;
pub mod compute;
pub mod edges;
pub mod fill;
#[cfg(test)]
mod fixtures;
pub mod footprint;
pub mod gather;
pub mod inspect;
pub mod kept;
pub mod lit_cluster;
pub mod occluder_distance;
pub mod occlusion_hessian;
pub mod placement;
pub mod probe;
pub mod record;
pub mod resolve;
pub mod series;
pub mod settings;
pub mod source;
pub mod splat;
pub mod store;
pub mod targets;
#[cfg(test)]
mod tests;
pub mod work;

pub use settings::{CLAMP, CacheSettings, DirectBy, Footprints, FoundBy, MAX_CUT};
