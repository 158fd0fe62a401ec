//! A walk command, checked as far as possible before the scene is read. The views of a list are a walk, too.

use super::args::WalkArgs;
use super::exit::Failure;
use super::live::Previews;
use super::method_args::MethodArgs;
use super::movie::Movie;
use super::outputs::{OutputCheck, check_output};
use super::picture::Forms;
use super::picture_args::{PictureArgs, StatsFormat};
use super::plan_args::{PlanArgs, Quality};
use super::shots::{Shots, ViewFiles};
use super::still_files::StillFiles;
use super::values::{ProgressMode, Resolution};
use super::{job, job_key, threads};
use anyhow::anyhow;
use base::film::Tone;
use base::progress::Control;
use readers::LoadOptions;
use render::session::{Goal, PlanGoal, Session};
use render::walk::choice::{self, Sharing};
use render::walk::chunk::{self, FrameChunk, Run};
use render::walk::views::{ListedViews, ListedViewsError};
use render::walk::{FrameList, Q_SCALE, RetentionLimits, saved};
use serde_json::json;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use world::view::{Framing, View};

/// Frame whose pose a model takes when the scene of a walk is read.
pub const FIRST_POSE: usize = 1;

/// Extension of the files of records.
pub const RECORDS: &str = "records";

/// A validated walk: scene, method, frames and their files.
#[derive(Debug)]
pub struct WalkJob {
    /// Scene file.
    pub scene: PathBuf,
    /// Options of the scene reader.
    pub reading: LoadOptions,
    /// Frames to render; `None` for the whole path.
    pub frames: Option<FrameList>,
    /// Number of frames per chunk, which begins without records; `None` for one chunk.
    pub chunk: Option<NonZeroUsize>,
    /// True if existing frames with the same key are skipped.
    pub resume: bool,
    /// True if the files must depend on scene and settings alone.
    pub reproducible: bool,
    /// Exposure and view of the PNG files; `None` if there are none.
    pub tone: Option<Tone>,
    /// Previews while it is rendered.
    pub previews: Previews,
    /// True if nothing is rendered or written.
    pub dry_run: bool,
    /// Method and features.
    pub goal: Goal,
    /// Limits of the records that stay between frames.
    pub limits: RetentionLimits,
    /// Forms of the files.
    pub forms: Forms,
    /// Movie of the frames, if there is to be one.
    pub movie: Option<Movie>,
    /// Maximum number of chunks that are rendered at a time.
    pub jobs: usize,
    /// Number of threads.
    pub threads: usize,
    /// Format of the statistics on stdout.
    pub stats: Option<StatsFormat>,
    /// Form of the messages on stderr.
    pub progress: ProgressMode,
    /// Frames of the camera path or views of a list, with their files.
    pub shots: Shots,
    /// Film size instead of the scene's.
    pub size: Option<Resolution>,
    /// Part of the film, as offset and size in pixels.
    pub crop: Option<[[u32; 2]; 2]>,
}

impl WalkJob {
    /// Checks the arguments, and, if the frames are listed, that their files can be written.
    ///
    /// # Errors
    /// If the arguments are wrong or a file cannot be written.
    pub fn new(args: WalkArgs) -> Result<WalkJob, Failure> {
        if args.turntable.is_none() {
            args.picture.reading.check_unplaced("the camera path of the scene", false)?;
        }
        check_exr(&args)?;
        let movie = args.movie.clone().map(Movie::new).transpose()?;
        let of_records = [
            ("--set memory-limit", args.memory_limit.is_some()),
            ("--set idle-frames", args.idle_frames.is_some()),
            ("--set q-scale", args.q_scale.is_some()),
            ("--set no-reprojection", args.no_reprojection),
        ];
        check_records(&args.method, of_records)?;
        let goal = goal(&args.method, args.quality, &args.picture)?;
        let defaults = RetentionLimits::default();
        let q_scale = args.q_scale.unwrap_or(Q_SCALE);
        let bytes = args.memory_limit.map_or(defaults.bytes, |bytes| bytes.0);
        let no_overwrite = args.picture.no_overwrite;
        let check = OutputCheck { may_stay: args.picture.resume, is_dry: args.picture.dry_run };
        let job = WalkJob {
            reading: reading(&args),
            forms: args.picture.forms(),
            movie,
            jobs: 1,
            scene: args.scene,
            frames: args.frames,
            chunk: args.chunk,
            resume: args.picture.resume,
            reproducible: args.picture.reproducible,
            tone: (!args.no_png).then_some(args.tone.tone()),
            previews: Previews::new(args.picture.live, args.tone.tone(), check)?,
            dry_run: args.picture.dry_run,
            goal,
            limits: RetentionLimits {
                idle_frames: args.idle_frames.unwrap_or(defaults.idle_frames),
                bytes,
                reprojects: !args.no_reprojection,
                q_scale: (q_scale > 0.0).then_some(q_scale),
            },
            threads: threads::count(args.picture.threads),
            stats: args.stats,
            progress: args.picture.progress,
            shots: Shots::Path(args.output),
            size: args.picture.resolution,
            crop: args.picture.crop.map(|crop| [crop.offset, crop.size]),
        };
        let listed = job.frames.iter().flat_map(FrameList::iter);
        // Without a list the first frame stands for all.
        for frame in listed.chain(job.frames.is_none().then_some(1)) {
            job.files(frame).check(check, no_overwrite)?;
            let records = job.shots.file(frame).with_extension(RECORDS);
            check_output(&records, OutputCheck { may_stay: true, ..check })?;
        }
        if let Some(movie) = &job.movie {
            check_output(movie.file(), check)?;
        }
        Ok(job)
    }

    /// Returns the files of a frame: OpenEXR, and PNG if there is to be one, or PNG alone.
    pub fn files(&self, frame: usize) -> StillFiles {
        StillFiles::of_frame(self.shots.file(frame), self.tone)
    }

    /// Places the views of a list in the session's scene; returns `None` for the frames of a path.
    ///
    /// # Errors
    /// If a camera cannot be represented or a film cannot be rendered.
    pub fn listed(&self, session: &Session) -> Result<Option<ListedViews>, Failure> {
        let Some(views) = self.shots.views() else { return Ok(None) };
        let size = |own| self.size.map_or(own, |size| size.pixels(own));
        let placed = ListedViews::new(session, &views.list, size, self.crop);
        placed.map(Some).map_err(|error| match error {
            ListedViewsError::Scene(error) => Failure::input(error),
            ListedViewsError::Film { .. } => Failure::usage(error),
        })
    }

    /// Chooses one method for all images, if the command leaves it open. The choice depends on the whole path or list,
    /// so that every part of it has one method. Returns what there is to say.
    pub fn choose(
        &mut self,
        session: &Session,
        listed: Option<&ListedViews>,
        moves: bool,
        control: &Control,
    ) -> Option<String> {
        let path = || {
            let window = View::new(&session.cameras, &self.film(session)).ok()?.window;
            Some(session.cameras.path.iter().map(|camera| View { camera: *camera, window }).collect())
        };
        let views = listed.map_or_else(path, |listed| Some(listed.all().to_vec()))?;
        let chunk = self.chunk.map_or(views.len(), NonZeroUsize::get);
        let sharing = match self.shots {
            _ if moves || chunk < 2 => Sharing::Nothing,
            Shots::Path(_) => Sharing::Frames,
            Shots::Views(_) if self.reproducible => Sharing::Nothing,
            Shots::Views(_) => Sharing::Views,
        };
        let choice = choice::of_series(session, &views, &self.goal, sharing, control);
        let method = choice.map_or(self.goal.method, |choice| choice.method);
        // The choice was for denoised images, also if it is a method whose images are not denoised by default.
        let denoise = Some(self.goal.denoises());
        self.goal = Goal { method, may_choose: false, denoise, ..self.goal.clone() };
        choice.map(|choice| choice.text())
    }

    /// Returns the view of a frame. `listed` has the views of a list.
    ///
    /// # Errors
    /// If the frame cannot be framed.
    pub fn view(
        &self,
        frame: usize,
        session: &Session,
        listed: Option<&ListedViews>,
    ) -> Result<View, Failure> {
        if let Some(view) = listed.and_then(|listed| listed.numbered(frame)) {
            return Ok(*view);
        }
        let framing = Framing { frame: Some(frame), ..self.film(session) };
        View::new(&session.cameras, &framing).map_err(Failure::usage)
    }

    /// Returns film size and crop.
    fn film(&self, session: &Session) -> Framing {
        let resolution = self.size.map(|size| size.pixels(session.cameras.resolution));
        Framing { frame: None, resolution, crop: self.crop }
    }

    /// Returns the numbers of the frames to render.
    ///
    /// # Errors
    /// If the scene has no camera path, or a frame lies beyond it.
    pub fn numbers(&self, session: &Session) -> Result<Vec<usize>, Failure> {
        if let Some(views) = self.shots.views() {
            return Ok(views.numbers(self.frames.as_ref()));
        }
        let frames = session.cameras.path.len();
        let scene = self.scene.display();
        if frames == 0 {
            return Err(Failure::usage(anyhow!(
                "{scene} has no camera path; add --turntable 60, a table [camera.path] to a TOML scene, as in \
                 scenes/apartment.toml, or an animation to a glTF file; for a still, use `lightsplat render`"
            )));
        }
        let Some(list) = &self.frames else { return Ok((1..=frames).collect()) };
        match list.last() {
            last if last > frames => Err(Failure::usage(anyhow!(
                "--frames: there is no frame {last}; the camera path of {scene} has {frames} frames, counted from 1"
            ))),
            _ => Ok(list.iter().collect()),
        }
    }

    /// Returns the number of frames per chunk; `None` for one chunk.
    ///
    /// If the model moves, each frame is a chunk. Each reproducible view is a chunk, too: it depends on no other view.
    pub fn chunk_size(&self, moves: bool) -> Option<NonZeroUsize> {
        // Without records, frames do not depend on each other.
        let is_alone = moves || self.shots.views().is_some() && self.reproducible;
        let has_records = self.goal.method.as_walks().is_some() && !is_alone;
        if has_records { self.chunk } else { NonZeroUsize::new(1) }
    }

    /// Divides the frames into chunks, and decides which frames to render.
    ///
    /// # Errors
    /// If the scene has no camera path, or a frame lies beyond it.
    pub fn plan(&self, session: &Session, moves: bool) -> Result<Vec<PlannedChunk>, Failure> {
        let numbers = self.numbers(session)?;
        let key = job_key::job_key(
            session,
            &self.goal,
            job_key::files(
                json!([
                    format!("{:?}", self.film(session)),
                    self.tone.map(|tone| tone.to_string()),
                    format!("{:?}", self.limits),
                    self.reproducible,
                ]),
                self.forms,
            ),
        );
        let views = self.shots.views();
        let size = self.chunk_size(moves);
        let key = views.map_or(key.clone(), |views| job_key::of_views(&key, &views.list, views.exposes_each));
        let length = views.map_or(session.cameras.path.len(), ViewFiles::last);
        let chunks = chunk::chunks(&numbers, size, length);
        Ok(chunks.into_iter().map(|chunk| self.planned(chunk, &key)).collect())
    }

    /// Decides which frames of a chunk to render.
    fn planned(&self, chunk: FrameChunk, key: &str) -> PlannedChunk {
        let FrameChunk { frames, ends } = chunk;
        let keys: Vec<String> = (0..frames.len()).map(|i| job_key::of_frame(key, &frames[..=i])).collect();
        let is_done = |(number, key): (&usize, &String)| {
            let files = self.files(*number);
            let png = files.png.as_ref().map(|(path, _)| path.as_path());
            let is_done = |exr: &PathBuf| job_key::is_done(exr, png, Some(*number), key);
            self.resume && files.exr.as_ref().is_some_and(is_done)
        };
        let done: Vec<bool> = frames.iter().zip(&keys).map(is_done).collect();
        let mut chunk = PlannedChunk { frames, keys, done, ends, saved: None, runs: Vec::new() };
        chunk.saved = self.records_file(&chunk).filter(|_| self.resume).and_then(|path| {
            let (key, records) = saved::read(&path)?;
            Some((chunk.keys.iter().position(|known| *known == key)?, records))
        });
        chunk.runs = chunk::runs(&chunk.done, chunk.saved.as_ref().map(|(index, _)| *index));
        chunk
    }

    /// Returns the file of the records of a chunk; `None` if no frame can follow.
    pub fn records_file(&self, chunk: &PlannedChunk) -> Option<PathBuf> {
        let first = chunk.frames.first().filter(|_| chunk.frames.len() > 1 || !chunk.ends)?;
        Some(self.shots.file(*first).with_extension(RECORDS))
    }
}

/// Refuses options that need OpenEXR files, if the frames are PNG files alone, and warns of layers.
fn check_exr(args: &WalkArgs) -> Result<(), Failure> {
    let is_png = args.output.pattern().extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    let given = [("--resume", args.picture.resume), ("--no-png", args.no_png)];
    match given.into_iter().find(|(_, is_given)| is_png && *is_given) {
        Some((option, _)) => {
            Err(Failure::usage(anyhow!("{option} needs OpenEXR files; name them NAME.####.exr with -o")))
        }
        None if is_png => job::say_left_out(&args.picture),
        None => Ok(()),
    }
}

/// Returns the options of the scene reader for a walk.
pub fn reading(args: &WalkArgs) -> LoadOptions {
    let options = args.picture.reading.clone();
    let mut options = options.options_at(&args.scene, args.turntable.is_none().then_some(FIRST_POSE));
    options.viewpoint.turntable = args.turntable.map(NonZeroUsize::get);
    options
}

/// Refuses `options`, of which some are given, for a method without records that stay from image to image.
///
/// # Errors
/// If such an option is given.
pub fn check_records<const N: usize>(method: &MethodArgs, options: [(&str, bool); N]) -> Result<(), Failure> {
    let method = method.method()?;
    match options.into_iter().find(|(_, is_given)| *is_given && method.as_walks().is_none()) {
        Some((option, _)) => Err(Failure::usage(anyhow!(
            "{option} has no effect with --method {}, which keeps nothing from image to image; leave {option} out",
            method.name()
        ))),
        None => Ok(()),
    }
}

/// Returns the goal of the frames of a walk, or of the views of a list.
///
/// # Errors
/// If the arguments are wrong.
pub fn goal(method: &MethodArgs, quality: Option<Quality>, picture: &PictureArgs) -> Result<Goal, Failure> {
    let plan = PlanArgs { quality, ..PlanArgs::default() };
    let goal = Goal {
        method: plan.method(method.method()?, &method.pinned())?,
        may_choose: method.is_open(),
        plan: PlanGoal::AsSet,
        averaging: picture.averaging(),
        features: picture.features(),
        denoise: picture.denoise.denoise(),
        denoise_quality: Some(picture.denoise.quality().unwrap_or_default()),
        keep_noisy: picture.denoise.keep_noisy,
        is_last: false,
        verify: None,
    };
    picture.denoise.check(goal.denoises())?;
    Ok(goal)
}

/// Frames of a chunk and the state of their files.
#[derive(Debug)]
pub struct PlannedChunk {
    /// Numbers of the frames.
    pub frames: Vec<usize>,
    /// Keys of their files.
    pub keys: Vec<String>,
    /// Flag per frame: true if its files are complete.
    pub done: Vec<bool>,
    /// True if no later run can extend the chunk.
    pub ends: bool,
    /// Saved records, with the index of the frame after which they were saved.
    pub saved: Option<(usize, Vec<u8>)>,
    /// Frames to render.
    pub runs: Vec<Run>,
}

impl PlannedChunk {
    /// Returns the chunk without saved records.
    pub fn without_saved(self) -> PlannedChunk {
        PlannedChunk { runs: chunk::runs(&self.done, None), saved: None, ..self }
    }

    /// Returns the number of frames to render.
    pub fn count(&self) -> usize {
        self.runs.iter().map(|run| run.frames.len()).sum()
    }

    /// Returns the numbers of the frames that stay as they are.
    pub fn untouched(&self) -> impl Iterator<Item = usize> {
        self.frames.iter().zip(&self.done).filter(|(_, done)| **done).map(|(number, _)| *number)
    }

    /// Returns the numbers of the frames to write.
    pub fn unwritten(&self) -> impl Iterator<Item = usize> {
        self.frames.iter().zip(&self.done).filter(|(_, done)| !**done).map(|(number, _)| *number)
    }

    /// Returns true if no frame of the chunk can follow this one.
    pub fn is_last(&self, index: usize) -> bool {
        self.ends && index + 1 == self.frames.len()
    }
}
