//! `lightsplat render`: load, build, render, write; whatever happens, no file is left half-written.

use super::args::{RenderArgs, StatsFormat};
use super::exit::Failure;
use super::job::RenderJob;
use super::{interrupt, plan, progress, scene, talk, verify};
use crate::film::Window;
use crate::film::metrics::rel_mse_of_variance;
use crate::film::{Film, Image, Metadata, false_colour, write_exr, write_png, write_srgb8};
use crate::method::{Method, Output};
use crate::progress::Control;
use crate::scene::formats::Loaded;
use crate::stats::{Stage, Stats, Stopwatch, peak_resident_bytes};
use crate::verify::verify as measure_error;
use crate::world::World;
use anyhow::{Context, anyhow};
use serde_json::json;
use std::path::Path;
use std::sync::Arc;

/// Runs the command.
pub fn run(args: RenderArgs) -> Result<(), Failure> {
    let total = Stopwatch::start();
    talk::set_mode(args.progress);
    let job = RenderJob::new(args)?;
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(job.threads)
        .build()
        .with_context(|| format!("cannot start {} threads; try fewer with --threads", job.threads))
        .map_err(Failure::render)?;

    let (mut frame, mut stats) = pool.install(|| render(&job, &control, &total))?;
    let Frame { complete, unverified, .. } = frame;
    if !complete && is_black(&frame.film.color) {
        return Err(Failure::interrupted(anyhow!("interrupted before the first pixel; nothing is written")));
    }
    stats.time(Stage::Write, || write(&job, frame.film))?;
    stats.add_time(Stage::Total, total.elapsed());
    if frame.facts["plan"]["asked_seconds"].is_number() {
        let seconds = |stage| stats.stage(stage).map_or(0.0, |t| t.wall_seconds);
        let got = seconds(Stage::Total) - seconds(Stage::Verify);
        frame.facts["plan"]["got_seconds"] = got.into();
        stats.add("Plan/time got, without --verify [s]", got);
    }
    if let Some(bytes) = peak_resident_bytes() {
        stats.count("Memory/peak resident [MiB]", bytes >> 20);
    }
    match job.stats {
        Some(StatsFormat::Text) => talk::print(&stats.to_text())?,
        Some(StatsFormat::Json) => {
            let mut report = stats.to_json();
            report["run"] = frame.facts;
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

/// A rendered frame: what goes into the files, and about it.
struct Frame {
    film: Film,
    facts: serde_json::Value,
    complete: bool,
    /// Whether measuring the picture's error was interrupted.
    unverified: bool,
}

fn render(job: &RenderJob, control: &Control, run: &Stopwatch) -> Result<(Frame, Stats), Failure> {
    let interrupted = || Failure::interrupted(anyhow!("interrupted before rendering; nothing is written"));
    let mut stats = Stats::new();
    let loaded = stats.time(Stage::Load, || scene::read(&job.scene, job.strict))?;
    let Loaded { scene, cameras, warnings, hash, .. } = loaded;
    let view = job.view(&cameras)?;
    if control.is_cancelled() {
        return Err(interrupted());
    }
    let world = stats
        .time(Stage::Build, || World::new(scene, job.threads))
        .with_context(|| format!("cannot build {}", job.scene.display()))
        .map_err(Failure::render)?;
    if control.is_cancelled() {
        return Err(interrupted());
    }
    let made = plan::make(job, &world, &view, control, run, &mut stats)?;
    let plan::Made { method, output, seconds, measured, report } = made;
    stats.merge(&output.stats);

    let complete = output.complete;
    let nonfinite_samples = output.nonfinite;
    let mut film = film(output, view.window);
    let nonfinite_channels = film.remove_nonfinite();
    for (n, what) in [(nonfinite_samples, "samples"), (nonfinite_channels, "channels of the picture")] {
        if n > 0 {
            talk::warning(&format!(
                "{n} {what} were NaN or infinite and count as 0; this is a defect, please report it"
            ));
        }
    }
    let metadata = &mut film.metadata;
    metadata.set("version", env!("CARGO_PKG_VERSION"));
    metadata.set("scene", world.scene.name.as_str());
    metadata.set("scene_hash", format!("{hash:016x}"));
    metadata.set("method", method.name());
    metadata.set("settings", method.settings().to_string());
    metadata.set("spp", method.spp() as f64);
    metadata.set("seed", method.seed() as f64);
    metadata.set("partial", if complete { "false" } else { "true" });
    metadata.set("render_seconds", seconds);
    metadata.set("threads", job.threads as f64);
    metadata.set("nonfinite", (nonfinite_samples + nonfinite_channels) as f64);
    if let Some(frame) = job.frame {
        metadata.set("frame", frame as f64);
    }
    plan::store(&report, run.elapsed().wall_seconds, metadata);
    let measured = measured.filter(|_| complete).or_else(|| {
        let settings = job.verify.filter(|_| complete)?.of(&method);
        let measure = || measure_error(&world, &view, &film.color, &settings, control);
        let search = || progress::watched(job.progress, control, measure);
        Some((settings, stats.time(Stage::Verify, search)))
    });
    let verified = measured.map(|(settings, found)| {
        let found = found?;
        verify::report(&found, &settings, &mut stats, &mut film.metadata);
        Some(verify::to_json(&found, &settings))
    });
    let unverified = matches!(verified, Some(None));
    let metadata = &film.metadata;
    let facts = json!({
        "scene": world.scene.name,
        "scene_hash": format!("{hash:016x}"),
        "scene_warnings": warnings.len(),
        "method": method.name(),
        "settings": method.settings(),
        "threads": job.threads,
        "window": { "film": view.window.film, "offset": view.window.offset, "size": [view.window.width, view.window.height] },
        "complete": complete,
        "nonfinite": nonfinite_samples + nonfinite_channels,
        "standard_error": metadata.number("standard_error"),
        "relative_mse_of_noise": metadata.number("relative_mse_of_noise"),
        "verified": verified,
        "plan": report,
        "output": job.output,
        "png": job.png.as_ref().map(|(path, _)| path),
    });
    Ok((Frame { film, facts, complete, unverified }, stats))
}

fn film(output: Output, window: Window) -> Film {
    let mut metadata = Metadata::default();
    if let Some(variance) = &output.variance {
        metadata.set("standard_error", root_mean(variance));
        metadata.set("relative_mse_of_noise", rel_mse_of_variance(variance, &output.color));
    }
    let mut layers: Vec<_> =
        output.variance.map(|image| ("variance".to_owned(), image)).into_iter().collect();
    layers.extend(output.extra);
    Film { window, color: output.color, layers, metadata }
}

/// Root of the mean variance over pixels and channels: the standard error of a typical pixel.
fn root_mean(variance: &Image) -> f64 {
    let sum: f64 = variance.pixels.iter().map(|p| p.as_dvec3().element_sum() / 3.0).sum();
    (sum / variance.pixels.len().max(1) as f64).sqrt()
}

fn is_black(image: &Image) -> bool {
    image.pixels.iter().all(|p| *p == crate::math::Rgb::ZERO)
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
        if let Method::Cache(settings) = &job.method
            && settings.inspect
        {
            write_layers(path, &film, factor)?;
        }
    }
    talk::note(&said);
    Ok(())
}

/// Writes every layer as a PNG file named after the picture's.
fn write_layers(picture: &Path, film: &Film, factor: f32) -> Result<(), Failure> {
    for (name, layer) in &film.layers {
        let path = picture.with_extension(format!("{name}.png"));
        let bytes = false_colour::show(name, layer, &film.color, factor);
        write_srgb8(&path, [layer.width, layer.height], &bytes).map_err(Failure::output)?;
    }
    Ok(())
}
