//! `lightsplat bench`: speed of parts of the renderer, time and error of whole pictures.
//!
//! A benchmark is an entry of [`REGISTRY`]. Those of parts measure cases against each other (`measure`) and
//! return a [`Report`] of tables whose first figure is a ratio, for ratios hold from one machine to the next
//! better than rates do; [`export`] writes reports, one format a file. Studies ([`study`]) render whole
//! pictures, store them, judge them against references and write a page. No picture depends on this module.

#![forbid(unsafe_code)]

mod bounds;
mod bsdf;
mod choice;
mod document;
pub mod export;
mod extremes;
mod growth;
mod hsh;
mod measure;
mod race;
mod report;
mod setting;
mod shadow;
pub mod study;
mod table1;
mod trade;
mod trees;

pub use measure::Clock;
pub use report::{Report, Row, Spread, Table};

use render::session::Session;
use std::path::PathBuf;
use study::{Results, Study, StudyError};

/// A benchmark that can be chosen by name.
pub struct Benchmark {
    /// Name on the command line.
    pub name: &'static str,
    /// Description in a line.
    pub about: &'static str,
    /// Kind of benchmark.
    pub kind: Kind,
}

/// Kinds of benchmarks, by their subject.
pub enum Kind {
    /// Parts of the renderer.
    Parts {
        /// True if it measures on a scene.
        needs_scene: bool,
        /// Function that measures.
        run: fn(&Context) -> Vec<Table>,
    },
    /// Whole pictures.
    Study {
        /// Names of the scenes studied by default; if empty, the user has to name some.
        scenes: &'static [&'static str],
        /// Default width and height of the pictures.
        pixels: [u32; 2],
        /// Function that studies scene files.
        run: fn(&Study, &[PathBuf]) -> Result<Results, StudyError>,
    },
    /// Whole pictures of scenes that the study makes.
    OwnScenes {
        /// Default width and height of the pictures.
        pixels: [u32; 2],
        /// Default number of seeds of every picture.
        repeats: usize,
        /// Function that studies them.
        run: fn(&Study) -> Result<Results, StudyError>,
    },
}

/// All benchmarks.
pub const REGISTRY: [Benchmark; 11] = [
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
];

/// Settings of measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Number of threads of multi-threaded cases.
    pub threads: usize,
    /// Number of samples of every case.
    pub repeats: usize,
    /// Approximate duration of a sample, seconds.
    pub seconds: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { threads: 1, repeats: 7, seconds: 0.05 }
    }
}

/// Inputs of a benchmark.
pub struct Context<'a> {
    /// The scene, if one was named; always present for benchmarks that need one.
    pub session: Option<&'a Session>,
    /// Settings of measurements.
    pub settings: Settings,
    /// Callback for progress messages.
    pub say: &'a dyn Fn(&str),
}

impl Benchmark {
    /// Finds a benchmark by its name.
    pub fn named(name: &str) -> Option<&'static Benchmark> {
        REGISTRY.iter().find(|b| b.name == name)
    }

    /// Returns the name of its operand in the usage.
    pub fn operand(&self) -> &'static str {
        match self.kind {
            Kind::Parts { needs_scene: false, .. } | Kind::OwnScenes { .. } => "",
            Kind::Parts { needs_scene: true, .. } => " SCENE",
            Kind::Study { scenes: [], .. } => " SCENE...",
            Kind::Study { .. } => " [SCENE...]",
        }
    }

    /// Makes a report of measured tables.
    pub fn report(&self, context: &Context, tables: Vec<Table>) -> Report {
        let mut facts = vec![
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("threads".to_owned(), context.settings.threads.to_string()),
            ("samples a case".to_owned(), context.settings.repeats.to_string()),
        ];
        if let Some(Session { world, .. }) = context.session {
            let triangles = world.scene.triangle_count();
            facts.push(("triangles".to_owned(), triangles.to_string()));
            facts.push(("Embree".to_owned(), world.accel.device().version().to_string()));
            facts.push(("widest packet".to_owned(), world.accel.widest().rays().to_string()));
        }
        Report {
            benchmark: self.name.to_owned(),
            scene: context.session.map(|s| s.world.scene.name.clone()),
            facts,
            tables,
        }
    }
}
