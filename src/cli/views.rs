//! `lightsplat views`: renders the cameras of a list. A walk renders them, whose frames follow no path.

use super::exit::Failure;
use super::live::Previews;
use super::outputs::{OutputCheck, check_output};
use super::shots::{Shots, ViewFiles};
use super::views_args::ViewsArgs;
use super::walk_job::{self, WalkJob};
use super::{talk, threads, walk};
use anyhow::{Context, anyhow};
use readers::ViewList;
use render::session::Goal;
use render::walk::{FrameList, RetentionLimits};
use std::fs;
use std::path::PathBuf;

/// Runs the command.
pub fn run(args: ViewsArgs) -> Result<(), Failure> {
    talk::start(args.picture.progress, args.picture.loudness(), "views");
    walk::run_job(job(args)?)
}

/// Checks the arguments and the list, and that the files can be written.
///
/// # Errors
/// If the arguments or the list are wrong, or a file cannot be written.
pub fn job(args: ViewsArgs) -> Result<WalkJob, Failure> {
    args.picture.reading.check_unplaced(&format!("the cameras of {}", args.cameras.display()), true)?;
    walk_job::check_records(&args.method, [("--set memory-limit", args.memory_limit.is_some())])?;
    let views = listed(&args)?;
    let goal = Goal {
        denoise_quality: args.picture.denoise.quality(),
        ..walk_job::goal(&args.method, args.quality, &args.picture)?
    };
    let defaults = RetentionLimits::default();
    let check = OutputCheck { may_stay: args.picture.resume, is_dry: args.picture.dry_run };
    let (no_overwrite, forms) = (args.picture.no_overwrite, args.picture.forms());
    let job = WalkJob {
        reading: args.picture.reading.options_at(&args.scene, None),
        scene: args.scene,
        frames: args.only,
        chunk: args.chunk,
        resume: args.picture.resume,
        reproducible: args.picture.reproducible,
        tone: (!args.no_png).then_some(args.tone.tone()),
        previews: Previews::new(args.picture.live, args.tone.tone(), check)?,
        dry_run: args.picture.dry_run,
        goal,
        limits: RetentionLimits {
            // Any view may show what any view before it has shown.
            idle_frames: u32::MAX,
            bytes: args.memory_limit.map_or(defaults.bytes, |bytes| bytes.0),
            reprojects: false,
            q_scale: None,
        },
        forms,
        movie: None,
        jobs: args.jobs.get(),
        threads: threads::count(args.picture.threads),
        stats: args.stats,
        progress: args.picture.progress,
        shots: Shots::Views(Box::new(views)),
        size: args.picture.resolution,
        crop: args.picture.crop.map(|crop| [crop.offset, crop.size]),
    };
    check_files(&job, check, no_overwrite)?;
    Ok(job)
}

/// Returns the files that a command writes, without checking that it can.
///
/// # Errors
/// If the list is wrong.
pub fn files(args: &ViewsArgs) -> Result<Vec<PathBuf>, Failure> {
    let views = listed(args)?;
    Ok(views.numbers(args.only.as_ref()).into_iter().map(|number| views.exr(number)).collect())
}

/// Reads the list.
fn listed(args: &ViewsArgs) -> Result<ViewFiles, Failure> {
    let options = args.picture.reading.clone().options();
    let list = ViewList::read(&args.cameras, &options).map_err(Failure::input)?;
    let views = ViewFiles { list, folder: args.output.clone(), exposes_each: args.exposure_per_view };
    match args.only.as_ref().map(FrameList::last).filter(|last| *last > views.last()) {
        Some(last) => Err(Failure::usage(anyhow!(
            "--only: there is no view {last}; {} has {} cameras, counted from 1",
            args.cameras.display(),
            views.last()
        ))),
        None => Ok(views),
    }
}

/// Checks that the files can be written. The folder is made if it alone is missing, and the folders below it are.
fn check_files(job: &WalkJob, check: OutputCheck, no_overwrite: bool) -> Result<(), Failure> {
    let Some(views) = job.shots.views() else { return Ok(()) };
    check_output(&views.folder.join("view.exr"), check)?;
    for number in views.numbers(job.frames.as_ref()) {
        let files = job.files(number);
        if let Some(folder) = files.main().parent().filter(|folder| !folder.exists()) {
            if check.is_dry {
                continue;
            }
            let made = fs::create_dir_all(folder);
            made.with_context(|| format!("cannot make {}", folder.display())).map_err(Failure::output)?;
        }
        files.check(check, no_overwrite)?;
    }
    Ok(())
}
