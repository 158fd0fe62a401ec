//! `lightsplat bench`: speed of parts of the renderer, time and error of whole images.
//!
//! A benchmark is an entry of [`REGISTRY`]. Benchmarks of parts measure cases against each other (`measure`) and return
//! a [`Report`], which [`export`] writes. The first figure of their tables is a ratio, since ratios depend less on the
//! machine than rates do. Studies ([`study`]) ask questions about whole images: they render, store and judge the
//! images, and write a page. No image depends on this crate.

#![forbid(unsafe_code)]

mod benchmark;
mod bounds;
mod bsdf;
mod budget;
mod choice;
mod document;
mod escape;
pub mod export;
mod extremes;
mod growth;
mod hsh;
mod lit_scene;
pub mod machine;
mod measure;
mod plot;
mod prices;
mod race;
mod report;
mod shadow;
pub mod study;
mod table1;
mod thumbnail;
mod trade;
mod trees;

pub use benchmark::{Benchmark, Context, Kind, Scenes, Settings};
pub use report::{Report, Row, Spread, Table};

/// All benchmarks.
pub const REGISTRY: [Benchmark; 13] = [
    table1::BENCHMARK,
    trade::BENCHMARK,
    race::BENCHMARK,
    extremes::BENCHMARK,
    choice::BENCHMARK,
    growth::BENCHMARK,
    shadow::BENCHMARK,
    bounds::BENCHMARK,
    trees::BENCHMARK,
    bsdf::BENCHMARK,
    hsh::BENCHMARK,
    budget::BENCHMARK,
    prices::BENCHMARK,
];

/// Finds a benchmark by its name.
pub fn named(name: &str) -> Option<&'static Benchmark> {
    REGISTRY.iter().find(|b| b.name == name)
}
