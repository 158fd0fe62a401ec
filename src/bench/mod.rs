//! `lightsplat bench`: how fast parts of the renderer are, on whatever scene the user brings.
//!
//! A benchmark is an entry of [`REGISTRY`]: it measures cases against each other (`measure`) and returns a [`Report`] of
//! tables whose first figure is a ratio, for ratios hold from one machine to the next better than rates do.
//! [`export`] writes reports, one format a file. Nothing here decides how a picture is made.

mod bounds;
mod bsdf;
pub mod export;
mod hsh;
mod measure;
mod report;
mod setting;
mod shadow;
mod trees;

pub use measure::{Clock, Warning};
pub use report::{Report, Row, Spread, Table};

use crate::world::World;

/// A benchmark that can be asked for by name.
pub struct Benchmark {
    /// Name on the command line.
    pub name: &'static str,
    /// What it measures, in a line.
    pub about: &'static str,
    /// Whether it measures on a scene.
    pub needs_scene: bool,
    run: fn(&Context) -> Vec<Table>,
}

/// All benchmarks.
pub const REGISTRY: [Benchmark; 5] =
    [shadow::BENCHMARK, bounds::BENCHMARK, trees::BENCHMARK, bsdf::BENCHMARK, hsh::BENCHMARK];

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
    pub world: Option<&'a World>,
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

    /// Measures.
    pub fn run(&self, context: &Context) -> Report {
        let tables = (self.run)(context);
        let mut facts = vec![
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("threads".to_owned(), context.settings.threads.to_string()),
            ("samples a case".to_owned(), context.settings.repeats.to_string()),
        ];
        if let Some(world) = context.world {
            let triangles: usize = world.scene.meshes.iter().map(|m| m.triangles.len()).sum();
            facts.push(("triangles".to_owned(), triangles.to_string()));
            facts.push(("Embree".to_owned(), world.accel.device().version().to_string()));
            facts.push(("widest packet".to_owned(), world.accel.widest().rays().to_string()));
        }
        Report {
            benchmark: self.name.to_owned(),
            scene: context.world.map(|w| w.scene.name.clone()),
            facts,
            tables,
        }
    }
}
