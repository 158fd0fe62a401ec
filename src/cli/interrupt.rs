//! Signals: Ctrl-C, SIGTERM and SIGHUP, and SIGUSR1.
//!
//! The first signal asks the method to stop and to return its partial result. The second signal ends the process at
//! once. Files are complete or unchanged, so that no existing file is lost. While a scene is read there is no partial
//! result, and the first signal ends the process.
//!
//! SIGUSR1 asks for a preview. Signals that are ignored when the program starts stay ignored.

use super::exit::{self, Failure};
use super::talk;
use anyhow::anyhow;
use base::progress::Control;
use embree::leave;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXFSZ};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::{fs, io, thread};

/// Signals that end a run.
const ENDING: [i32; 3] = [SIGHUP, SIGINT, SIGTERM];

/// True while a scene is being read.
static IS_OPENING: AtomicBool = AtomicBool::new(false);

/// Number of works that may read scenes beside images that they render.
static SIDE_BY_SIDE: AtomicUsize = AtomicUsize::new(0);

/// True if SIGUSR1 asks for a preview, until the request is taken.
static WANTS_PREVIEW: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Resets [`IS_OPENING`] when it is dropped, after a panic, too.
struct Opening;

impl Drop for Opening {
    fn drop(&mut self) {
        IS_OPENING.store(false, Ordering::SeqCst);
    }
}

/// Runs `work`, which reads a scene and writes nothing.
pub fn while_opening<R>(work: impl FnOnce() -> R) -> R {
    IS_OPENING.store(true, Ordering::SeqCst);
    let _opening = Opening;
    work()
}

/// Runs `work`, which may read scenes beside images that it renders. The images finish up after a signal.
pub fn while_side_by_side<R>(work: impl FnOnce() -> R) -> R {
    SIDE_BY_SIDE.fetch_add(1, Ordering::SeqCst);
    let result = work();
    SIDE_BY_SIDE.fetch_sub(1, Ordering::SeqCst);
    result
}

/// Returns true if a signal has asked for a preview since the last call.
pub fn takes_request_for_preview() -> bool {
    WANTS_PREVIEW.get().is_some_and(|wants| wants.swap(false, Ordering::SeqCst))
}

/// Cancels `control` when a signal to end arrives, and takes requests for previews. Call it once per process.
///
/// # Errors
/// If a handler cannot be installed.
pub fn cancel_on_signal(control: &Arc<Control>) -> io::Result<()> {
    let ignored = Ignored::now();
    if !ignored.has(SIGUSR1) {
        flag::register(SIGUSR1, Arc::clone(WANTS_PREVIEW.get_or_init(Arc::default)))?;
    }
    let mut signals = Signals::new(ENDING.into_iter().filter(|signal| !ignored.has(*signal)))?;
    let control = Arc::clone(control);
    let watch = move || signals.forever().for_each(|_| cancel(&control));
    thread::Builder::new().name("signals".to_owned()).spawn(watch).map(drop)
}

/// Makes writing beyond the size limit of files an error instead of the end of the process, which would leave a
/// temporary file.
///
/// # Errors
/// If a handler cannot be installed.
pub fn keep_running_at_size_limit() -> io::Result<()> {
    // Calls that write fail if the signal is caught or ignored.
    if !Ignored::now().has(SIGXFSZ) {
        flag::register(SIGXFSZ, Arc::default())?;
    }
    Ok(())
}

/// Reacts to a signal to end.
fn cancel(control: &Control) {
    if control.is_cancelled() {
        end(exit::ABORTED);
    }
    control.cancel();
    if IS_OPENING.load(Ordering::SeqCst) && SIDE_BY_SIDE.load(Ordering::SeqCst) == 0 {
        talk::error(&Failure::interrupted(anyhow!(
            "interrupted while reading the scene; nothing is written"
        )));
        end(exit::INTERRUPTED);
    }
    talk::note("interrupted: finishing up; press Ctrl-C again to stop at once");
}

/// Signals that were ignored when the program started, one bit each. They stay ignored: `nohup`, `trap ''` and jobs in
/// the background of scripts ask for it.
struct Ignored(u64);

impl Ignored {
    /// Reads the signals that this process ignores. Without the file of Linux, none are known.
    fn now() -> Ignored {
        Ignored::parse(&fs::read_to_string("/proc/self/status").unwrap_or_default())
    }

    fn parse(status: &str) -> Ignored {
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        Ignored(mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0))
    }

    fn has(&self, signal: i32) -> bool {
        u32::try_from(signal - 1)
            .ok()
            .and_then(|bit| self.0.checked_shr(bit))
            .is_some_and(|bits| bits & 1 == 1)
    }
}

fn end(code: u8) -> ! {
    talk::end(code);
    leave(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_signals_are_bits_of_the_mask_in_the_status() {
        let found = |status: &str| {
            [SIGHUP, SIGINT, SIGUSR1, SIGTERM].map(|signal| Ignored::parse(status).has(signal))
        };
        assert_eq!(
            found("SigBlk:\t00000000ffffffff\nSigIgn:\t0000000000001001\n"),
            [true, false, false, false]
        );
        assert_eq!(found("SigIgn:\t0000000000004202"), [false, true, true, true]);
        for none in ["", "SigIgn:\tx", "SigIgn:"] {
            assert_eq!(found(none), [false; 4], "{none}");
        }
    }
}
