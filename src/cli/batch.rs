//! `lightsplat batch`: renders the pictures and walks of job files; each scene is read once, and a broken one does not
//! stop the others.

use super::args::{BatchArgs, Command};
use super::batch_file::{self, Entry};
use super::course::Span;
use super::exit::{self, Failure};
use super::job::RenderJob;
use super::walk_job::WalkJob;
use super::{batch_outputs, interrupt, opened, render, talk, threads, walk};
use ::render::session::Opened;
use anyhow::{Context, anyhow};
use base::progress::Control;
use base::stats::Stopwatch;
use serde_json::json;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Runs the command.
pub fn run(args: BatchArgs) -> Result<(), Failure> {
    talk::start(args.progress, "batch");
    let more: &[&str] = if args.resume { &["--resume"] } else { &[] };
    let mut entries = Vec::new();
    for path in &args.jobs {
        entries.extend(batch_file::read(path, more)?);
    }
    batch_outputs::check_apart(&entries)?;
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    let pool = threads::pool(threads::count(args.threads))?;
    let mut batch = Batch { args, control, span: Span::whole(), count: entries.len(), begun: 0, failed: 0 };
    // Outputs that cannot be written are found before hours of work.
    entries.retain(|entry| {
        let checked = batch.command(entry).map(drop);
        batch.settle(entry, checked).is_some()
    });
    pool.install(|| batch.render(entries))
}

/// A batch under way.
struct Batch {
    args: BatchArgs,
    control: Arc<Control>,
    /// The run.
    span: Span,
    /// Pictures and walks, those begun, and those that have failed.
    count: usize,
    begun: usize,
    failed: usize,
}

/// A picture or a walk, checked.
enum Job {
    Still(Box<RenderJob>),
    Walk(Box<WalkJob>),
}

impl Batch {
    /// Renders the entries, those of a scene after each other.
    fn render(mut self, mut left: Vec<Entry>) -> Result<(), Failure> {
        while let Some(first) = left.first().cloned() {
            let is_of_scene =
                |entry: &Entry| (&entry.scene, &entry.reading) == (&first.scene, &first.reading);
            let (of_scene, others) = left.into_iter().partition(is_of_scene);
            left = others;
            self.scene(of_scene)?;
        }
        let done = self.count - self.failed;
        talk::summary(
            &format!("{done} of {} pictures and walks done", self.count),
            || json!({ "done": done, "failed": self.failed }),
        );
        match self.failed {
            0 => Ok(()),
            failed => {
                let others = if done > 0 { "; the others are done" } else { "" };
                let message = anyhow!("{failed} of {} pictures and walks failed{others}", self.count);
                Err(Failure::in_part(message))
            }
        }
    }

    /// Reads a scene and renders all that is wanted of it.
    ///
    /// # Errors
    /// If a signal stopped the run; all other failures are counted.
    fn scene(&mut self, entries: Vec<Entry>) -> Result<(), Failure> {
        let mut opened = None;
        for entry in &entries {
            if self.control.is_cancelled() {
                let message = "interrupted; go on by the same command with --resume";
                return Err(Failure::interrupted(anyhow!(message)));
            }
            talk::event(
                "picture",
                || json!({ "state": "start", "index": self.begun, "count": self.count, "output": entry.output.to_string_lossy() }),
            );
            let span = self.span.part(self.begun, self.count);
            self.begun += 1;
            // A defect in one picture is no reason to lose the others; it has been printed with its place.
            let done = catch_unwind(AssertUnwindSafe(|| self.entry(entry, &mut opened, span)));
            let done =
                done.unwrap_or_else(|_| Err(Failure::render(anyhow!("an internal error; please report it"))));
            match done {
                Err(failure) if self.control.is_cancelled() => return Err(failure),
                done => {
                    let ok = self.settle(entry, done).is_some();
                    talk::event(
                        "picture",
                        || json!({ "state": if ok { "end" } else { "failed" }, "output": entry.output.to_string_lossy() }),
                    );
                }
            }
        }
        Ok(())
    }

    /// Renders an entry of a scene, which is read if it has not been.
    fn entry(&self, entry: &Entry, opened: &mut Option<Opened>, span: Span) -> Result<(), Failure> {
        let job = self.command(entry)?;
        let opened = match opened {
            Some(opened) => opened,
            None => opened.insert(opened::open(&entry.scene, &entry.reading)?),
        };
        match job {
            Job::Still(job) => render::still(&job, opened, span, &self.control),
            Job::Walk(job) => walk::walk(&job, opened, span, &self.control),
        }
    }

    fn command(&self, entry: &Entry) -> Result<Job, Failure> {
        match entry.command()? {
            Command::Render(mut args) => {
                args.picture.progress = self.args.progress;
                Ok(Job::Still(Box::new(RenderJob::new(*args, Stopwatch::start())?)))
            }
            Command::Walk(mut args) => {
                args.picture.progress = self.args.progress;
                Ok(Job::Walk(Box::new(WalkJob::new(*args)?)))
            }
            _ => Err(Failure::usage(anyhow!("{}: neither a picture nor a walk", entry.output.display()))),
        }
    }

    /// Counts and tells a failure; `None` if it was one.
    fn settle(&mut self, entry: &Entry, done: Result<(), Failure>) -> Option<()> {
        done.map_err(|failure| {
            self.failed += 1;
            let is_of_job = failure.code() == exit::USAGE;
            let failure = failure.within(&entry.output);
            talk::error(&if is_of_job { failure.at(&entry.place) } else { failure });
        })
        .ok()
    }
}
