//! `lightsplat batch`: renders the images, walks and views of job files.
//!
//! Each scene is read once. A failure of one entry does not stop the others.

use super::args::{BatchArgs, Command};
use super::batch_file::{self, JobEntry};
use super::course::RunSpan;
use super::exit::{self, Failure};
use super::job::RenderJob;
use super::side_by_side::SideBySide;
use super::values::{Loudness, ProgressMode};
use super::walk_job::WalkJob;
use super::{batch_outputs, interrupt, opened, render, talk, threads, views, walk};
use ::render::session::Opened;
use ::render::walk::FrameList;
use anyhow::{Context, anyhow};
use base::progress::Control;
use base::stats::Stopwatch;
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

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
    let BatchArgs { dry_run, progress, at_once, .. } = args;
    BatchRun::new(Manner { jobs: at_once.get(), dry_run, progress })?
        .run(entries, threads::count(args.threads))
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

/// How entries are rendered.
#[derive(Clone, Copy)]
pub struct Manner {
    /// Maximum number of entries at a time.
    pub jobs: usize,
    /// True if nothing is rendered or written.
    pub dry_run: bool,
    /// Form of the messages on stderr.
    pub progress: ProgressMode,
}

/// A running batch.
pub struct BatchRun {
    manner: Manner,
    control: Arc<Control>,
    /// Number of entries that were started.
    begun: AtomicUsize,
    /// Number of entries that failed.
    failed: AtomicUsize,
}

/// An entry, and its scene, which the first entry reads and the last one drops.
struct Task {
    entry: JobEntry,
    opened: Arc<Mutex<Option<Arc<Opened>>>>,
}

/// Part of a batch that an entry takes.
#[derive(Clone, Copy)]
struct Part {
    /// Maximum number of views of a list at a time.
    jobs: usize,
    progress: ProgressMode,
    span: RunSpan,
    /// Number of entries of the batch.
    count: usize,
}

/// Returns tasks ordered by scene. Entries of one scene share it.
fn by_scene(entries: Vec<JobEntry>) -> Vec<Task> {
    let mut numbers: BTreeMap<(PathBuf, String), usize> = BTreeMap::new();
    let mut scenes: Vec<Vec<JobEntry>> = Vec::new();
    for entry in entries {
        let key = (entry.scene.clone(), format!("{:?}", entry.reading));
        let number = *numbers.entry(key).or_insert(scenes.len());
        if number == scenes.len() {
            scenes.push(Vec::new());
        }
        scenes[number].push(entry);
    }
    let tasks = |entries: Vec<JobEntry>| {
        let opened = Arc::default();
        entries.into_iter().map(move |entry| Task { entry, opened: Arc::clone(&opened) })
    };
    scenes.into_iter().flat_map(tasks).collect()
}

/// A checked entry: an image, or a walk or the views of a list.
enum Job {
    Still(Box<RenderJob>),
    Walk(Box<WalkJob>),
}

impl BatchRun {
    /// Prepares to render. Signals stop the run.
    pub fn new(manner: Manner) -> Result<BatchRun, Failure> {
        let control = Arc::new(Control::new());
        interrupt::cancel_on_signal(&control).context("cannot catch signals").map_err(Failure::render)?;
        Ok(BatchRun { manner, control, begun: AtomicUsize::new(0), failed: AtomicUsize::new(0) })
    }

    /// Checks and renders the entries.
    ///
    /// # Errors
    /// If an entry fails. The others are rendered unless a signal stopped the run.
    pub fn run(&self, mut entries: Vec<JobEntry>, threads: usize) -> Result<(), Failure> {
        let count = entries.len();
        // Report outputs that cannot be written before hours of work.
        entries.retain(|entry| {
            let checked = self.command(entry).map(drop);
            self.settle(entry, checked).is_some()
        });
        let tasks = by_scene(entries);
        threads::pool(threads)?.install(|| self.render(tasks, count))?;
        let failed = self.failed.load(Ordering::Relaxed);
        let done = count - failed;
        let what = if self.manner.dry_run { "can be rendered" } else { "done" };
        talk::summary(
            &format!("{done} of {count} images, walks and views {what}"),
            || json!({ "done": done, "failed": failed }),
        );
        let others = if done > 0 { "; the others are complete" } else { "" };
        match failed {
            0 => Ok(()),
            failed => {
                Err(Failure::in_part(anyhow!("{failed} of {count} images, walks and views failed{others}")))
            }
        }
    }

    /// Renders the tasks of a batch with `count` entries.
    ///
    /// # Errors
    /// If a signal stopped the run. Other failures are counted.
    fn render(&self, tasks: Vec<Task>, count: usize) -> Result<(), Failure> {
        let Manner { jobs, progress, .. } = self.manner;
        let (at_once, span) = (jobs.min(tasks.len()), RunSpan::begin());
        // The rest of the threads goes to the views of each list.
        let within = jobs / at_once.max(1);
        if at_once > 1 {
            let quiet = Part { jobs: within, progress: ProgressMode::None, span, count };
            return SideBySide { jobs: at_once, control: &self.control, progress, span }
                .each(tasks, |task, control| self.task(&task, quiet, control));
        }
        let index = || self.begun.load(Ordering::Relaxed);
        let part = || Part { jobs: within, progress, span: span.part(index(), count), count };
        tasks.into_iter().try_for_each(|task| self.task(&task, part(), &self.control))
    }

    /// Renders an entry.
    ///
    /// # Errors
    /// If a signal stopped the run. Other failures are counted.
    fn task(&self, task: &Task, part: Part, control: &Control) -> Result<(), Failure> {
        let entry = &task.entry;
        if control.is_cancelled() {
            let message = "interrupted; run the same command with --resume to continue";
            return Err(Failure::interrupted(anyhow!(message)));
        }
        let (index, count, output) =
            (self.begun.fetch_add(1, Ordering::Relaxed), part.count, entry.output.to_string_lossy());
        talk::event(
            "picture",
            || json!({ "state": "start", "index": index, "count": count, "output": output }),
        );
        // A defect of one image must not stop the others. The panic hook has printed it.
        let done = catch_unwind(AssertUnwindSafe(|| self.entry(task, part, control)));
        let done = done.unwrap_or_else(|_| {
            Err(Failure::render(anyhow!(
                "an internal error stopped this image; please report it with the lines above"
            )))
        });
        match done {
            Err(failure) if control.is_cancelled() => Err(failure),
            done => {
                let state = if self.settle(entry, done).is_some() { "end" } else { "failed" };
                talk::event("picture", || json!({ "state": state, "output": output }));
                Ok(())
            }
        }
    }

    /// Renders an entry. Reads its scene if no other entry has.
    fn entry(&self, task: &Task, part: Part, control: &Control) -> Result<(), Failure> {
        let entry = &task.entry;
        let job = self.command(entry)?;
        let opened = {
            // A panic leaves it empty or complete.
            let mut opened = task.opened.lock().unwrap_or_else(PoisonError::into_inner);
            match &*opened {
                Some(opened) => Arc::clone(opened),
                None => Arc::clone(opened.insert(Arc::new(opened::open(&entry.scene, &entry.reading)?))),
            }
        };
        match job {
            Job::Still(mut job) => {
                job.progress = part.progress;
                render::still(&job, &opened, part.span, control)
            }
            Job::Walk(mut job) => {
                (job.progress, job.jobs) = (part.progress, part.jobs);
                walk::walk(*job, &opened, part.span, control)
            }
        }
    }

    /// Checks the command of an entry.
    fn command(&self, entry: &JobEntry) -> Result<Job, Failure> {
        match entry.command()? {
            Command::Render(mut args) => {
                args.picture.progress = self.manner.progress;
                args.picture.dry_run |= self.manner.dry_run;
                Ok(Job::Still(Box::new(RenderJob::new(*args, Stopwatch::start())?)))
            }
            Command::Walk(mut args) => {
                args.picture.progress = self.manner.progress;
                args.picture.dry_run |= self.manner.dry_run;
                Ok(Job::Walk(Box::new(WalkJob::new(*args)?)))
            }
            Command::Views(mut args) => {
                args.picture.progress = self.manner.progress;
                args.picture.dry_run |= self.manner.dry_run;
                Ok(Job::Walk(Box::new(views::job(*args)?)))
            }
            _ => Err(Failure::usage(anyhow!(
                "{}: this entry is no image, walk or list of views",
                entry.output.display()
            ))),
        }
    }

    /// Counts and prints a failure; returns `None` if there is one.
    fn settle(&self, entry: &JobEntry, done: Result<(), Failure>) -> Option<()> {
        done.map_err(|failure| {
            self.failed.fetch_add(1, Ordering::Relaxed);
            let is_of_job = failure.code() == exit::USAGE;
            let failure = failure.within(&entry.output);
            talk::error(&if is_of_job { failure.at(&entry.place) } else { failure });
        })
        .ok()
    }
}
