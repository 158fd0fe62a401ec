//! `lightsplat bench`: measures, prints a table, writes the report where it is wanted. Studies are run by `study`.

use super::bench_args::{BenchArgs, StudyArgs};
use super::exit::Failure;
use super::{scene, study, talk};
use crate::bench::export::{WRITERS, terminal};
use crate::bench::{Benchmark, Context, Kind, REGISTRY, Settings};
use crate::film::{ImageError, atomic};
use anyhow::{Context as _, anyhow};
use std::io::Write;
use std::path::Path;

/// What `--help` lists.
pub fn list() -> String {
    let line = |b: &Benchmark| format!("  {:<18}{}\n", format!("{}{}", b.name, b.operand()), b.about);
    format!("Benchmarks:\n{}", REGISTRY.iter().map(line).collect::<String>())
}

/// Runs the command.
pub fn run(args: BenchArgs) -> Result<(), Failure> {
    let Some(benchmark) = Benchmark::named(&args.benchmark) else {
        return Err(Failure::usage(anyhow!("there is no benchmark {}", args.benchmark)));
    };
    let name = benchmark.name;
    let (needs_scene, measure) = match benchmark.kind {
        Kind::Study { .. } => return study::run(benchmark, args),
        Kind::Parts { needs_scene, run } => (needs_scene, run),
    };
    let remedy = match (needs_scene, args.scenes.len()) {
        (true, 1) | (false, 0) => None,
        (true, 0) => Some("name a scene behind it"),
        (true, _) => Some("name one scene only"),
        (false, _) => Some("leave the scene out"),
    };
    if let Some(remedy) = remedy {
        return Err(Failure::usage(anyhow!("bench {name}: {remedy}")));
    }
    if args.study != StudyArgs::default() {
        return Err(Failure::usage(anyhow!(
            "bench {name}: the options under \"Studies\" would have no effect"
        )));
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
    let pool = pool(settings.threads)?;
    let session = args.scenes.first().map(|path| pool.install(|| scene::open(path, false))).transpose()?;
    let report = pool.install(|| {
        let session = session.as_ref().map(|(session, _)| session);
        let context = Context { session, settings, say: &|what| talk::note(what) };
        benchmark.report(&context, measure(&context))
    });
    talk::print(&terminal(&report))?;
    for (format, path) in WRITERS.iter().zip(exports) {
        if let Some(path) = path {
            write(path, &format(&report))?;
        }
    }
    Ok(())
}

/// Threads to work on.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool, Failure> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    built
        .with_context(|| format!("cannot start {threads} threads; try fewer with --threads"))
        .map_err(Failure::render)
}

/// Writes text to a file, whole or not at all.
pub fn write(path: &Path, text: &str) -> Result<(), Failure> {
    atomic::write_atomically(path, |file| file.write_all(text.as_bytes()))
        .map_err(|source| ImageError::Write { path: path.to_owned(), source })
        .map_err(Failure::output)?;
    talk::note(&format!("wrote {}", path.display()));
    Ok(())
}
