//! `lightsplat render`: opens a session, renders a frame and writes it. No file is left incomplete.

use super::args::RenderArgs;
use super::course::{RunProgress, RunSpan, Stages};
use super::exit::Failure;
use super::job::RenderJob;
use super::job_key;
use super::live::{Showing, ShownFrame};
use super::outputs::{self, Inputs};
use super::picture_args::StatsFormat;
use super::progress::Watch;
use super::{dry_run, ids, interrupt, opened, picture, talk, threads};
use anyhow::{Context, anyhow};
use base::film::SAMPLES;
use base::progress::Control;
use base::stats::{Stage, Stats, Stopwatch, peak_resident_bytes};
use render::method::path::PartialImage;
use render::session::{FrameError, Opened, Remark, RenderedFrame};
use serde_json::Value;
use std::fs;
use std::sync::Arc;
use world::view::View;

/// Runs the command.
pub fn run(args: RenderArgs) -> Result<(), Failure> {
    let run = Stopwatch::start();
    talk::start(args.picture.progress, args.picture.loudness(), "render");
    let mut job = RenderJob::new(args, run)?;
    job.goal.is_last = true;
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    threads::pool(job.threads)?.install(|| {
        let opened = opened::open(&job.scene, &job.reading)?;
        still(&job, &opened, RunSpan::begin(), &control)
    })
}

/// Renders an image and reports the result, unless a complete image exists that may stay. The image takes the part
/// `span` of the run.
///
/// # Errors
/// If the image cannot be rendered or written, or a signal interrupted the run.
pub fn still(job: &RenderJob, opened: &Opened, span: RunSpan, control: &Control) -> Result<(), Failure> {
    let key = job.key(&opened.session);
    let png = job.files.png.as_ref().map(|(path, _)| path.as_path());
    if let Some(exr) = job.files.exr.as_deref().filter(|_| job.resume)
        && job_key::is_done(exr, png, job.frame, &key)
    {
        talk::note(&format!("{} already exists and is unchanged", exr.display()));
        return Ok(());
    }
    check_files(job, opened)?;
    if job.dry_run {
        return dry_run::still(job, &opened.session);
    }
    let begun = samples_so_far(job, &key);
    let progress = Watch::new(job.progress, RunProgress::new(1, Stages::new(&job.goal), span));
    let mut showing = job.previews.begin(&job.files.names().swap_remove(0));
    let work = Work { begun, progress, showing: &mut showing };
    let mut frame = render(job, opened, work, control)?;
    let files = job.files.of_image(frame.complete);
    frame.facts["output"] = files.main().to_string_lossy().into();
    frame.facts["png"] = files.png.as_ref().map(|(path, _)| path.to_string_lossy()).into();
    frame.film.metadata.set("job", key.as_str());
    if job.reproducible {
        picture::forget_circumstances(&mut frame.film);
    }
    let black = frame.black_warning().filter(|_| job.reading.strict).map(str::to_owned);
    let can_go_on = files.exr.is_some() && frame.film.layers.iter().any(|layer| layer.name == SAMPLES);
    let RenderedFrame { film, mut stats, facts, remarks, measured, complete, unverified, .. } = frame;
    say(&remarks);
    showing.rendered(&film.color);
    showing.last(&film);
    let exposed = files.png.as_ref().map(|(path, tone)| (path.as_path(), tone.look(film.shown())));
    let written =
        stats.time(Stage::Write, || picture::write(files.exr.as_deref(), exposed, film, job.forms))?;
    if let Some(exr) = job.files.exr.as_deref().filter(|_| complete && job.files.is_named()) {
        ids::write_for(&job.goal, &exr.with_extension("ids.json"), &opened.session.world.scene)?;
    }
    job.files.deliver(&written.said(job.run.elapsed()), &written.files)?;
    say(&measured);
    if complete {
        remove_parts(job, &key);
    }
    stats.add_time(Stage::Total, job.run.elapsed());
    report(job, stats, facts)?;
    let output = files.main().display();
    if let Some(warning) = black {
        return Err(Failure::render(anyhow!("{output}: {warning}")));
    }
    match (complete, unverified) {
        (true, false) => Ok(()),
        (true, true) => Err(Failure::interrupted(anyhow!(
            "interrupted; {output} is complete, but its error is not measured"
        ))),
        (false, _) => {
            let further = if can_go_on { "; run the same command with --resume to continue" } else { "" };
            Err(Failure::interrupted(anyhow!("interrupted; {output} is partial{further}")))
        }
    }
}

/// Checks that the files of a job can be written, and are no inputs of the scene.
fn check_files(job: &RenderJob, opened: &Opened) -> Result<(), Failure> {
    let inputs = Inputs::of_session(&opened.session);
    inputs.check_apart(job.files.paths().chain(job.previews.file()))?;
    outputs::check_unprotected(job.files.paths())?;
    let png = job.files.png.as_ref().map(|(path, _)| path.as_path());
    if let Some(png) = png.filter(|_| job.goal.method.inspects()) {
        inputs.check_layers(png)?;
    }
    Ok(())
}

/// Returns the samples of an interrupted run with this `key`, if the job continues one.
fn samples_so_far(job: &RenderJob, key: &str) -> Option<PartialImage> {
    let exr = job.files.exr.as_ref().filter(|_| job.resume)?;
    let parts = [exr.clone(), picture::beside(exr)];
    let (begun, part) =
        parts.into_iter().find_map(|part| Some((job_key::begun(&part, job.frame, key)?, part)))?;
    talk::note(&format!("continuing with the samples of {}", part.display()));
    Some(begun)
}

/// Prints the statistics and facts of an image, if the job asks for them.
fn report(job: &RenderJob, mut stats: Stats, mut facts: Value) -> Result<(), Failure> {
    if facts["plan"]["asked_seconds"].is_number() {
        let seconds = |stage| stats.stage(stage).map_or(0.0, |t| t.wall_seconds);
        let got = seconds(Stage::Total) - seconds(Stage::Verify);
        facts["plan"]["got_seconds"] = got.into();
        stats.add("Plan/time got, without --verify [s]", got);
    }
    if let Some(bytes) = peak_resident_bytes() {
        stats.count("Memory/peak resident [MiB]", bytes >> 20);
    }
    match job.stats {
        Some(StatsFormat::Text) => talk::print(&stats.to_text(job.threads))?,
        Some(StatsFormat::Json) => {
            let mut report = stats.to_json();
            report["run"] = facts;
            talk::print(&format!("{report}\n"))?;
        }
        None => {}
    }
    Ok(())
}

/// Prints the remarks of a frame.
fn say(remarks: &[Remark]) {
    for remark in remarks {
        match remark {
            Remark::Note(text) => talk::note(text),
            Remark::Warning(text) => talk::warning(text),
        }
    }
}

/// Beginning of an image, and watchers of its rendering.
struct Work<'a, 'b> {
    /// Samples of an interrupted run.
    begun: Option<PartialImage>,
    progress: Watch,
    showing: &'a mut Showing<'b>,
}

/// Renders the frame. Adds the times of opening the session, and the facts that only the command knows.
fn render(job: &RenderJob, opened: &Opened, work: Work, control: &Control) -> Result<RenderedFrame, Failure> {
    let Work { begun, mut progress, showing } = work;
    let Opened { session, warnings, .. } = opened;
    let view = View::new(&session.cameras, &job.framing(session)).map_err(Failure::usage)?;
    if control.is_cancelled() {
        return Err(Failure::interrupted(FrameError::Interrupted));
    }
    let work = || match begun {
        Some(begun) => session.rest_of_frame(&view, &job.goal, begun, control),
        None => session.frame(&view, &job.goal, control),
    };
    let is_done = |frame: &Result<RenderedFrame, FrameError>| {
        frame.as_ref().is_ok_and(|frame| frame.complete && !frame.unverified)
    };
    let shown = ShownFrame {
        size: [view.window.width, view.window.height],
        look: None,
        beside: job.files.preview(&job.scene),
    };
    let frame = progress.frame(job.frame, control, || showing.frame(&shown, control, work), is_done);
    let mut frame = frame.map_err(|error| match error {
        FrameError::Interrupted | FrameError::Unplanned => Failure::interrupted(error),
        FrameError::Memory { .. } | FrameError::Unplannable(_) => Failure::usage(error),
    })?;
    if !frame.complete && frame.film.color.is_black() {
        return Err(Failure::interrupted(FrameError::Interrupted));
    }
    frame.stats.merge(&session.stats);
    if let Some(number) = job.frame {
        frame.film.metadata.set("frame", number as f64);
    }
    frame.facts["scene_warnings"] = warnings.len().into();
    Ok(frame)
}

/// Removes the partial image that an interrupted run wrote beside an older one. A failure to remove it does no harm.
fn remove_parts(job: &RenderJob, key: &str) {
    let Some(exr) = job.files.exr.as_deref().map(picture::beside) else { return };
    if !job_key::is_part(&exr, job.frame, key) {
        return;
    }
    let png = job.files.png.as_ref().map(|(path, _)| picture::beside(path));
    for file in [exr].into_iter().chain(png) {
        let _ = fs::remove_file(file);
    }
}
