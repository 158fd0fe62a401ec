//! Previews: what is rendered so far as a PNG file, and in the viewer tev.
//!
//! Threads of their own read copies of the image. A preview that cannot be written is one warning, and no error.

use super::beside::{beside, goes_on, spacing};
use super::exit::Failure;
use super::live_args::LiveArgs;
use super::outputs::{self, OutputCheck};
use super::tev::Tev;
use super::{interrupt, talk};
use anyhow::anyhow;
use base::film::{Film, Image, ImageError, Look, Tone, write_png};
use base::live::LiveImage;
use base::progress::Control;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// Interval between previews, unless the user sets it.
const EVERY: Duration = Duration::from_secs(10);
/// Interval between looks at clock and signals.
const TICK: Duration = Duration::from_millis(100);

/// Previews that a command asks for.
#[derive(Debug)]
pub struct Previews {
    /// PNG file that is written at intervals.
    file: Option<PathBuf>,
    every: Duration,
    /// Address of tev.
    tev: Option<String>,
    tone: Tone,
}

impl Previews {
    /// Checks the arguments, and that the file can be written. `tone` is that of the final PNG file.
    ///
    /// # Errors
    /// If the name of the file is wrong, or it cannot be written.
    pub fn new(args: LiveArgs, tone: Tone, check: OutputCheck) -> Result<Previews, Failure> {
        if let Some(file) = &args.preview {
            outputs::check_name(file, "png", "--preview", "for PNG")?;
            outputs::check_output(file, OutputCheck { may_stay: false, ..check })?;
        }
        let every = args.every.map_or(EVERY, Duration::from_secs_f64);
        Ok(Previews { file: args.preview, every, tev: args.tev, tone })
    }

    /// Returns the file that is written at intervals, if any.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Begins to show the images of a run under a name, which tev displays.
    pub fn begin(&self, name: &str) -> Showing<'_> {
        let threads = u32::try_from(rayon::current_num_threads()).unwrap_or(u32::MAX);
        let tev = self.tev.clone().map(|address| Tev::start(address, name.to_owned(), threads));
        Showing {
            previews: self,
            tev,
            threads,
            due: Instant::now() + self.every,
            is_asked: false,
            has_warned: false,
        }
    }
}

/// Images that are shown while they are rendered.
pub struct Showing<'a> {
    previews: &'a Previews,
    tev: Option<Tev>,
    threads: u32,
    /// Time of the next preview.
    due: Instant,
    /// True while a signal asks for a preview, and there is no image yet.
    is_asked: bool,
    has_warned: bool,
}

/// An image that is about to be rendered.
pub struct ShownFrame {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Look of the final image, if it is known before the image is.
    pub look: Option<Look>,
    /// File for a preview that a signal asks for, unless the command names one.
    pub beside: PathBuf,
}

impl Showing<'_> {
    /// Runs `work`, which renders an image under `control`, while other threads show what is there.
    pub fn frame<R>(&mut self, frame: &ShownFrame, control: &Control, work: impl FnOnce() -> R) -> R {
        let live = Arc::new(LiveImage::new(frame.size));
        control.watch(Some(Arc::clone(&live)));
        if let Some(tev) = &self.tev {
            tev.watch(&live);
        }
        let result = beside(work, |stop| self.write_previews(&live, frame, stop));
        control.watch(None);
        result
    }

    /// Writes a preview when one is due, or a signal asks for one, until the work ends.
    fn write_previews(&mut self, live: &LiveImage, frame: &ShownFrame, stop: Receiver<()>) {
        let mut shown = 0;
        while goes_on(&stop, TICK) {
            // A request that comes while a preview is written asks for the next one.
            self.is_asked |= interrupt::takes_request_for_preview();
            let changes = live.changes();
            let is_due = self.previews.file.is_some() && Instant::now() >= self.due && changes != shown;
            if !self.is_asked && !is_due {
                continue;
            }
            let begun = Instant::now();
            // A request stays until there is an image.
            let Some(copy) = live.copy() else { continue };
            let look = frame.look.unwrap_or_else(|| self.previews.tone.look(&copy.known));
            let file = self.previews.file().unwrap_or(&frame.beside);
            let written = write_png(file, &copy.image, look);
            if self.is_asked && written.is_ok() {
                talk::note(&format!("wrote {} (preview)", file.display()));
            }
            self.is_asked = false;
            self.report(written);
            shown = changes;
            self.due = begun + self.previews.every.max(spacing(begun.elapsed(), self.threads));
        }
    }

    /// Shows an image at the end of its rendering.
    pub fn rendered(&self, image: &Image) {
        if let Some(tev) = &self.tev {
            tev.show(image);
        }
    }

    /// Replaces the preview by the last image of a run.
    pub fn last(&mut self, film: &Film) {
        if let Some(file) = self.previews.file() {
            self.report(write_png(file, film.shown(), self.previews.tone.look(film.shown())));
        }
    }

    /// Warns of the first preview that cannot be written.
    fn report(&mut self, written: Result<(), ImageError>) {
        if let Err(error) = written
            && !self.has_warned
        {
            self.has_warned = true;
            talk::warning(&format!("{:#}; rendering goes on without this preview", anyhow!(error)));
        }
    }
}
