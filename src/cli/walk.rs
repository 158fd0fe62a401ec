//! `lightsplat walk`: renders the frames of a camera path. Each file is complete before the next frame begins.

use super::args::WalkArgs;
use super::course::{RunProgress, RunSpan, Stages};
use super::exit::Failure;
use super::live::{Showing, ShownFrame};
use super::outputs::{self, Inputs};
use super::progress::Watch;
use super::side_by_side::SideBySide;
use super::values::ProgressMode;
use super::walk_job::{FIRST_POSE, PlannedChunk, WalkJob};
use super::walk_report::WalkReport;
use super::{dry_run, ids, interrupt, opened, picture, talk, threads};
use anyhow::{Context, anyhow};
use base::film::{Film, Image, Look, Tone};
use base::progress::Control;
use base::stats::{Stage, Stopwatch};
use readers::LoadOptions;
use render::session::{FrameError, Opened, Remark, RenderedFrame, Session};
use render::walk::saved::{self, Pace};
use render::walk::views::{ListedViews, Outlook};
use render::walk::{Walk, exposure};
use serde_json::json;
use std::collections::BTreeSet;
use std::fs;
use std::mem;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Runs the command.
pub fn run(args: WalkArgs) -> Result<(), Failure> {
    talk::start(args.picture.progress, args.picture.loudness(), "walk");
    run_job(WalkJob::new(args)?)
}

/// Runs a checked command: a walk, or the views of a list.
pub fn run_job(job: WalkJob) -> Result<(), Failure> {
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    threads::pool(job.threads)?.install(|| {
        let opened = opened::open(&job.scene, &job.reading)?;
        walk(job, &opened, RunSpan::begin(), &control)
    })
}

/// Renders the frames that do not exist yet, and reports the result. They take the part `span` of the run.
///
/// # Errors
/// If a frame cannot be rendered or written, or a signal interrupted the run.
pub fn walk(mut job: WalkJob, opened: &Opened, span: RunSpan, control: &Control) -> Result<(), Failure> {
    let Opened { session, warnings, moves, .. } = opened;
    opened::print_warnings(job.shots.views().map_or(&[], |views| views.list.warnings()));
    let listed = job.listed(session)?;
    let listed = listed.as_ref();
    if let Some(choice) = job.choose(session, listed, *moves, control) {
        talk::note(&choice);
    }
    let job = &job;
    let chunks = job.plan(session, *moves)?;
    let inputs = Inputs::of_session(session);
    for number in chunks.iter().flat_map(|chunk| &chunk.frames) {
        inputs.check_apart(job.files(*number).paths().chain(job.previews.file()))?;
    }
    for number in chunks.iter().flat_map(PlannedChunk::unwritten) {
        outputs::check_unprotected(job.files(number).paths())?;
    }
    if job.dry_run {
        return dry_run::walk(job, session, &chunks, listed);
    }
    if *moves {
        talk::note("the model moves: each frame is rendered without records of the frames before it");
    }
    let mut report = WalkReport::new(job.stats, job.shots.noun());
    for number in chunks.iter().flat_map(PlannedChunk::untouched) {
        report.skip();
        talk::event("frame", || json!({ "frame": number, "state": "skipped" }));
    }
    let count = chunks.iter().map(PlannedChunk::count).sum();
    let shares_records = count > 0 && job.goal.method.as_walks().is_some();
    let outlook = listed
        .filter(|_| shares_records)
        .map(|listed| listed.outlook(session, job.chunk_size(*moves), control));
    let outlook = outlook.as_ref();
    let first = chunks.iter().flat_map(PlannedChunk::unwritten).next();
    let look = first.map(|first| look(job, session, listed, first, control)).transpose()?.flatten();
    if first.is_some_and(|first| job.files(first).exr.is_some()) {
        ids::write_for(&job.goal, &job.shots.ids(), &session.world.scene)?;
    }
    let walking = Walking {
        job,
        shared: Shared { listed, outlook },
        warnings: warnings.len(),
        look,
        count,
        begun: AtomicUsize::new(0),
        report: Mutex::new(report),
        said: Mutex::default(),
    };
    walking.render(chunks, opened, span, control)?;
    let report = walking.report.into_inner().unwrap_or_else(PoisonError::into_inner);
    report.sum_up()?;
    match &job.movie {
        Some(movie) => movie.write(job.numbers(session)?.into_iter().map(|number| job.shots.file(number))),
        None => Ok(()),
    }
}

/// Returns the look of all PNG files; `None` if there are none, or if each has a look of its own.
///
/// The exposure depends on frames of the whole path or list, so that every part has the same. `first` is the frame that
/// needs it first.
fn look(
    job: &WalkJob,
    session: &Session,
    listed: Option<&ListedViews>,
    first: usize,
    control: &Control,
) -> Result<Option<Look>, Failure> {
    let exposes_each = job.shots.views().is_some_and(|views| views.exposes_each);
    let Some(tone) = job.tone.filter(|_| !exposes_each) else { return Ok(None) };
    let film = job.view(first, session, listed)?.window.film;
    let factor = tone.exposure.factor(|| match listed {
        None => exposure::over_path(session, film, control).exp2(),
        Some(listed) => exposure::over_views(session, listed.all(), control).exp2(),
    });
    match control.is_cancelled() {
        true => Err(interrupted(&job.shots.label(first))),
        false => Ok(Some(Look { factor, curve: tone.curve, automatic: None })),
    }
}

/// Results for all views of a list, which come before the first view. The frames of a path have none.
#[derive(Clone, Copy)]
struct Shared<'a> {
    /// The views.
    listed: Option<&'a ListedViews>,
    /// Surfaces that they see together.
    outlook: Option<&'a Outlook>,
}

impl<'a> Shared<'a> {
    /// Returns a walk of views, if there are views, with what they share.
    fn in_walk(self, walk: Walk<'a>) -> Walk<'a> {
        match self.outlook {
            Some(outlook) => walk.of_views(outlook),
            None => walk,
        }
    }
}

/// A running walk, of which workers render frames.
struct Walking<'a> {
    job: &'a WalkJob,
    shared: Shared<'a>,
    /// Number of warnings of the reader.
    warnings: usize,
    /// Look of the PNG files, if all have one.
    look: Option<Look>,
    /// Number of frames to render.
    count: usize,
    /// Number of frames that have begun.
    begun: AtomicUsize,
    report: Mutex<WalkReport>,
    /// Remarks that were printed.
    said: Mutex<BTreeSet<String>>,
}

/// A worker, which renders one frame after the other.
struct Frames<'a> {
    walking: &'a Walking<'a>,
    control: &'a Control,
    progress: Watch,
    showing: Showing<'a>,
}

impl Frames<'_> {
    /// Renders a chunk of one frame of the model that moves in `first`, the scene of the first frame.
    fn posed(&mut self, chunk: PlannedChunk, first: &Opened) -> Result<(), Failure> {
        let Some(number) = chunk.unwritten().next().filter(|number| *number != FIRST_POSE) else {
            return self.chunk(chunk, &first.session);
        };
        if self.control.is_cancelled() {
            return Err(interrupted(&self.walking.job.shots.label(number)));
        }
        let job = self.walking.job;
        let reading = LoadOptions { frame: Some(number), ..job.reading.clone() };
        let session = opened::posed(&job.scene, &reading, first)?;
        self.chunk(chunk, &session)
    }

    /// Renders the missing frames of a chunk, and those frames whose records they need.
    fn chunk(&mut self, mut chunk: PlannedChunk, session: &Session) -> Result<(), Failure> {
        let (job, shared) = (self.walking.job, self.walking.shared);
        let records = job.records_file(&chunk);
        let saved = chunk.saved.take();
        let behind = saved.as_ref().map_or(0, |(index, _)| index + 1);
        let mut restored =
            saved.and_then(|(_, bytes)| Walk::restored(session, job.goal.clone(), job.limits, &bytes));
        if restored.is_none() && behind > 0 {
            // Another build of this version wrote the records. The chunk starts without them.
            return self.chunk(chunk.without_saved(), session);
        }
        let mut pace = Pace::default();
        for run in &chunk.runs {
            let mut walk = restored
                .take_if(|_| run.from_saved)
                .unwrap_or_else(|| Walk::new(session, job.goal.clone(), job.limits));
            walk = shared.in_walk(walk);
            for index in run.frames.clone() {
                self.frame(&mut walk, session, &chunk, index)?;
                let Some(path) = records.as_ref().filter(|_| index >= behind && !chunk.is_last(index)) else {
                    continue;
                };
                if index + 1 == run.frames.end || pace.is_due(Instant::now()) {
                    let begun = Instant::now();
                    saved::write(path, &chunk.keys[index], &walk.save()).map_err(Failure::output)?;
                    pace.saved(begun, Instant::now());
                }
            }
        }
        // No run continues from these records. A failure to remove them does no harm.
        if let Some(path) = records.filter(|_| chunk.ends) {
            let _ = fs::remove_file(path);
        }
        Ok(())
    }

    /// Renders a frame of a chunk, and writes it unless it exists.
    fn frame(
        &mut self,
        walk: &mut Walk,
        session: &Session,
        chunk: &PlannedChunk,
        index: usize,
    ) -> Result<(), Failure> {
        let Frames { walking, control, .. } = *self;
        let job = walking.job;
        let (number, is_there) = (chunk.frames[index], chunk.done[index]);
        let label = job.shots.label(number);
        if control.is_cancelled() {
            return Err(interrupted(&label));
        }
        let watch = Stopwatch::start();
        let (place, count) = (walking.begun.fetch_add(1, Ordering::Relaxed), walking.count);
        talk::event(
            "frame",
            || json!({ "frame": number, "state": "start", "index": place, "count": count, "is_there": is_there }),
        );
        let view = job.view(number, session, walking.shared.listed)?;
        let work = || walk.frame(&view, control);
        let is_done =
            |frame: &Result<RenderedFrame, FrameError>| frame.as_ref().is_ok_and(|frame| frame.complete);
        let shown = ShownFrame {
            size: [view.window.width, view.window.height],
            look: walking.look,
            beside: job.shots.file(number).with_extension("preview.png"),
        };
        let showing = &mut self.showing;
        let work = || showing.frame(&shown, control, work);
        let frame = self.progress.frame(Some(number), control, work, is_done);
        let mut frame = frame.map_err(|error| match error {
            FrameError::Interrupted | FrameError::Unplanned => interrupted(&label),
            FrameError::Memory { .. } | FrameError::Unplannable(_) => Failure::usage(error),
        })?;
        if !frame.complete {
            return Err(interrupted(&label));
        }
        self.showing.rendered(&frame.film.color);
        let black = frame.black_warning().map(str::to_owned);
        let report = || walking.report.lock().unwrap_or_else(PoisonError::into_inner);
        if is_there {
            report().repeat();
        } else {
            walking.say_once(&frame, &label);
            walking.write(&mut frame, number, &chunk.keys[index], &watch)?;
            frame.stats.add_time(Stage::Total, watch.elapsed());
            report().add(number, &frame)?;
        }
        let seconds = watch.elapsed().wall_seconds;
        talk::event("frame", || json!({ "frame": number, "state": "end", "seconds": seconds }));
        match black.filter(|_| job.reading.strict) {
            Some(warning) => Err(Failure::render(anyhow!("{label}: {warning}"))),
            None => Ok(()),
        }
    }
}

impl Walking<'_> {
    /// Renders chunks one after the other, or some at a time. They take the part `span` of the run.
    fn render(
        &self,
        chunks: Vec<PlannedChunk>,
        opened: &Opened,
        span: RunSpan,
        control: &Control,
    ) -> Result<(), Failure> {
        let job = self.job;
        let run = |chunk: PlannedChunk, frames: &mut Frames| match opened.moves {
            true => frames.posed(chunk, opened),
            false => frames.chunk(chunk, &opened.session),
        };
        if job.jobs > 1 && chunks.len() > 1 {
            let jobs = job.jobs.min(chunks.len());
            return SideBySide { jobs, control, progress: job.progress, span }
                .each(chunks, |chunk, control| {
                    run(chunk, &mut self.worker(ProgressMode::None, span, control))
                });
        }
        if job.jobs > 1 && self.count > 1 {
            let noun = job.shots.noun();
            talk::note(&format!(
                "-j has no effect: {noun}s of one chunk share records, one after the other; add --chunk N"
            ));
        }
        let mut frames = self.worker(job.progress, span, control);
        chunks.into_iter().try_for_each(|chunk| run(chunk, &mut frames))
    }

    /// Returns a worker that reports its progress.
    fn worker<'a>(&'a self, mode: ProgressMode, span: RunSpan, control: &'a Control) -> Frames<'a> {
        let job = self.job;
        let progress = Watch::new(mode, RunProgress::new(self.count, Stages::new(&job.goal), span));
        Frames { walking: self, control, progress, showing: job.previews.begin(&job.shots.name()) }
    }

    /// Writes a frame, on which `watch` has run since its start, and reports its files.
    fn write(
        &self,
        frame: &mut RenderedFrame,
        number: usize,
        key: &str,
        watch: &Stopwatch,
    ) -> Result<(), Failure> {
        let job = self.job;
        let (files, label) = (job.files(number), job.shots.label(number));
        frame.film.metadata.set("frame", number as f64);
        if let Some(views) = job.shots.views() {
            frame.film.metadata.set("view", views.title(number).as_str());
            frame.facts["view"] = views.title(number).into();
        }
        frame.film.metadata.set("job", key);
        let mut film = mem::replace(&mut frame.film, Film::new(Image::new(0, 0)));
        if job.reproducible {
            picture::forget_circumstances(&mut film);
        }
        let look = |tone: &Tone| self.look.unwrap_or_else(|| tone.look(film.shown()));
        let png = files.png.as_ref().map(|(path, tone)| (path.as_path(), look(tone)));
        let (exr, forms) = (files.exr.as_deref(), job.forms);
        let written = frame.stats.time(Stage::Write, || picture::write(exr, png, film, forms))?;
        frame.facts["scene_warnings"] = self.warnings.into();
        frame.facts["output"] = files.main().to_string_lossy().into();
        frame.facts["png"] = png.map(|(path, _)| path.to_string_lossy()).into();
        talk::wrote(&format!("{label}: {}", written.said(watch.elapsed())), &written.files);
        Ok(())
    }

    /// Prints the remarks of a frame that no earlier frame had.
    fn say_once(&self, frame: &RenderedFrame, label: &str) {
        let mut said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        for remark in &frame.remarks {
            let (Remark::Note(text) | Remark::Warning(text)) = remark;
            if said.insert(text.clone()) {
                let line = format!("{label}: {text}");
                match remark {
                    Remark::Note(_) => talk::note(&line),
                    Remark::Warning(_) => talk::warning(&line),
                }
            }
        }
    }
}

/// Returns the failure of a frame that was interrupted. The frames before it are complete.
fn interrupted(label: &str) -> Failure {
    Failure::interrupted(anyhow!(
        "interrupted; {label} was not complete and is not written; run the same command with --resume to continue"
    ))
}
