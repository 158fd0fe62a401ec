//! `--dry-run`: reports what a run would write, and what it needs, and renders nothing.

use super::exit::Failure;
use super::job::RenderJob;
use super::talk;
use super::walk_job::{PlannedChunk, WalkJob};
use base::stats::available_bytes;
use render::session::{Goal, PlanGoal, Session};
use render::walk::views::ListedViews;
use scene::Requirements;
use serde_json::json;
use std::fmt::Write;
use world::view::View;

/// Reports on an image.
///
/// # Errors
/// If the image cannot be framed, or takes more memory than there is.
pub fn still(job: &RenderJob, session: &Session) -> Result<(), Failure> {
    let mut files = job.files.names();
    files.extend(job.previews.file().map(|path| path.display().to_string()));
    let view = View::new(&session.cameras, &job.framing(session)).map_err(Failure::usage)?;
    report(&files, &view, &job.goal, session)
}

/// Reports on the frames of a walk that are not complete. `listed` has the views of a list.
///
/// # Errors
/// If a frame cannot be framed, or takes more memory than there is.
pub fn walk(
    job: &WalkJob,
    session: &Session,
    chunks: &[PlannedChunk],
    listed: Option<&ListedViews>,
) -> Result<(), Failure> {
    let unwritten = chunks.iter().flat_map(PlannedChunk::unwritten);
    let files = unwritten.flat_map(|number| job.files(number).names());
    let files: Vec<String> =
        files.chain(job.previews.file().map(|path| path.display().to_string())).collect();
    let Some(first) = chunks.iter().flat_map(|chunk| &chunk.frames).next() else { return Ok(()) };
    report(&files, &job.view(*first, session, listed)?, &job.goal, session)
}

/// Prints files, resolution, method and memory.
fn report(files: &[String], view: &View, goal: &Goal, session: &Session) -> Result<(), Failure> {
    let image = session.expected_memory(view, goal).map_err(Failure::usage)?;
    let scene = Requirements::new(&session.world.scene).memory.total() as u64;
    let method = method(goal);
    let window = &view.window;
    talk::event("dry_run", || {
        json!({
            "files": files,
            "resolution": window.film,
            "window": { "offset": window.offset, "size": [window.width, window.height] },
            "method": method,
            "memory_bytes": { "image": image, "scene": scene, "available": available_bytes() },
        })
    });
    // Writing to a String cannot fail.
    let mut text = String::new();
    for file in files {
        let _ = writeln!(text, "file\t{file}");
    }
    let [width, height] = window.film;
    let _ = write!(text, "resolution\t{width}x{height}");
    let part = (window.pixel_count() < window.film_pixel_count()).then(|| {
        format!(", of which {}x{} at {},{}", window.width, window.height, window.offset[0], window.offset[1])
    });
    let _ = writeln!(text, "{}\nmethod\t{method}", part.unwrap_or_default());
    let available =
        available_bytes().map_or(String::new(), |bytes| format!("; {} are available", gib(bytes)));
    let _ =
        writeln!(text, "memory\tabout {} for the image, {} for the scene{available}", gib(image), gib(scene));
    talk::print(&text)
}

fn gib(bytes: u64) -> String {
    format!("{:.2} GiB", bytes as f64 / f64::from(1 << 30))
}

/// Describes the method of a goal.
fn method(goal: &Goal) -> String {
    let (name, spp) = (goal.method.name(), goal.method.spp());
    let own = format!("{name}, {spp} samples per pixel");
    let chosen = match goal.may_choose && goal.denoises() {
        true => format!("{own}, or path if a few pixels show that it needs less work"),
        false => own,
    };
    match &goal.plan {
        PlanGoal::AsSet => chosen,
        PlanGoal::Time(time) => format!("{chosen}; settings will be planned for {} s", time.seconds),
        PlanGoal::Error(limit) => {
            format!("{chosen}; settings will be planned for an error of {} %", 100.0 * limit.error)
        }
    }
}
