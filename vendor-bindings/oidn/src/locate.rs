//! Search for the library, in this order: `OIDN_DIR`, the program's own folder, `.oidn/` of the repository that it was
//! built in, where `make setup` puts it, and the system's loader. Where the user chose a folder, no other is searched.

use crate::Error;
use std::env;
use std::path::{Path, PathBuf};

/// Names of the library's file; its version is asked for once it is loaded.
const NAMES: [&str; 2] = ["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"];

/// Folder of this package in the repository, unless the program is built for other machines, where anybody might have
/// made a folder of this name.
const REPOSITORY: Option<&str> = match option_env!("LIGHTSPLAT_MOVABLE") {
    None => Some(env!("CARGO_MANIFEST_DIR")),
    Some(_) => None,
};

/// Folders of libraries below an installation's.
const BELOW: [&str; 4] = ["", "lib", "lib64", concat!("lib/", "x86_64-linux-gnu")];

/// The first library for which `open` succeeds.
pub fn first<T>(open: impl Fn(&Path) -> Result<T, String>) -> Result<T, Error> {
    let mut failures = Vec::new();
    if let Some(chosen) = env::var_os("OIDN_DIR").filter(|dir| !dir.is_empty()) {
        let chosen = PathBuf::from(chosen);
        return first_below(&chosen, &open, &mut failures).ok_or_else(|| Error::NotInChosenFolder {
            directory: chosen.display().to_string(),
            tried: failures.join("; "),
        });
    }
    let own = env::current_exe().ok().and_then(|program| Some(program.parent()?.to_owned()));
    let repository = REPOSITORY.map(|package| Path::new(package).join("../../.oidn"));
    let repository = repository.map(|folder| folder.canonicalize().unwrap_or(folder));
    for folder in own.into_iter().chain(repository) {
        if let Some(found) = first_below(&folder, &open, &mut failures) {
            return Ok(found);
        }
    }
    open(Path::new(NAMES[0])).map_err(|reason| {
        failures.push(format!("the system's loader: {reason}"));
        Error::NotFound { tried: failures.join("; ") }
    })
}

/// The first library in `folder`, or in the usual folders below it, for which `open` succeeds.
fn first_below<T>(
    folder: &Path,
    open: &impl Fn(&Path) -> Result<T, String>,
    failures: &mut Vec<String>,
) -> Option<T> {
    let paths = BELOW.iter().flat_map(|below| NAMES.map(|name| folder.join(below).join(name)));
    let mut none = true;
    for path in paths.filter(|path| path.is_file()) {
        none = false;
        match open(&path) {
            Ok(found) => return Some(found),
            Err(reason) => failures.push(format!("{}: {reason}", path.display())),
        }
    }
    if none {
        failures.push(format!("{} does not hold it", folder.display()));
    }
    None
}
