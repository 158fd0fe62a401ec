//! `lightsplat batch`: renders the images, walks and views of job files.
//!
//! Each scene is read once. A failure of one entry does not stop the others.

use super::args::{BatchArgs, Command};
use super::batch_file::{self, JobEntry};
use super::course::RunSpan;
use super::exit::{self, Failure};
use super::job::RenderJob;
use super::values::Loudness;
use super::walk_job::WalkJob;
use super::{batch_outputs, interrupt, opened, render, talk, threads, views, walk};
use ::render::session::Opened;
use ::render::walk::FrameList;
use anyhow::{Context, anyhow};
use base::progress::Control;
use base::stats::Stopwatch;
use serde_json::json;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Runs the command.
pub fn run(args: BatchArgs) -> Result<(), Failure> {
    talk::start(args.progress, Loudness::Normal, "batch");
    let more: &[&str] = if args.resume { &["--resume"] } else { &[] };
    let mut entries = Vec::new();
    for path in &args.jobs {
        entries.extend(batch_file::read(path, more)?);
    }
    batch_outputs::check_apart(&entries)?;
    if args.list {
        return list(&entries);
    }
    if let Some(only) = &args.only {
        entries = chosen(entries, only)?;
    }
    let control = Arc::new(Control::new());
    interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
    let pool = threads::pool(threads::count(args.threads))?;
    let mut batch =
        BatchRun { args, control, span: RunSpan::whole(), count: entries.len(), begun: 0, failed: 0 };
    // Report outputs that cannot be written before hours of work.
    entries.retain(|entry| {
        let checked = batch.command(entry).map(drop);
        batch.settle(entry, checked).is_some()
    });
    pool.install(|| batch.render(entries))
}

/// Prints the number, the scene and the output of each entry, and the views of a chunk.
fn list(entries: &[JobEntry]) -> Result<(), Failure> {
    let line = |(i, entry): (usize, &JobEntry)| {
        let part = entry.part.as_ref().map_or(String::new(), |views| format!("\tviews {views}"));
        format!("{}\t{}\t{}{part}\n", i + 1, entry.scene.display(), entry.output.display())
    };
    talk::print(&entries.iter().enumerate().map(line).collect::<String>())
}

/// Returns the entries with these numbers, counted from 1.
fn chosen(entries: Vec<JobEntry>, only: &FrameList) -> Result<Vec<JobEntry>, Failure> {
    let count = entries.len();
    if only.last() > count {
        let last = only.last();
        return Err(Failure::usage(anyhow!(
            "--only: there is no entry {last}; the job files have {count} entries, which --list prints"
        )));
    }
    let numbers: BTreeSet<usize> = only.iter().collect();
    Ok((1..).zip(entries).filter(|(number, _)| numbers.contains(number)).map(|(_, entry)| entry).collect())
}

/// A running batch.
struct BatchRun {
    args: BatchArgs,
    control: Arc<Control>,
    /// Part of the progress of the run that the batch takes.
    span: RunSpan,
    /// Number of entries.
    count: usize,
    /// Number of entries that were started.
    begun: usize,
    /// Number of entries that failed.
    failed: usize,
}

/// A checked entry: an image, or a walk or the views of a list.
enum Job {
    Still(Box<RenderJob>),
    Walk(Box<WalkJob>),
}

impl BatchRun {
    /// Renders the entries, ordered by scene.
    fn render(mut self, mut left: Vec<JobEntry>) -> Result<(), Failure> {
        while let Some(first) = left.first().cloned() {
            let is_of_scene =
                |entry: &JobEntry| (&entry.scene, &entry.reading) == (&first.scene, &first.reading);
            let (of_scene, others) = left.into_iter().partition(is_of_scene);
            left = others;
            self.scene(of_scene)?;
        }
        let done = self.count - self.failed;
        let what = if self.args.dry_run { "can be rendered" } else { "done" };
        talk::summary(
            &format!("{done} of {} images, walks and views {what}", self.count),
            || json!({ "done": done, "failed": self.failed }),
        );
        match self.failed {
            0 => Ok(()),
            failed => {
                let others = if done > 0 { "; the others are complete" } else { "" };
                let message = anyhow!("{failed} of {} images, walks and views failed{others}", self.count);
                Err(Failure::in_part(message))
            }
        }
    }

    /// Reads a scene and renders its entries.
    ///
    /// # Errors
    /// If a signal stopped the run. Other failures are counted.
    fn scene(&mut self, entries: Vec<JobEntry>) -> Result<(), Failure> {
        let mut opened = None;
        for entry in &entries {
            if self.control.is_cancelled() {
                let message = "interrupted; run the same command with --resume to continue";
                return Err(Failure::interrupted(anyhow!(message)));
            }
            talk::event(
                "picture",
                || json!({ "state": "start", "index": self.begun, "count": self.count, "output": entry.output.to_string_lossy() }),
            );
            let span = self.span.part(self.begun, self.count);
            self.begun += 1;
            // A defect of one image must not stop the others. The panic hook has printed it.
            let done = catch_unwind(AssertUnwindSafe(|| self.entry(entry, &mut opened, span)));
            let done = done.unwrap_or_else(|_| {
                Err(Failure::render(anyhow!(
                    "an internal error stopped this image; please report it with the lines above"
                )))
            });
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

    /// Renders an entry. Reads its scene if `opened` is empty.
    fn entry(&self, entry: &JobEntry, opened: &mut Option<Opened>, span: RunSpan) -> Result<(), Failure> {
        let job = self.command(entry)?;
        let opened = match opened {
            Some(opened) => opened,
            None => opened.insert(opened::open(&entry.scene, &entry.reading)?),
        };
        match job {
            Job::Still(job) => render::still(&job, opened, span, &self.control),
            Job::Walk(job) => walk::walk(*job, opened, span, &self.control),
        }
    }

    /// Checks the command of an entry.
    fn command(&self, entry: &JobEntry) -> Result<Job, Failure> {
        match entry.command()? {
            Command::Render(mut args) => {
                args.picture.progress = self.args.progress;
                args.picture.dry_run |= self.args.dry_run;
                Ok(Job::Still(Box::new(RenderJob::new(*args, Stopwatch::start())?)))
            }
            Command::Walk(mut args) => {
                args.picture.progress = self.args.progress;
                args.picture.dry_run |= self.args.dry_run;
                Ok(Job::Walk(Box::new(WalkJob::new(*args)?)))
            }
            Command::Views(mut args) => {
                args.picture.progress = self.args.progress;
                args.picture.dry_run |= self.args.dry_run;
                Ok(Job::Walk(Box::new(views::job(*args)?)))
            }
            _ => Err(Failure::usage(anyhow!(
                "{}: this entry is no image, walk or list of views",
                entry.output.display()
            ))),
        }
    }

    /// Counts and prints a failure; returns `None` if there is one.
    fn settle(&mut self, entry: &JobEntry, done: Result<(), Failure>) -> Option<()> {
        done.map_err(|failure| {
            self.failed += 1;
            let is_of_job = failure.code() == exit::USAGE;
            let failure = failure.within(&entry.output);
            talk::error(&if is_of_job { failure.at(&entry.place) } else { failure });
        })
        .ok()
    }
}
