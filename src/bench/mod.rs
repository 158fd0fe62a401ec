//! `lightsplat bench`: how fast parts of the renderer are, and what whole pictures cost and are worth.
//!
//! A benchmark is an entry of [`REGISTRY`]. Those of parts measure cases against each other (`measure`) and return a
//! [`Report`] of tables whose first figure is a ratio, for ratios hold from one machine to the next better than rates
//! do; [`export`] writes reports, one format a file. Studies ([`study`]) render whole pictures, keep them, judge
//! them against references and write a page. Nothing here decides how a picture is made.

mod bounds;
mod bsdf;
pub mod export;
mod hsh;
mod measure;
mod report;
mod setting;
mod shadow;
pub mod study;
mod table1;
mod trade;
mod trees;

pub use measure::{Clock, Warning};
pub use report::{Report, Row, Spread, Table};

use crate::session::Session;
use std::path::PathBuf;
use study::{Document, Study, StudyError};

/// A benchmark that can be asked for by name.
pub struct Benchmark {
    /// Name on the command line.
    pub name: &'static str,
    /// What it measures, in a line.
    pub about: &'static str,
    /// What it works on.
    pub kind: Kind,
}

/// What a benchmark works on.
pub enum Kind {
    /// Parts of the renderer.
    Parts {
        /// Whether it measures on a scene.
        needs_scene: bool,
        /// Measures.
        run: fn(&Context) -> Vec<Table>,
    },
    /// Whole pictures.
    Study {
        /// Names of the scenes that are studied if the user names none; if there are none, the user has to.
        scenes: &'static [&'static str],
        /// Width and height of the pictures unless the user wants others.
        pixels: [u32; 2],
        /// Studies scene files.
        run: fn(&Study, &[PathBuf]) -> Result<Document, StudyError>,
    },
}

/// All benchmarks.
pub const REGISTRY: [Benchmark; 7] = [
    table1::BENCHMARK,
    trade::BENCHMARK,
    shadow::BENCHMARK,
    bounds::BENCHMARK,
    trees::BENCHMARK,
    bsdf::BENCHMARK,
    hsh::BENCHMARK,
];

/// How to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Threads where all are used.
    pub threads: usize,
    /// Samples of every case.
    pub repeats: usize,
    /// Seconds a sample lasts, about.
    pub seconds: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { threads: 1, repeats: 7, seconds: 0.05 }
    }
}

/// What a benchmark is given.
pub struct Context<'a> {
    /// The scene, if one was given; always there for those that need it.
    pub session: Option<&'a Session>,
    /// How to measure.
    pub settings: Settings,
    /// Called with what is being done.
    pub say: &'a dyn Fn(&str),
}

impl Benchmark {
    /// The one of that name.
    pub fn named(name: &str) -> Option<&'static Benchmark> {
        REGISTRY.iter().find(|b| b.name == name)
    }

    /// What it measures on, in the usage.
    pub fn operand(&self) -> &'static str {
        match self.kind {
            Kind::Parts { needs_scene: false, .. } => "",
            Kind::Parts { needs_scene: true, .. } => " SCENE",
            Kind::Study { scenes: [], .. } => " SCENE...",
            Kind::Study { .. } => " [SCENE...]",
        }
    }

    /// The report of what measuring found.
    pub fn report(&self, context: &Context, tables: Vec<Table>) -> Report {
        let mut facts = vec![
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("threads".to_owned(), context.settings.threads.to_string()),
            ("samples a case".to_owned(), context.settings.repeats.to_string()),
        ];
        if let Some(Session { world, .. }) = context.session {
            let triangles: usize = world.scene.meshes.iter().map(|m| m.triangles.len()).sum();
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
