//! `lightsplat bench`: measures, prints a table, writes the report where it is wanted.

use super::bench_args::BenchArgs;
use super::exit::Failure;
use super::{scene, talk};
use crate::bench::export::{FORMATS, terminal};
use crate::bench::{Benchmark, Context, REGISTRY, Settings};
use crate::image::{ImageError, atomic};
use crate::world::World;
use anyhow::{Context as _, anyhow};
use std::io::Write;
use std::path::Path;

/// What `--help` lists.
pub fn list() -> String {
    let line = |b: &Benchmark| {
        let scene = if b.needs_scene { " SCENE" } else { "" };
        format!("  {:<14}{}\n", format!("{}{scene}", b.name), b.about)
    };
    format!("Benchmarks:\n{}", REGISTRY.iter().map(line).collect::<String>())
}

/// Runs the command.
pub fn run(args: BenchArgs) -> Result<(), Failure> {
    let Some(benchmark) = Benchmark::named(&args.benchmark) else {
        return Err(Failure::usage(anyhow!("there is no benchmark {}", args.benchmark)));
    };
    if benchmark.needs_scene != args.scene.is_some() {
        let remedy = if benchmark.needs_scene { "name a scene behind it" } else { "leave the scene out" };
        return Err(Failure::usage(anyhow!("bench {}: {remedy}", benchmark.name)));
    }
    let exports = [&args.export_json, &args.export_csv, &args.export_markdown, &args.export_html];
    for path in exports.into_iter().flatten() {
        atomic::check_writable(path).map_err(Failure::output)?;
    }
    let defaults = Settings::default();
    let processors = || std::thread::available_parallelism().map_or(1, |n| n.get());
    let settings = Settings {
        threads: args.threads.map_or_else(processors, |n| n as usize),
        repeats: args.repeats.map_or(defaults.repeats, |n| n as usize),
        seconds: args.seconds.unwrap_or(defaults.seconds),
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(settings.threads)
        .build()
        .with_context(|| format!("cannot start {} threads; try fewer with --threads", settings.threads))
        .map_err(Failure::render)?;
    let world = match &args.scene {
        None => None,
        Some(path) => {
            let loaded = scene::read(path, false)?;
            let built = World::new(loaded.scene, settings.threads);
            let built = built.with_context(|| format!("cannot build {}", path.display()));
            Some(built.map_err(Failure::render)?)
        }
    };
    let report = pool.install(|| {
        benchmark.run(&Context { world: world.as_ref(), settings, say: &|what| talk::note(what) })
    });
    talk::print(&terminal(&report))?;
    for (format, path) in FORMATS.iter().zip(exports) {
        if let Some(path) = path {
            write(path, &(format.write)(&report))?;
        }
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    atomic::write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(|source| ImageError::Write { path: path.to_owned(), source })
        .map_err(Failure::output)?;
    talk::note(&format!("wrote {}", path.display()));
    Ok(())
}
