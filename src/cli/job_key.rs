//! The key of an image: a hash of everything that its files depend on. `--resume` compares it.

use super::picture::Forms;
use base::film::ExrFile;
use readers::{ViewList, fnv1a};
use render::method::path::PartialImage;
use render::session::{ErrorLimit, Goal, PlanGoal, Session, TimeGoal};
use serde_json::{Value, json};
use std::path::Path;

/// Returns the key of an image of `session` with `goal` by this version of the program. `more` holds further
/// dependencies. The key does not depend on whether the denoiser is installed.
pub fn job_key(session: &Session, goal: &Goal, more: Value) -> String {
    let Goal { method, may_choose, plan, features, averaging, denoise_quality, keep_noisy, verify, .. } =
        goal;
    let plan = match plan {
        PlanGoal::AsSet => Value::Null,
        PlanGoal::Time(TimeGoal { seconds, pinned, .. }) => json!([seconds, pinned]),
        PlanGoal::Error(ErrorLimit { error, max_samples, pinned }) => json!([error, max_samples, pinned]),
    };
    hash(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scene": session.hash,
        "method": method.name(),
        "may_choose": may_choose,
        "settings": method.settings(),
        "wanted": plan,
        "features": format!("{features:?} {averaging:?}"),
        "denoise": goal.denoises(),
        "denoise_quality": format!("{denoise_quality:?}"),
        "keep_noisy": keep_noisy,
        "verify": format!("{verify:?}"),
        "more": more,
    }))
}

/// Returns dependencies with the forms of the files, unless these are the usual ones.
pub fn files(more: Value, forms: Forms) -> Value {
    if forms == Forms::default() { more } else { json!([more, format!("{forms:?}")]) }
}

/// Returns the key of the views of a list with the key `job`. Exposure and virtual lights depend on all views.
pub fn of_views(job: &str, list: &ViewList, exposes_each: bool) -> String {
    hash(json!([job, format!("{:016x}", list.hash()), exposes_each]))
}

/// Returns the key of the last of `frames` in a walk with the key `walk`. Its records come from `frames`.
pub fn of_frame(walk: &str, frames: &[usize]) -> String {
    hash(json!([walk, frames]))
}

fn hash(decisive: Value) -> String {
    format!("{:016x}", fnv1a(decisive.to_string().as_bytes()))
}

/// Returns true if the files of an image are complete and have this key. `frame` is the number of its frame.
pub fn is_done(exr: &Path, png: Option<&Path>, frame: Option<usize>, key: &str) -> bool {
    ExrFile::read(exr).is_ok_and(|file| file.color().is_ok() && is_it(&file, frame, key, "false"))
        && png.is_none_or(|png| image::open(png).is_ok())
}

/// Returns true if the file is a part of the image with this key.
pub fn is_part(exr: &Path, frame: Option<usize>, key: &str) -> bool {
    ExrFile::read(exr).is_ok_and(|file| is_it(&file, frame, key, "true"))
}

/// Returns the samples of an interrupted image with this key, if it can continue.
pub fn begun(exr: &Path, frame: Option<usize>, key: &str) -> Option<PartialImage> {
    let file = ExrFile::read(exr).ok()?;
    is_it(&file, frame, key, "true").then(|| PartialImage::of(&file)).flatten()
}

fn is_it(file: &ExrFile, frame: Option<usize>, key: &str, partial: &str) -> bool {
    let metadata = file.metadata();
    metadata.text("job") == Some(key)
        && metadata.number("frame") == frame.map(|number| number as f64)
        && metadata.text("partial") == Some(partial)
}
