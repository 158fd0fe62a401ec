//! Signals: Ctrl-C, SIGTERM and SIGHUP, and SIGUSR1.
//!
//! The first signal asks the method to stop and to return its partial result. The second signal ends the process at
//! once. Files are complete or unchanged, so that no existing file is lost. While a scene is read there is no partial
//! result, and the first signal ends the process.
//!
//! SIGUSR1 asks for a preview.

use super::exit::{self, Failure};
use super::talk;
use anyhow::anyhow;
use base::progress::Control;
use embree::leave;
use signal_hook::consts::SIGUSR1;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// True while a scene is being read.
static IS_OPENING: AtomicBool = AtomicBool::new(false);

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

/// Returns true if a signal has asked for a preview since the last call.
pub fn takes_request_for_preview() -> bool {
    WANTS_PREVIEW.get().is_some_and(|wants| wants.swap(false, Ordering::SeqCst))
}

/// Cancels `control` when a signal to end arrives, and takes requests for previews. Call it once per process.
///
/// # Errors
/// If a handler cannot be installed.
pub fn cancel_on_signal(control: &Arc<Control>) -> Result<(), ctrlc::Error> {
    let wants = WANTS_PREVIEW.get_or_init(Arc::default);
    signal_hook::flag::register(SIGUSR1, Arc::clone(wants)).map_err(ctrlc::Error::System)?;
    let control = Arc::clone(control);
    ctrlc::set_handler(move || {
        if control.is_cancelled() {
            end(exit::ABORTED);
        }
        control.cancel();
        if IS_OPENING.load(Ordering::SeqCst) {
            talk::error(&Failure::interrupted(anyhow!(
                "interrupted while reading the scene; nothing is written"
            )));
            end(exit::INTERRUPTED);
        }
        talk::note("interrupted: finishing up; press Ctrl-C again to stop at once");
    })
}

fn end(code: u8) -> ! {
    talk::end(code);
    leave(code)
}
