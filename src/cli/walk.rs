//! `lightsplat walk`: renders frame after frame of a camera path; each is written whole before the next begins.

use super::args::WalkArgs;
use super::course::Course;
use super::exit::Failure;
use super::progress::Watch;
use super::walk_job::WalkJob;
use super::walk_report::Report;
use super::{interrupt, picture, scene, talk, threads};
use crate::film::{Exposure, Film, Image};
use crate::progress::Control;
use crate::session::{BLACK, Frame, FrameError, Remark, Session};
use crate::stats::{Stage, Stopwatch};
use crate::view::View;
use crate::walk::{Walk, exposure};
use anyhow::{Context, anyhow};
use serde_json::json;
use std::collections::BTreeSet;
use std::mem;
use std::sync::Arc;
use std::time::Instant;

/// Runs the command.
pub fn run(args: WalkArgs) -> Result<(), Failure> {
    talk::start(args.picture.progress, "walk");
    let job = WalkJob::new(args)?;
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    threads::pool(job.threads)?.install(|| walk(&job, &control))
}

/// Renders the frames that are not there yet, and says what came of it.
fn walk(job: &WalkJob, control: &Control) -> Result<(), Failure> {
    let (session, warnings) = scene::open(&job.scene, &job.reading)?;
    let numbers = job.numbers(&session)?;
    let hash = job.hash(&session);
    let mut report = Report::new(job.stats);
    let mut left = Vec::new();
    for number in numbers {
        if job.resume && job.is_done(number, &hash) {
            report.skip();
            talk::event("frame", || json!({ "frame": number, "state": "skipped" }));
        } else {
            left.push(number);
        }
    }
    let ended = frames(job, &session, (&left, &hash, warnings), &mut report, control);
    report.sum_up();
    ended
}

fn frames(
    job: &WalkJob,
    session: &Session,
    (numbers, hash, warnings): (&[usize], &str, usize),
    report: &mut Report,
    control: &Control,
) -> Result<(), Failure> {
    let Some(first) = numbers.first() else { return Ok(()) };
    let film = View::new(&session.cameras, &job.framing(*first)).map_err(Failure::usage)?.window.film;
    // Frames of the whole path decide, so that any part of it has the same.
    let factor = job.exposure.map(|exposure| match exposure {
        Exposure::Auto => exposure::over_path(session, film, control).exp2(),
        Exposure::Ev(ev) => ev.exp2(),
    });
    let mut walk = Walk::new(session, job.goal.clone(), job.limits);
    let mut progress = Watch::new(job.progress, Course::new(numbers.len(), [0.0, 1.0], Instant::now()));
    let mut said = BTreeSet::new();
    for (index, &number) in numbers.iter().enumerate() {
        if control.is_cancelled() {
            return Err(interrupted(number));
        }
        let watch = Stopwatch::start();
        let (exr, png) = job.files(number);
        talk::event(
            "frame",
            || json!({ "frame": number, "state": "start", "index": index, "count": numbers.len() }),
        );
        let view = View::new(&session.cameras, &job.framing(number)).map_err(Failure::usage)?;
        let frame = progress.frame(Some(number), control, || walk.frame(&view, control));
        let mut frame = frame.map_err(|error| match error {
            FrameError::Interrupted => interrupted(number),
            FrameError::Memory { .. } | FrameError::Unplannable(_) => Failure::usage(error),
        })?;
        if !frame.complete {
            return Err(interrupted(number));
        }
        say_once(&frame, number, &mut said);
        let is_black = frame.is_black();
        frame.film.metadata.set("frame", number as f64);
        frame.film.metadata.set("job", hash);
        let film = mem::replace(&mut frame.film, Film::new(Image::new(0, 0)));
        let png = png.as_deref().zip(factor);
        let written = frame.stats.time(Stage::Write, || picture::write_exr_last(&exr, png, film))?;
        let time = watch.elapsed();
        frame.stats.add_time(Stage::Total, time);
        frame.facts["scene_warnings"] = warnings.into();
        frame.facts["output"] = json!(exr);
        frame.facts["png"] = json!(png.map(|(path, _)| path));
        talk::wrote(&format!("frame {number}: {}", written.said), &written.files);
        talk::event("frame", || json!({ "frame": number, "state": "end", "seconds": time.wall_seconds }));
        report.add(number, &frame)?;
        if job.reading.strict && is_black {
            return Err(Failure::render(anyhow!("frame {number}: {BLACK}")));
        }
    }
    Ok(())
}

/// The frame at hand was not begun or is given up; those before it are whole.
fn interrupted(number: usize) -> Failure {
    Failure::interrupted(anyhow!(
        "interrupted before frame {number} was done, which is not written; go on by the same command with --resume"
    ))
}

/// Prints the remarks of a frame that no frame before it had.
fn say_once(frame: &Frame, number: usize, said: &mut BTreeSet<String>) {
    for remark in &frame.remarks {
        let (Remark::Note(text) | Remark::Warning(text)) = remark;
        if said.insert(text.clone()) {
            let line = format!("frame {number}: {text}");
            match remark {
                Remark::Note(_) => talk::note(&line),
                Remark::Warning(_) => talk::warning(&line),
            }
        }
    }
}
