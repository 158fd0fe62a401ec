//! Output: messages on stderr, data on stdout.

use super::exit::Failure;
use super::values::ProgressMode;
use anyhow::Context;
use serde_json::json;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// True if stderr is NDJSON, one object a line, instead of prose. Set once, before any message.
static NDJSON: AtomicBool = AtomicBool::new(false);

/// Chooses prose or NDJSON for the rest of the run.
pub fn set_mode(mode: ProgressMode) {
    NDJSON.store(mode == ProgressMode::Ndjson, Ordering::Relaxed);
}

/// Something the user should know.
pub fn note(text: &str) {
    say("note", text);
}

/// Prints a warning that the result may differ from the user's expectation.
pub fn warning(text: &str) {
    say("warning", text);
}

/// Why the run failed.
pub fn error(failure: &Failure) {
    say("error", &failure.to_string());
}

/// One object as a line of its own, for programs that watch. Nobody may be listening, which is no error.
pub fn event(object: &serde_json::Value) {
    let _ = writeln!(io::stderr().lock(), "{object}");
}

/// The same where stderr is NDJSON, nothing elsewhere.
pub fn event_if_wanted(object: impl FnOnce() -> serde_json::Value) {
    if NDJSON.load(Ordering::Relaxed) {
        event(&object());
    }
}

fn say(kind: &str, text: &str) {
    if NDJSON.load(Ordering::Relaxed) {
        event(&json!({ "event": kind, "text": text }));
    } else {
        let prefix = if kind == "note" { String::new() } else { format!("{kind}: ") };
        let _ = writeln!(io::stderr().lock(), "{prefix}{text}");
    }
}

/// Writes data to stdout. That the reader has gone (`| head`) is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(error).context("cannot write to standard output").map_err(Failure::output)
        }
        _ => Ok(()),
    }
}
