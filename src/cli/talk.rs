//! Output: messages on stderr, data on stdout. Messages are prose, or events, one JSON object a line, by the schema in
//! docs/progress.md; or prose with lines between that agents of Open Job Description read.

use super::exit::Failure;
use super::values::ProgressMode;
use anyhow::Context;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Instant;

/// Version of the schema of events: it grows when a field or event goes or changes its meaning, not when one comes.
const SCHEMA: u32 = 1;

/// Kind of messages, and the start of the run. Set once, before any message.
static VOICE: OnceLock<(ProgressMode, Instant)> = OnceLock::new();

fn mode() -> ProgressMode {
    VOICE.get().map_or(ProgressMode::Auto, |(mode, _)| *mode)
}

/// Seconds since the start of the run.
pub fn seconds() -> f64 {
    VOICE.get().map_or(0.0, |(_, start)| start.elapsed().as_secs_f64())
}

/// Chooses the kind of messages for the rest of the run, and says that it begins.
pub fn start(mode: ProgressMode, command: &str) {
    VOICE.get_or_init(|| (mode, Instant::now()));
    event("start", || json!({ "command": command, "version": env!("CARGO_PKG_VERSION") }));
}

/// Says how the run ended, for programs.
pub fn end(code: u8) {
    event("end", || json!({ "exit": code, "seconds": seconds() }));
}

/// Something the user should know.
pub fn note(text: &str) {
    say("note", text);
}

/// Prints a warning that the result may differ from the user's expectation.
pub fn warning(text: &str) {
    say("warning", text);
}

/// Why the run, or a part of it, failed.
pub fn error(failure: &Failure) {
    if mode() == ProgressMode::Openjd {
        line(&format!("openjd_fail: {failure}"));
    }
    say("error", &failure.to_string());
}

/// Files that have been written, whole.
pub fn wrote(text: &str, files: &[PathBuf]) {
    match mode() {
        ProgressMode::Ndjson => event("wrote", || {
            let names: Vec<_> = files.iter().map(|path| path.to_string_lossy()).collect();
            json!({ "files": names, "text": text })
        }),
        _ => note(text),
    }
}

/// The sum of a run of several pictures, with figures for programs.
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

/// An event for programs that watch, where they do: its kind and its fields, an object.
pub fn event(kind: &str, fields: impl FnOnce() -> Value) {
    if mode() == ProgressMode::Ndjson {
        let mut object = fields();
        object["v"] = SCHEMA.into();
        object["event"] = kind.into();
        line(&object.to_string());
    }
}

/// One line. Nobody may be listening, which is no error.
pub fn line(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

fn say(kind: &str, text: &str) {
    match mode() {
        ProgressMode::Ndjson => event(kind, || json!({ "text": text })),
        _ if kind == "note" => line(text),
        _ => line(&format!("{kind}: {text}")),
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
