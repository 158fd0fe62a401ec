//! Ctrl-C, SIGTERM and SIGHUP: the first asks the method to stop and return its partial result, the second
//! ends the process at once. Files are written whole or not at all, so that even then former files are not
//! lost. While a scene is opened there is no partial result, and the first ends the process.

use super::exit::{self, Failure};
use super::talk;
use anyhow::anyhow;
use base::progress::Control;
use embree::leave;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// True while a scene is opened.
static IS_OPENING: AtomicBool = AtomicBool::new(false);

/// Sets [`IS_OPENING`] back, even if opening panics.
struct Opening;

impl Drop for Opening {
    fn drop(&mut self) {
        IS_OPENING.store(false, Ordering::SeqCst);
    }
}

/// Does work that opens a scene and writes nothing.
pub fn while_opening<R>(work: impl FnOnce() -> R) -> R {
    IS_OPENING.store(true, Ordering::SeqCst);
    let _opening = Opening;
    work()
}

/// Cancels `control` when a signal comes. To be called once in a process.
pub fn cancel_on_signal(control: &Arc<Control>) -> Result<(), ctrlc::Error> {
    let control = Arc::clone(control);
    ctrlc::set_handler(move || {
        if control.is_cancelled() {
            end(exit::ABORTED);
        }
        control.cancel();
        if IS_OPENING.load(Ordering::SeqCst) {
            talk::error(&Failure::interrupted(anyhow!("interrupted while the scene is read")));
            end(exit::INTERRUPTED);
        }
        talk::note("interrupted: stopping; once more to stop at once");
    })
}

fn end(code: u8) -> ! {
    talk::end(code);
    leave(code)
}
