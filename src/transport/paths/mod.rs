//! Paths from the eye, traced in batches, one edge at a time, in packets of sixteen.
//!
//! [`start()`] adds paths to a [`Batch`] by the positions of their first edges in pixels ([`Estimand`]). The batch
//! traces them with next-event estimation at every vertex.

mod arrival;
mod batch;
mod chain_ends;
mod coverage;
mod estimand;
mod found_light;
mod groups;
mod guided;
mod packet;
mod photon_ends;
mod pixel_order;
mod policy;
mod start;
#[cfg(test)]
mod tests;
mod vertex;
mod vertices;

pub use batch::Batch;
pub use coverage::{Coverage, Position};
pub use estimand::{Estimand, eye_sampler};
pub use found_light::RayCounts;
pub(crate) use groups::{MAX_DISTANCE, MAX_HEIGHT, MIN_OUT_COS};
pub use policy::{ChainEnd, LightSamples, PathPolicy, ScatteredEdges};
pub use start::{PathStart, start};
