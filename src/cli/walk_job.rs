//! A walk command that has been checked as far as it can be without the scene.

use super::args::{StatsFormat, WalkArgs};
use super::exit::Failure;
use super::job::check_outputs;
use super::plan_args::PlanArgs;
use super::threads;
use super::values::ProgressMode;
use crate::film::{Exposure, ExrFile, Metadata};
use crate::scene::formats::LoadOptions;
use crate::scene::formats::fnv1a;
use crate::session::{Goal, Session, Wanted};
use crate::view::Framing;
use crate::walk::{FileNames, FrameList, KeepLimits};
use anyhow::anyhow;
use serde_json::json;
use std::path::PathBuf;

/// A validated walk: scene, method, frames and their files.
#[derive(Debug)]
pub struct WalkJob {
    /// Scene file.
    pub scene: PathBuf,
    /// Reading of the scene.
    pub reading: LoadOptions,
    /// Frames; `None` for all of the path.
    pub frames: Option<FrameList>,
    /// True if frames whose files are there are left out.
    pub resume: bool,
    /// Exposure of the PNG files, if they are wanted.
    pub exposure: Option<Exposure>,
    /// Method and features.
    pub goal: Goal,
    /// Bounds of the records that are kept.
    pub limits: KeepLimits,
    /// Number of threads.
    pub threads: usize,
    /// Statistics on stdout.
    pub stats: Option<StatsFormat>,
    /// Progress on stderr.
    pub progress: ProgressMode,
    names: FileNames,
    framing: Framing,
}

impl WalkJob {
    /// Checks the arguments, and, if the frames are listed, that their files can be written.
    pub fn new(args: WalkArgs) -> Result<WalkJob, Failure> {
        let held = args.method.typed();
        let plan = PlanArgs { quality: args.quality, ..PlanArgs::default() };
        let goal = Goal {
            method: plan.method(args.method.method()?, &held),
            wanted: Wanted::AsSet,
            features: args.picture.aov.into_iter().collect(),
            denoise: args.picture.denoise.denoise(),
            keep_noisy: args.picture.denoise.keep_noisy,
            verify: None,
        };
        if goal.keep_noisy && !goal.denoises() {
            return Err(Failure::usage(anyhow!("--keep-noisy goes with --denoise")));
        }
        let defaults = KeepLimits::default();
        let bytes = args.memory_limit.map_or(defaults.bytes, |bytes| bytes.0);
        let job = WalkJob {
            scene: args.scene,
            reading: args.picture.reading.options(),
            frames: args.frames,
            resume: args.resume,
            exposure: (!args.no_png).then_some(args.exposure),
            goal,
            limits: KeepLimits { idle_frames: args.idle_frames, bytes },
            threads: threads::count(args.picture.threads),
            stats: args.stats,
            progress: args.picture.progress,
            names: args.output,
            framing: Framing {
                frame: None,
                resolution: args.picture.resolution.map(|r| r.0),
                crop: args.picture.crop.map(|crop| [crop.offset, crop.size]),
            },
        };
        let listed = job.frames.iter().flat_map(FrameList::iter);
        // Without a list the first frame speaks for all.
        for frame in listed.chain(job.frames.is_none().then_some(1)) {
            let (exr, png) = job.files(frame);
            check_outputs(&exr, png.as_deref())?;
        }
        Ok(job)
    }

    /// Files of a frame: OpenEXR and, if wanted, PNG.
    pub fn files(&self, frame: usize) -> (PathBuf, Option<PathBuf>) {
        let exr = self.names.of(frame);
        let png = self.exposure.map(|_| exr.with_extension("png"));
        (exr, png)
    }

    /// Framing of a frame.
    pub fn framing(&self, frame: usize) -> Framing {
        Framing { frame: Some(frame), ..self.framing }
    }

    /// Numbers of the frames to render.
    ///
    /// # Errors
    /// If the scene has no camera path, or a frame lies beyond it.
    pub fn numbers(&self, session: &Session) -> Result<Vec<usize>, Failure> {
        let frames = session.cameras.path.len();
        let scene = self.scene.display();
        if frames == 0 {
            return Err(Failure::input(anyhow!(
                "{scene} has no camera path: give a TOML scene keys in a table [camera.path], as in \
                 scenes/apartment.toml, or render its still camera by `lightsplat render`"
            )));
        }
        let Some(list) = &self.frames else { return Ok((1..=frames).collect()) };
        match list.last() {
            last if last > frames => Err(Failure::usage(anyhow!(
                "--frames: there is no frame {last}; the camera path of {scene} has {frames}, counted from 1"
            ))),
            _ => Ok(list.iter().collect()),
        }
    }

    /// Hash of all that decides what is in a frame's files, but for its number, the frames before it, and whether the
    /// denoiser is there.
    pub fn hash(&self, session: &Session) -> String {
        let Goal { method, features, keep_noisy, .. } = &self.goal;
        let decisive = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "scene": session.hash,
            "method": method.name(),
            "settings": method.settings(),
            "film": format!("{:?}", self.framing),
            "features": format!("{features:?}"),
            "denoise": self.goal.denoises(),
            "keep_noisy": keep_noisy,
            "exposure": self.exposure.map(|exposure| exposure.to_string()),
            "limits": format!("{:?}", self.limits),
        });
        format!("{:016x}", fnv1a(decisive.to_string().as_bytes()))
    }

    /// True if the files of a frame are whole and come of a job of this hash.
    pub fn is_done(&self, number: usize, hash: &str) -> bool {
        let (exr, png) = self.files(number);
        let is_it = |metadata: Metadata| {
            metadata.text("job") == Some(hash)
                && metadata.number("frame") == Some(number as f64)
                && metadata.text("partial") == Some("false")
        };
        ExrFile::read(&exr).is_ok_and(|file| file.color().is_ok() && is_it(file.metadata()))
            && png.is_none_or(|png| image::open(png).is_ok())
    }
}
