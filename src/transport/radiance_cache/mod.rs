//! Radiance cache: records of irradiance or radiance, splatted onto the eye samples around them, and adapted until no
//! seam between records is visible.
//!
//! Paper: Herzog et al. 2009, sections 5 (records and footprints), 5.2 (adaptation) and 6 (splatting).
//!
//! Contents of a record:
//! - [`record`]: irradiance at a point; [`footprint`]: the ellipse within which it is used;
//! - [`glossy`], [`glossy_point`]: the materials whose lobes need series of radiance, and the reflection by these
//!   lobes;
//! - [`store`]: the records of a layer; [`retained`]: the records of a walk-through, from frame to frame;
//!   [`vantage`]: the cameras of its frames.
//!
//! Computation:
//! - [`cells`]: points where records are needed; [`compute`]: what computes records there;
//! - [`compute`]: records by lightcuts that neighbours share; [`lit_cluster`], [`lit_cut`]: the light of a cut at the
//!   points of records; [`gather`], [`series`]: the sums over it;
//! - [`occluder_distance`]: distances of occluders, which bound footprints;
//! - [`probe`], [`edges`], [`occlusion_hessian`]: surfaces around a record, and the change of its light due to the
//!   motion of occluders' edges.
//!
//! Use in a frame:
//! - [`targets`]: the eye samples that records light; [`splat`]: weighted sums there;
//! - [`placement`]: points where records are needed next; [`adapt`]: shrinking of footprints that disagree visibly;
//!   [`fill`]: both, until all samples are covered;
//! - [`resolve`]: light of records at the eye samples, and the parts left to cuts; [`inspect`]: images of records;

pub mod adapt;
pub mod cells;
pub mod compute;
pub mod edges;
pub mod fill;
#[cfg(test)]
mod fixtures;
pub mod footprint;
pub mod gather;
pub mod glossy;
pub mod glossy_point;
pub mod inspect;
pub mod lit_cluster;
pub mod lit_cut;
pub mod occluder_distance;
pub mod occlusion_hessian;
pub mod placement;
pub mod probe;
pub mod record;
pub mod resolve;
pub mod retained;
pub mod series;
pub mod settings;
pub mod splat;
pub mod store;
pub mod targets;
#[cfg(test)]
mod tests;
pub mod vantage;

pub use cells::CellLimits;
pub use settings::{CLAMP, CacheSettings, DirectBy, Footprints, FoundBy, MAX_CUT};
