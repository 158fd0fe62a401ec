//! A benchmark, and its inputs.

use super::machine::Facts;
use super::report::Table;
use super::results::Results;
use super::study::{Study, StudyError};
use render::session::Session;
use std::path::PathBuf;

/// A benchmark that can be chosen by name.
pub struct Benchmark {
    /// Name on the command line.
    pub name: &'static str,
    /// Description in a line.
    pub about: &'static str,
    /// Kind of benchmark.
    pub kind: Kind,
}

/// Kinds of benchmarks.
pub enum Kind {
    /// Parts of the renderer.
    ///
    /// The function measures them on a scene.
    Parts(fn(&Context) -> Vec<Table>),
    /// Whole images.
    Study {
        /// Names of the default scenes. If there are none, the user must name scenes.
        scenes: &'static [&'static str],
        /// Default width and height of the images.
        pixels: [u32; 2],
        /// Function that answers the study's questions about scene files.
        run: fn(&Study, &[PathBuf]) -> Result<Results, StudyError>,
    },
}

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
    /// The scene.
    pub session: &'a Session,
    /// Settings of measurements.
    pub settings: Settings,
    /// Facts about machine and program, found before anything is measured.
    pub machine: Facts,
    /// Callback for progress messages.
    pub say: &'a dyn Fn(&str),
}

impl Benchmark {
    /// Returns the name of its operand in the usage.
    pub fn operand(&self) -> &'static str {
        match self.kind {
            Kind::Parts(_) => " SCENE",
            Kind::Study { scenes: [], .. } => " SCENE...",
            Kind::Study { .. } => " [SCENE...]",
        }
    }

    /// Makes results of measured tables.
    pub fn results(&self, context: &Context, tables: &[Table]) -> Results {
        let mut facts = context.machine.clone();
        facts.push(("samples per case".to_owned(), context.settings.repeats.to_string()));
        let scene = &context.session.world.scene;
        facts.push(("triangles".to_owned(), scene.seen_triangle_count().to_string()));
        let mut results = Results::new(&format!("{} on {}", self.name, scene.name), facts, "");
        (results.json["benchmark"], results.json["scene"]) = (self.name.into(), (&*scene.name).into());
        results.add(tables);
        results.conclude();
        results
    }
}
