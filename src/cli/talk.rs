//! Output: messages go to stderr, data goes to stdout.
//!
//! Messages are prose, or events (one JSON object per line, by the schema in docs/progress.md), or prose with
//! additional lines for agents of Open Job Description.

use super::exit::Failure;
use super::values::{Loudness, ProgressMode};
use anyhow::Context;
use base::shown::shown;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Instant;

/// Environment variable of the form of the messages.
pub const VARIABLE: &str = "LIGHTSPLAT_PROGRESS";

/// Version of the schema of events. A version ends if a field or an event is removed or changes its meaning.
const SCHEMA: u32 = 1;

/// Kind and number of messages, and the start of the run. The first call of [`start`] sets it.
static VOICE: OnceLock<(ProgressMode, Loudness, Instant)> = OnceLock::new();

fn mode() -> ProgressMode {
    VOICE.get().map_or(ProgressMode::Auto, |(mode, ..)| *mode)
}

/// Returns how much is said.
pub fn loudness() -> Loudness {
    VOICE.get().map_or(Loudness::default(), |(_, loudness, _)| *loudness)
}

/// Returns the seconds since the start of the run.
pub fn seconds() -> f64 {
    VOICE.get().map_or(0.0, |(.., start)| start.elapsed().as_secs_f64())
}

/// Sets kind and number of messages for the rest of the run, and writes the first event.
pub fn start(mode: ProgressMode, loudness: Loudness, command: &str) {
    VOICE.get_or_init(|| (mode, loudness, Instant::now()));
    event("start", || json!({ "command": command, "version": env!("CARGO_PKG_VERSION") }));
}

/// Writes the last event.
pub fn end(code: u8) {
    event("end", || json!({ "exit": code, "seconds": seconds() }));
}

/// Prints a note.
pub fn note(text: &str) {
    say("note", text);
}

/// Prints a warning: the result may differ from what the user expects.
pub fn warning(text: &str) {
    say("warning", text);
}

/// Prints why the run, or a part of it, failed.
pub fn error(failure: &Failure) {
    if mode() == ProgressMode::Openjd {
        line(&format!("openjd_fail: {failure}"));
    }
    say("error", &failure.to_string());
}

/// Reports files that are complete.
pub fn wrote(text: &str, files: &[PathBuf]) {
    match mode() {
        ProgressMode::Ndjson => event("wrote", || {
            let names: Vec<_> = files.iter().map(|path| path.to_string_lossy()).collect();
            json!({ "files": names, "text": text })
        }),
        _ => note(text),
    }
}

/// Reports the result of a run of several images. `figures` are for programs.
pub fn summary(text: &str, figures: impl FnOnce() -> Value) {
    match mode() {
        ProgressMode::Ndjson => event("summary", || {
            let mut figures = figures();
            figures["text"] = text.into();
            figures
        }),
        _ => note(text),
    }
}

/// Writes an event for programs, if the messages are events. `fields` returns an object.
pub fn event(kind: &str, fields: impl FnOnce() -> Value) {
    if mode() == ProgressMode::Ndjson {
        let mut object = fields();
        object["v"] = SCHEMA.into();
        object["event"] = kind.into();
        line(&object.to_string());
    }
}

/// Writes a line. Characters that act on a terminal are escaped. A closed stderr is no error.
pub fn line(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", shown(text));
}

fn say(kind: &str, text: &str) {
    match mode() {
        ProgressMode::Auto if loudness() == Loudness::Quiet && kind != "error" => {}
        ProgressMode::Ndjson => event(kind, || json!({ "text": text })),
        _ if kind == "note" => line(text),
        _ => line(&format!("{kind}: {text}")),
    }
}

/// Writes text to stdout. Characters that act on a terminal are escaped. A reader that has closed the pipe
/// (`| head`) is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    print_bytes(shown(text).as_bytes())
}

/// Writes data to stdout. A reader that has closed the pipe is no error.
pub fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(error).context("cannot write to standard output").map_err(Failure::output)
        }
        _ => Ok(()),
    }
}
