//! `lightsplat walk`: renders the frames of a camera path. Each file is complete before the next frame begins.

use super::args::WalkArgs;
use super::course::{RunProgress, RunSpan, Stages};
use super::exit::Failure;
use super::live::{Showing, ShownFrame};
use super::outputs::{self, Inputs};
use super::progress::Watch;
use super::walk_job::{FIRST_POSE, PlannedChunk, WalkJob};
use super::walk_report::WalkReport;
use super::{dry_run, interrupt, opened, picture, talk, threads};
use anyhow::{Context, anyhow};
use base::film::{Film, Image, Look};
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
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use world::view::View;

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
        walk(job, &opened, RunSpan::whole(), &control)
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
        let (exr, png) = job.files(*number);
        let files = [&exr].into_iter().chain(&png).map(PathBuf::as_path);
        inputs.check_apart(files.chain(job.previews.file()))?;
    }
    for number in chunks.iter().flat_map(PlannedChunk::unwritten) {
        let (exr, png) = job.files(number);
        outputs::check_unprotected([&exr].into_iter().chain(&png).map(PathBuf::as_path))?;
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
    let progress = Watch::new(job.progress, RunProgress::new(count, Stages::new(&job.goal), span));
    let (warnings, said) = (warnings.len(), BTreeSet::new());
    let showing = job.previews.begin(&job.shots.name());
    let (shared, look) = (Shared { listed, outlook }, None);
    let mut frames =
        Frames { job, session, shared, warnings, control, look, report, progress, showing, said };
    let ended = chunks.into_iter().try_for_each(|chunk| match moves {
        true => frames.posed(chunk, opened),
        false => frames.chunk(chunk, session),
    });
    ended.and(frames.report.sum_up())
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

/// A running walk.
struct Frames<'a> {
    job: &'a WalkJob,
    shared: Shared<'a>,
    /// Scene of the exposure: of all frames, or of the first one if the model moves.
    session: &'a Session,
    /// Number of warnings of the reader.
    warnings: usize,
    control: &'a Control,
    /// Look of the PNG files, once it is known.
    look: Option<Look>,
    report: WalkReport,
    progress: Watch,
    showing: Showing<'a>,
    /// Remarks that were printed.
    said: BTreeSet<String>,
}

impl Frames<'_> {
    /// Renders a chunk of one frame of the model that moves in `first`, the scene of the first frame.
    fn posed(&mut self, chunk: PlannedChunk, first: &Opened) -> Result<(), Failure> {
        let Some(number) = chunk.unwritten().next().filter(|number| *number != FIRST_POSE) else {
            return self.chunk(chunk, &first.session);
        };
        if self.control.is_cancelled() {
            return Err(interrupted(&self.job.shots.label(number)));
        }
        let reading = LoadOptions { frame: Some(number), ..self.job.reading.clone() };
        let session = opened::posed(&self.job.scene, &reading, first)?;
        self.chunk(chunk, &session)
    }

    /// Renders the missing frames of a chunk, and those frames whose records they need.
    fn chunk(&mut self, mut chunk: PlannedChunk, session: &Session) -> Result<(), Failure> {
        let (job, shared) = (self.job, self.shared);
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
        let Frames { job, control, .. } = *self;
        let (number, is_there) = (chunk.frames[index], chunk.done[index]);
        let label = job.shots.label(number);
        if control.is_cancelled() {
            return Err(interrupted(&label));
        }
        let watch = Stopwatch::start();
        let [place, count] = self.progress.frames();
        talk::event(
            "frame",
            || json!({ "frame": number, "state": "start", "index": place, "count": count, "is_there": is_there }),
        );
        let view = job.view(number, session, self.shared.listed)?;
        let work = || walk.frame(&view, control);
        let is_done =
            |frame: &Result<RenderedFrame, FrameError>| frame.as_ref().is_ok_and(|frame| frame.complete);
        let shown = ShownFrame {
            size: [view.window.width, view.window.height],
            look: self.look,
            beside: job.files(number).0.with_extension("preview.png"),
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
        if is_there {
            self.report.repeat();
        } else {
            self.say_once(&frame, &label);
            self.write(&mut frame, number, &chunk.keys[index], &view, &watch)?;
            frame.stats.add_time(Stage::Total, watch.elapsed());
            self.report.add(number, &frame)?;
        }
        let seconds = watch.elapsed().wall_seconds;
        talk::event("frame", || json!({ "frame": number, "state": "end", "seconds": seconds }));
        match black.filter(|_| job.reading.strict) {
            Some(warning) => Err(Failure::render(anyhow!("{label}: {warning}"))),
            None => Ok(()),
        }
    }

    /// Writes a frame, on which `watch` has run since its start, and reports its files.
    fn write(
        &mut self,
        frame: &mut RenderedFrame,
        number: usize,
        key: &str,
        view: &View,
        watch: &Stopwatch,
    ) -> Result<(), Failure> {
        let (exr, png) = self.job.files(number);
        let label = self.job.shots.label(number);
        let look = self.look(&label, view, &frame.film)?;
        frame.film.metadata.set("frame", number as f64);
        if let Some(views) = self.job.shots.views() {
            frame.film.metadata.set("view", views.title(number).as_str());
            frame.facts["view"] = views.title(number).into();
        }
        frame.film.metadata.set("job", key);
        let mut film = mem::replace(&mut frame.film, Film::new(Image::new(0, 0)));
        if self.job.reproducible {
            picture::forget_circumstances(&mut film);
        }
        let png = png.as_deref().zip(look);
        let written = frame.stats.time(Stage::Write, || picture::write_exr_last(&exr, png, film))?;
        frame.facts["scene_warnings"] = self.warnings.into();
        frame.facts["output"] = exr.to_string_lossy().into();
        frame.facts["png"] = png.map(|(path, _)| path.to_string_lossy()).into();
        talk::wrote(&format!("{label}: {}", written.said(watch.elapsed())), &written.files);
        Ok(())
    }

    /// Returns the look of a PNG file; `None` if there is none.
    ///
    /// The exposure depends on frames of the whole path or list, so that every part has the same, unless each view is
    /// exposed by itself. `label` names the frame that needs it.
    fn look(&mut self, label: &str, view: &View, film: &Film) -> Result<Option<Look>, Failure> {
        let Some(tone) = self.job.tone else { return Ok(None) };
        if self.job.shots.views().is_some_and(|views| views.exposes_each) {
            return Ok(Some(tone.look(film.shown())));
        }
        if self.look.is_some() {
            return Ok(self.look);
        }
        let factor = tone.exposure.factor(|| match self.shared.listed {
            None => exposure::over_path(self.session, view.window.film, self.control).exp2(),
            Some(listed) => exposure::over_views(self.session, listed.all(), self.control).exp2(),
        });
        if self.control.is_cancelled() {
            return Err(interrupted(label));
        }
        self.look = Some(Look { factor, curve: tone.curve, automatic: None });
        Ok(self.look)
    }

    /// Prints the remarks of a frame that no earlier frame had.
    fn say_once(&mut self, frame: &RenderedFrame, label: &str) {
        for remark in &frame.remarks {
            let (Remark::Note(text) | Remark::Warning(text)) = remark;
            if self.said.insert(text.clone()) {
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
