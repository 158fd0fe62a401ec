//! Tests on public scenes that are no part of the project: they are searched for in `$LIGHTSPLAT_SHARED` and
//! beside the checkout, and where they are absent the tests are skipped with a message.

mod scenes;
mod slow_references;

use std::path::PathBuf;

/// Returns the folder of the public scenes.
fn shared_scenes() -> Option<PathBuf> {
    let beside = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared"));
    let folder = std::env::var_os("LIGHTSPLAT_SHARED").map_or(beside, PathBuf::from).join("scenes");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no shared scenes at {}", folder.display());
    None
}
