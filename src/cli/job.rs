//! A render command, checked as far as possible before the scene is read.

use super::args::{RenderArgs, StatsFormat};
use super::exit::Failure;
use super::outputs::check_outputs;
use super::values::ProgressMode;
use super::{job_key, threads, verify};
use anyhow::anyhow;
use base::film::Exposure;
use base::stats::Stopwatch;
use readers::LoadOptions;
use render::session::{Goal, Session};
use render::walk::names::numbered;
use serde_json::json;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use world::view::Framing;

/// A validated render: scene, method and output files.
#[derive(Debug)]
pub struct RenderJob {
    /// Scene file.
    pub scene: PathBuf,
    /// Options of the scene reader.
    pub reading: LoadOptions,
    /// OpenEXR file. Its folder is writable.
    pub output: PathBuf,
    /// PNG file and its exposure.
    pub png: Option<(PathBuf, Exposure)>,
    /// True if an existing image with the same key is not rendered again.
    pub resume: bool,
    /// True if the files must depend on scene and settings alone.
    pub reproducible: bool,
    /// Method, goal, and measurement of the error.
    pub goal: Goal,
    /// Number of threads.
    pub threads: usize,
    /// Frame, film size and crop that replace those of the scene.
    pub framing: Framing,
    /// Start of the run.
    pub run: Stopwatch,
    /// Format of the statistics on stdout.
    pub stats: Option<StatsFormat>,
    /// Form of the messages on stderr.
    pub progress: ProgressMode,
}

impl RenderJob {
    /// Checks the arguments, and that the results can be written. The run began with `run`.
    ///
    /// # Errors
    /// If the arguments are wrong or a result cannot be written.
    pub fn new(args: RenderArgs, run: Stopwatch) -> Result<RenderJob, Failure> {
        let pinned = args.method.pinned();
        let may_choose = args.method.is_open();
        let method = args.plan.method(args.method.method()?, &pinned)?;
        let verify = verify::settings(&args.verify, &method, args.plan.error.is_some());
        let plan = args.plan.goal(&method, pinned, args.verify.verify_samples, run)?;
        let (output, png) = RenderJob::files(&args)?;
        check_outputs(&output, png.as_deref(), args.picture.resume)?;
        let goal = Goal {
            method,
            may_choose,
            plan,
            features: args.picture.aov.into_iter().collect(),
            denoise: args.picture.denoise.denoise(),
            denoise_quality: args.picture.denoise.quality(),
            keep_noisy: args.picture.denoise.keep_noisy,
            verify,
        };
        args.picture.denoise.check(goal.denoises())?;
        if args.picture.reproducible && args.plan.time.is_some() {
            return Err(Failure::usage(anyhow!(
                "--reproducible does not go with --time, whose settings differ from run to run; use --quality or --error"
            )));
        }
        Ok(RenderJob {
            scene: args.scene,
            reading: args.picture.reading.options(),
            output,
            png: png.map(|path| (path, args.png.exposure)),
            resume: args.picture.resume,
            reproducible: args.picture.reproducible,
            goal,
            threads: threads::count(args.picture.threads),
            framing: Framing {
                frame: args.frame.map(NonZeroUsize::get),
                resolution: args.picture.resolution.map(|r| r.0),
                crop: args.picture.crop.map(|crop| [crop.offset, crop.size]),
            },
            run,
            stats: args.stats,
            progress: args.picture.progress,
        })
    }

    /// Returns the OpenEXR and the PNG file of a command, with the number of the frame where a name has a place for it.
    ///
    /// # Errors
    /// If a name has such a place and the command names no frame.
    pub fn files(args: &RenderArgs) -> Result<(PathBuf, Option<PathBuf>), Failure> {
        let frame = args.frame.map(NonZeroUsize::get);
        let numbered = |option: &str, path: &Path| {
            numbered(path, frame)
                .map_err(|what| Failure::usage(anyhow!("{option} {}: {what}", path.display())))
        };
        let output = numbered("--output", &args.output)?;
        let png = args.png.file(&output).map(|path| numbered("--png", &path)).transpose()?;
        Ok((output, png))
    }

    /// Returns the key of the image.
    pub fn key(&self, session: &Session) -> String {
        let exposure = self.png.as_ref().map(|(_, exposure)| exposure.to_string());
        job_key::of(session, &self.goal, json!([format!("{:?}", self.framing), exposure, self.reproducible]))
    }
}
