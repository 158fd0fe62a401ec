//! Paths from the eye, traced many together, an edge at a time, in packets of sixteen.
//!
//! A [`Batch`] takes paths by the places of their first edges in pixels ([`start()`], [`Look`]) and follows them, with
//! next-event estimation at every vertex.

mod batch;
mod guided;
mod look;
mod packet;
mod start;
#[cfg(test)]
mod tests;
mod vertex;

pub use batch::{Batch, ChainEnd, Counts, LightSamples, Reach, ScatteredEdges};
pub use look::{Look, eye_sampler};
pub use start::{Start, start};
