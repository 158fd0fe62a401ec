//! `lightsplat bench`: measures, prints a table, writes the report where it is wanted. Studies are run by `study`.

use super::bench_args::{BenchArgs, StudyArgs};
use super::exit::Failure;
use super::outputs::Inputs;
use super::{bench_args, files, opened, study, talk, threads};
use anyhow::anyhow;
use base::film::atomic;
use bench::{Context, Kind, Settings, machine};
use readers::LoadOptions;
use std::path::PathBuf;

/// Runs the command.
pub fn run(args: BenchArgs) -> Result<(), Failure> {
    let Some(name) = &args.benchmark else { return talk::print(&bench_args::list()) };
    let Some(benchmark) = bench::named(name) else {
        return Err(Failure::usage(anyhow!("there is no benchmark {name}")));
    };
    let name = benchmark.name;
    let measure = match benchmark.kind {
        Kind::Study { .. } => return study::run(benchmark, args),
        Kind::Parts(measure) => measure,
    };
    let [scene] = &args.scenes[..] else {
        return Err(Failure::usage(anyhow!("bench {name}: give one scene to measure, as SCENE")));
    };
    if args.study != StudyArgs::default() {
        return Err(Failure::usage(anyhow!(
            "bench {name}: the options under \"Studies\" would have no effect"
        )));
    }
    let exports = [&args.export_json, &args.export_markdown];
    for path in exports.into_iter().flatten() {
        atomic::check_writable(path).map_err(Failure::output)?;
    }
    let files = || exports.into_iter().flatten().map(PathBuf::as_path);
    Inputs::new(&args.scenes).check_apart(files())?;
    let defaults = Settings::default();
    let settings = Settings {
        threads: threads::count(args.threads),
        repeats: args.repeats.map_or(defaults.repeats, |n| n as usize),
        seconds: args.seconds.unwrap_or(defaults.seconds),
    };
    let machine = machine::facts(settings.threads);
    let pool = threads::pool(settings.threads)?;
    let session = pool.install(|| opened::open(scene, &LoadOptions::default()))?.session;
    Inputs::of_session(&session).check_apart(files())?;
    let results = pool.install(|| {
        let context = Context { session: &session, settings, machine, say: &|what| talk::note(what) };
        benchmark.results(&context, &measure(&context))
    });
    let (json, markdown) = (format!("{:#}\n", results.json), results.document.markdown());
    talk::print(markdown)?;
    for (path, text) in exports.into_iter().zip([&*json, markdown]) {
        path.as_deref().map_or(Ok(()), |path| files::write(path, text))?;
    }
    Ok(())
}
