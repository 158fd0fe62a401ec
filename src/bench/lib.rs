//! `lightsplat bench`: speed of parts of the renderer, time and error of whole images.
//!
//! A benchmark is an entry of [`REGISTRY`], and gives [`Results`]. Benchmarks of parts measure cases against each other
//! (`measure`). The first figure of their tables is a ratio, since ratios depend less on the machine than rates do.
//! Studies ([`study`]) ask questions about whole images: they render, store and judge the images. No image depends on
//! this crate.

#![forbid(unsafe_code)]

mod benchmark;
mod budget;
mod calibrate;
mod document;
mod growth;
mod lit_scene;
pub mod machine;
mod measure;
mod plot;
mod race;
mod report;
mod results;
mod shadow;
pub mod study;
mod table1;
mod trade;
mod trees;

pub use benchmark::{Benchmark, Context, Kind, Settings};
pub use report::{Row, Spread, Table};
pub use results::Results;

/// All benchmarks.
pub const REGISTRY: [Benchmark; 8] = [
    table1::BENCHMARK,
    trade::BENCHMARK,
    race::BENCHMARK,
    calibrate::BENCHMARK,
    growth::BENCHMARK,
    shadow::BENCHMARK,
    trees::BENCHMARK,
    budget::BENCHMARK,
];

/// Finds a benchmark by its name.
pub fn named(name: &str) -> Option<&'static Benchmark> {
    REGISTRY.iter().find(|b| b.name == name)
}
