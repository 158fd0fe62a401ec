//! `lightsplat render`: opens a session, renders the frame, writes it; whatever happens, no file is left half-written.

use super::args::{RenderArgs, StatsFormat};
use super::exit::Failure;
use super::job::RenderJob;
use super::{interrupt, progress, scene, talk, threads};
use crate::film::{Film, false_colour, write_exr, write_png, write_srgb8};
use crate::progress::Control;
use crate::session::{Frame, FrameError, Remark};
use crate::stats::{Stage, Stopwatch, peak_resident_bytes};
use crate::view::View;
use anyhow::{Context, anyhow};
use std::path::Path;
use std::sync::Arc;

/// Runs the command.
pub fn run(args: RenderArgs) -> Result<(), Failure> {
    let run = Stopwatch::start();
    talk::set_mode(args.progress);
    let job = RenderJob::new(args, run)?;
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    let pool = threads::pool(job.threads)?;

    let Frame { film, mut stats, mut facts, remarks, complete, unverified, .. } =
        pool.install(|| render(&job, &control))?;
    for remark in remarks {
        match remark {
            Remark::Note(text) => talk::note(&text),
            Remark::Warning(text) => talk::warning(&text),
        }
    }
    stats.time(Stage::Write, || write(&job, film))?;
    stats.add_time(Stage::Total, run.elapsed());
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
        Some(StatsFormat::Text) => talk::print(&stats.to_text())?,
        Some(StatsFormat::Json) => {
            let mut report = stats.to_json();
            report["run"] = facts;
            talk::print(&format!("{report}\n"))?;
        }
        None => {}
    }
    let output = job.output.display();
    match (complete, unverified) {
        (true, false) => Ok(()),
        (true, true) => {
            Err(Failure::interrupted(anyhow!("interrupted; {output} is complete, its error not measured")))
        }
        (false, _) => Err(Failure::interrupted(anyhow!("interrupted; {output} is partial"))),
    }
}

/// The frame, with the times of opening its session and the facts that only the command knows.
fn render(job: &RenderJob, control: &Control) -> Result<Frame, Failure> {
    let (session, warnings) = scene::open(&job.scene, job.strict)?;
    let view = View::new(&session.cameras, &job.framing).map_err(Failure::usage)?;
    if control.is_cancelled() {
        return Err(Failure::interrupted(FrameError::Interrupted));
    }
    let frame = progress::watched(job.progress, control, || session.frame(&view, &job.goal, control));
    let mut frame = frame.map_err(|error| match error {
        FrameError::Interrupted => Failure::interrupted(error),
        FrameError::Memory { .. } | FrameError::Unplannable(_) => Failure::usage(error),
    })?;
    if !frame.complete && frame.is_black() {
        return Err(Failure::interrupted(FrameError::Interrupted));
    }
    frame.stats.merge(&session.stats);
    if let Some(number) = job.framing.frame {
        frame.film.metadata.set("frame", number as f64);
    }
    frame.facts["scene_warnings"] = warnings.into();
    frame.facts["output"] = serde_json::json!(job.output);
    frame.facts["png"] = serde_json::json!(job.png.as_ref().map(|(path, _)| path));
    Ok(frame)
}

fn write(job: &RenderJob, mut film: Film) -> Result<(), Failure> {
    let mut said = format!("wrote {}", job.output.display());
    let mut png = None;
    if let Some((path, exposure)) = &job.png {
        let factor = exposure.factor(&film.color);
        film.metadata.set("png_exposure", factor.log2() as f64);
        said += &format!(" and {} (exposure {:+.2} EV)", path.display(), factor.log2());
        png = Some((path, factor));
    }
    write_exr(&job.output, &film).map_err(Failure::output)?;
    if let Some((path, factor)) = png {
        write_png(path, &film.color, factor).map_err(Failure::output)?;
        write_layers(path, &film, factor)?;
    }
    talk::note(&said);
    Ok(())
}

/// Writes every layer that is meant to be shown as a PNG file named after the picture's.
fn write_layers(picture: &Path, film: &Film, factor: f32) -> Result<(), Failure> {
    for layer in &film.layers {
        if let Some(bytes) = false_colour::show(layer, &film.color, factor) {
            let path = picture.with_extension(format!("{}.png", layer.name));
            let size = [film.window.width, film.window.height];
            write_srgb8(&path, size, &bytes).map_err(Failure::output)?;
        }
    }
    Ok(())
}
