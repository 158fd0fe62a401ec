//! Ctrl-C, SIGTERM and SIGHUP: the first asks the method to stop and return its partial result, the second
//! ends the process at once. Files are written whole or not at all, so that even then former files are not
//! lost.

use super::exit;
use super::talk;
use crate::progress::Control;
use std::sync::Arc;

/// Cancels `control` when a signal comes. To be called once in a process.
pub fn cancel_on_signal(control: &Arc<Control>) -> Result<(), ctrlc::Error> {
    let control = Arc::clone(control);
    ctrlc::set_handler(move || {
        if control.is_cancelled() {
            talk::end(exit::ABORTED);
            std::process::exit(exit::ABORTED.into());
        }
        control.cancel();
        talk::note("interrupted: stopping; once more to stop at once");
    })
}
