//! Benchmarks that render whole images: runs a study, prints its tables, and writes its files into one folder.

use super::bench_args::BenchArgs;
use super::exit::Failure;
use super::files::write;
use super::{interrupt, talk, threads};
use anyhow::{Context as _, anyhow};
use base::progress::Control;
use bench::study::{PeerFigure, Plan, ReferenceSettings, Study, StudyError, file_of};
use bench::{Benchmark, Kind};
use render::session::OpenError;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Runs the study.
pub fn run(benchmark: &Benchmark, args: BenchArgs) -> Result<(), Failure> {
    let name = benchmark.name;
    if args.export_json.is_some() || args.export_markdown.is_some() || args.seconds.is_some() {
        return Err(Failure::usage(anyhow!(
            "bench {name} writes JSON and Markdown into --output FOLDER, and has no --seconds"
        )));
    }
    if args.study.with.is_some() && name != "race" {
        return Err(Failure::usage(anyhow!(
            "bench {name}: --with would have no effect; it is for bench race"
        )));
    }
    let Kind::Study { scenes, pixels, run } = &benchmark.kind else {
        return Err(Failure::usage(anyhow!("{name} is not a study")));
    };
    let files = scene_files(&args, scenes);
    if files.is_empty() {
        return Err(Failure::usage(anyhow!("bench {name}: add the scenes to render: SCENE is missing")));
    }
    let peers = args.study.with.as_deref().map(PeerFigure::read).transpose().map_err(failure)?;
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    let defaults = ReferenceSettings::default();
    let folder = args.study.output.unwrap_or_else(|| Path::new("out").join(name));
    let plan = Plan {
        folder: folder.clone(),
        threads: threads::count(args.threads),
        repeats: args.repeats.map_or(1, |n| n as usize),
        resolution: args.study.resolution.map_or(*pixels, |size| size.pixels(*pixels)),
        reference: ReferenceSettings {
            spp: args.study.reference_spp.unwrap_or(defaults.spp),
            seconds: args.study.reference_seconds.unwrap_or(defaults.seconds),
        },
        knobs: args.study.knobs,
        peers: peers.unwrap_or_default(),
    };
    let pool = threads::pool(plan.threads)?;
    let study = Study::new(plan, &control, &|what| talk::note(what)).map_err(failure)?;
    let mut results = pool.install(|| run(&study, &files)).map_err(failure)?;
    results.conclude();
    let markdown = results.document.markdown();
    talk::print(markdown)?;
    let file = |extension: &str| folder.join(name).with_extension(extension);
    for (name, text) in results.document.files() {
        write(&folder.join(name), text)?;
    }
    write(&file("json"), &format!("{:#}\n", results.json))?;
    write(&file("md"), markdown)
}

/// Returns the scenes given, else the study's own.
fn scene_files(args: &BenchArgs, scenes: &[&str]) -> Vec<PathBuf> {
    let folder = args.study.scene_folder.as_deref().unwrap_or(Path::new("scenes"));
    if args.scenes.is_empty() {
        return scenes.iter().map(|name| file_of(Path::new(name), folder)).collect();
    }
    args.scenes.iter().map(|scene| file_of(scene, folder)).collect()
}

fn failure(error: StudyError) -> Failure {
    match error {
        StudyError::Open(OpenError::Scene(_)) | StudyError::Input(_) => Failure::input(error),
        StudyError::Usage(_) => Failure::usage(error),
        StudyError::Open(OpenError::Build { .. }) | StudyError::Render(_) => Failure::render(error),
        StudyError::Output(_) => Failure::output(error),
        StudyError::Interrupted => Failure::interrupted(error),
    }
}
