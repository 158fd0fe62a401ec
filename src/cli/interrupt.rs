//! Signals: Ctrl-C, SIGTERM and SIGHUP.
//!
//! The first signal asks the method to stop and to return its partial result. The second signal ends the process at
//! once. Files are complete or unchanged, so that no existing file is lost. While a scene is read there is no partial
//! result, and the first signal ends the process.

use super::exit::{self, Failure};
use super::talk;
use anyhow::anyhow;
use base::progress::Control;
use embree::leave;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// True while a scene is being read.
static IS_OPENING: AtomicBool = AtomicBool::new(false);

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

/// Cancels `control` when a signal arrives. Call it once per process.
///
/// # Errors
/// If the handler cannot be installed.
pub fn cancel_on_signal(control: &Arc<Control>) -> Result<(), ctrlc::Error> {
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
