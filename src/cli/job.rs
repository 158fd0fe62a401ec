//! A render command, checked as far as possible before the scene is read.

use super::args::RenderArgs;
use super::exit::Failure;
use super::live::Previews;
use super::outputs::{Inputs, OutputCheck};
use super::picture::Forms;
use super::picture_args::{PictureArgs, StatsFormat};
use super::still_files::StillFiles;
use super::values::{ProgressMode, Resolution};
use super::{job_key, talk, threads, verify};
use anyhow::anyhow;
use base::stats::Stopwatch;
use readers::LoadOptions;
use render::session::{Feature, Goal, Session};
use serde_json::json;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use world::view::Framing;

/// A validated render: scene, method and output files.
#[derive(Debug)]
pub struct RenderJob {
    /// Scene file.
    pub scene: PathBuf,
    /// Options of the scene reader.
    pub reading: LoadOptions,
    /// Files to write. Their folder is writable.
    pub files: StillFiles,
    /// Previews while it is rendered.
    pub previews: Previews,
    /// True if nothing is rendered or written.
    pub dry_run: bool,
    /// True if an existing image with the same key is not rendered again.
    pub resume: bool,
    /// True if the files must depend on scene and settings alone.
    pub reproducible: bool,
    /// Method, goal, and measurement of the error.
    pub goal: Goal,
    /// Forms of the files.
    pub forms: Forms,
    /// Number of threads.
    pub threads: usize,
    /// Frame of the camera path; `None` for the still camera.
    pub frame: Option<usize>,
    /// Film size instead of the scene's.
    size: Option<Resolution>,
    /// Part of the film, as offset and size in pixels.
    crop: Option<[[u32; 2]; 2]>,
    /// Start of the run.
    pub run: Stopwatch,
    /// Format of the statistics on stdout.
    pub stats: Option<StatsFormat>,
    /// Form of the messages on stderr.
    pub progress: ProgressMode,
}

/// Warns of layers that a PNG alone cannot hold; an error with `--strict`.
pub fn say_left_out(picture: &PictureArgs) -> Result<(), Failure> {
    let names: Vec<&str> = picture.aov.iter().map(|feature| feature.name()).collect();
    if names.is_empty() {
        return Ok(());
    }
    let transparent = match picture.aov.contains(&Feature::Alpha) {
        true => "; a PNG with alpha needs --background none",
        false => "",
    };
    let said = format!(
        "a PNG has no layers, so --aov {} is not written; name an OpenEXR file with -o{transparent}",
        names.join(",")
    );
    match picture.reading.strict {
        true => Err(Failure::usage(anyhow!(said))),
        false => {
            talk::warning(&said);
            Ok(())
        }
    }
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
        let files = StillFiles::new(&args)?;
        if files.exr.is_none() {
            say_left_out(&args.picture)?;
        }
        let (averaging, features, forms) =
            (args.picture.averaging(), args.picture.features(), args.picture.forms());
        let dry_run = args.picture.dry_run;
        let check = OutputCheck { may_stay: args.picture.resume, is_dry: dry_run };
        files.check(check, args.picture.no_overwrite)?;
        let previews = Previews::new(args.picture.live, args.png.tone.tone(), check)?;
        Inputs::default().check_apart(files.paths().chain(previews.file()))?;
        if args.picture.resume && files.exr.is_none() {
            return Err(Failure::usage(anyhow!("--resume needs an OpenEXR file; name one with -o")));
        }
        let goal = Goal {
            method,
            may_choose,
            plan,
            averaging,
            features,
            denoise: args.picture.denoise.denoise(),
            denoise_quality: args.picture.denoise.quality(),
            keep_noisy: args.picture.denoise.keep_noisy,
            is_last: false,
            verify,
        };
        args.picture.denoise.check(goal.denoises())?;
        if args.picture.reproducible && args.plan.time.is_some() {
            return Err(Failure::usage(anyhow!(
                "--reproducible excludes --time, whose settings differ between runs; use --quality or --error"
            )));
        }
        Ok(RenderJob {
            reading: args.picture.reading.options_at(&args.scene, args.frame.map(NonZeroUsize::get)),
            scene: args.scene,
            files,
            previews,
            dry_run,
            resume: args.picture.resume,
            reproducible: args.picture.reproducible,
            goal,
            forms,
            threads: threads::count(args.picture.threads),
            frame: args.frame.map(NonZeroUsize::get),
            size: args.picture.resolution,
            crop: args.picture.crop.map(|crop| [crop.offset, crop.size]),
            run,
            stats: args.stats,
            progress: args.picture.progress,
        })
    }

    /// Returns the key of the image.
    pub fn key(&self, session: &Session) -> String {
        let tone = self.files.png.as_ref().map(|(_, tone)| tone.to_string());
        let framing = format!("{:?}", self.framing(session));
        job_key::job_key(
            session,
            &self.goal,
            job_key::files(json!([framing, tone, self.reproducible]), self.forms),
        )
    }

    /// Returns frame, film size and crop.
    pub fn framing(&self, session: &Session) -> Framing {
        let resolution = self.size.map(|size| size.pixels(session.cameras.resolution));
        Framing { frame: self.frame, resolution, crop: self.crop }
    }
}
