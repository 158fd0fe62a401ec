//! The key of a picture: a hash of all that decides what is in its files, by which `--resume` knows them again.

use base::film::ExrFile;
use readers::fnv1a;
use render::method::path::Begun;
use render::session::{Goal, Session, Wanted};
use serde_json::{Value, json};
use std::path::Path;

/// Key of a picture of `session` for `goal`, by the version of the program, and `more` that decides; but for whether
/// the denoiser is there.
pub fn of(session: &Session, goal: &Goal, more: Value) -> String {
    let Goal { method, may_choose, wanted, features, denoise_quality, keep_noisy, verify, .. } = goal;
    let wanted = match wanted {
        Wanted::AsSet => Value::Null,
        Wanted::Time { seconds, held, .. } => json!([seconds, held]),
        Wanted::Error { error, max_samples, held } => json!([error, max_samples, held]),
    };
    hash(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scene": session.hash,
        "method": method.name(),
        "may_choose": may_choose,
        "settings": method.settings(),
        "wanted": wanted,
        "features": format!("{features:?}"),
        "denoise": goal.denoises(),
        "denoise_quality": format!("{denoise_quality:?}"),
        "keep_noisy": keep_noisy,
        "verify": format!("{verify:?}"),
        "more": more,
    }))
}

/// Key of a frame whose records come of `frames`, of which it is the last, in a walk of key `walk`.
pub fn of_frame(walk: &str, frames: &[usize]) -> String {
    hash(json!([walk, frames]))
}

fn hash(decisive: Value) -> String {
    format!("{:016x}", fnv1a(decisive.to_string().as_bytes()))
}

/// True if the files of a picture, the number of its frame given, are whole and have this key.
pub fn is_done((exr, png): (&Path, Option<&Path>), frame: Option<usize>, key: &str) -> bool {
    ExrFile::read(exr).is_ok_and(|file| file.color().is_ok() && is_it(&file, frame, key, "false"))
        && png.is_none_or(|png| image::open(png).is_ok())
}

/// True if the file is a part of the picture that has this key.
pub fn is_part(exr: &Path, frame: Option<usize>, key: &str) -> bool {
    ExrFile::read(exr).is_ok_and(|file| is_it(&file, frame, key, "true"))
}

/// The samples of the picture that has this key, where it was interrupted and can go on.
pub fn begun(exr: &Path, frame: Option<usize>, key: &str) -> Option<Begun> {
    let file = ExrFile::read(exr).ok()?;
    is_it(&file, frame, key, "true").then(|| Begun::of(&file)).flatten()
}

fn is_it(file: &ExrFile, frame: Option<usize>, key: &str, partial: &str) -> bool {
    let metadata = file.metadata();
    metadata.text("job") == Some(key)
        && metadata.number("frame") == frame.map(|number| number as f64)
        && metadata.text("partial") == Some(partial)
}
