//! Files that a command writes: checks of their names, of permissions, and that they replace no input.

use super::exit::Failure;
use anyhow::anyhow;
use base::film::atomic;
use render::session::Session;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// Check of a file that a command will write.
#[derive(Clone, Copy, Debug, Default)]
pub struct OutputCheck {
    /// True if an existing file may stay. Then [`check_unprotected`] must check later whether it is write-protected.
    pub may_stay: bool,
    /// True if nothing may change on the disk.
    pub is_dry: bool,
}

/// Checks the names of the files of an image, and that they can be written.
///
/// # Errors
/// If a name is wrong, a file cannot be written, or two files are the same.
pub fn check_outputs(exr: Option<&Path>, png: Option<&Path>, check: OutputCheck) -> Result<(), Failure> {
    if let Some(path) = exr {
        check_name(path, "exr", "--output", "for OpenEXR")?;
    }
    if let Some(path) = png {
        check_name(path, "png", "--png", "for PNG")?;
    }
    let paths = || exr.into_iter().chain(png);
    paths().try_for_each(|path| check_output(path, check))?;
    Inputs::default().check_apart(paths())
}

/// Checks that a file can be written. Its folder is made if it alone is missing.
///
/// # Errors
/// If the file cannot be written.
pub fn check_output(path: &Path, check: OutputCheck) -> Result<(), Failure> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    if let Some(folder) = path.parent().filter(is_missing) {
        if check.is_dry && atomic::check_place(folder).is_ok() {
            return Ok(());
        }
        if !check.is_dry {
            // If it cannot be made, the check of the file says so.
            let _ = fs::create_dir(folder);
        }
    }
    let check = if check.may_stay { atomic::check_place } else { atomic::check_writable };
    check(path).map_err(Failure::output)
}

/// Refuses files that exist.
pub fn check_new<'a>(files: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    match files.into_iter().find(|path| path.exists()) {
        Some(path) => Err(Failure::output(anyhow!(
            "{} exists, and --no-overwrite keeps it; name another file, or leave --no-overwrite out",
            path.display()
        ))),
        None => Ok(()),
    }
}

/// Refuses existing files that are write-protected.
pub fn check_unprotected<'a>(files: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    files.into_iter().try_for_each(|path| atomic::check_unprotected(path).map_err(Failure::output))
}

/// Checks the extension of a file that `option` names. `why` ends the message.
pub fn check_name(path: &Path, extension: &str, option: &str, why: &str) -> Result<(), Failure> {
    if path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        let path = path.display();
        return Err(Failure::usage(anyhow!(
            "{option} {path}: this is the name of a folder; give the name of a file, without / at its end"
        )));
    }
    let right = path.extension().and_then(OsStr::to_str).is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if right {
        return Ok(());
    }
    Err(Failure::usage(anyhow!(
        "{option} {}: the name of the file must end in .{extension} {why}",
        path.display()
    )))
}

/// Files that a command reads, with resolved links.
#[derive(Default)]
pub struct Inputs(BTreeSet<PathBuf>);

impl Inputs {
    /// Builds the set of the files at `paths`.
    pub fn new<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Inputs {
        Inputs(paths.into_iter().filter_map(|path| atomic::resolve(path.as_ref()).ok()).collect())
    }

    /// The files of a session's scene.
    pub fn of_session(session: &Session) -> Inputs {
        Inputs::new(&session.world.scene.sources)
    }

    /// Refuses an output that would replace an input or another output.
    pub fn check_apart<'a>(&self, outputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
        let mut written = BTreeSet::new();
        for path in outputs {
            let Ok(target) = atomic::resolve(path) else { continue };
            let refuse =
                |what: &str| Err(Failure::usage(anyhow!("{}: {what}; name another file", path.display())));
            if self.0.contains(&target) {
                return refuse("this file is an input and would be lost");
            }
            if !written.insert(target) {
                return refuse("two results would be written to this file");
            }
        }
        Ok(())
    }

    /// Refuses a PNG file if the PNG file of a layer, which is named after it, might replace an input.
    pub fn check_layers(&self, png: &Path) -> Result<(), Failure> {
        let Ok(target) = atomic::resolve(png) else { return Ok(()) };
        let stem = target.with_extension("");
        let is_layer = |input: &&PathBuf| {
            let layer = input.extension().is_some_and(|e| e == "png").then(|| input.with_extension(""));
            layer.is_some_and(|layer| layer != stem && layer.with_extension("") == stem)
        };
        match self.0.iter().find(is_layer) {
            Some(input) => Err(Failure::usage(anyhow!(
                "{}: the PNG file of a layer might replace the input {}; name another file",
                png.display(),
                input.display()
            ))),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::write;

    #[test]
    fn files_are_told_apart_by_what_they_are_and_not_by_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        write(at("scene.toml"), "").unwrap();
        let inputs = Inputs::new([at("scene.toml"), at("missing.png")]);
        let check = |names: &[&str]| {
            let paths: Vec<PathBuf> = names.iter().map(|name| at(name)).collect();
            inputs.check_apart(paths.iter().map(PathBuf::as_path)).map_err(|failure| failure.to_string())
        };
        check(&["a.exr", "a.png"]).unwrap();
        assert!(check(&["a.exr", "./scene.toml"]).unwrap_err().contains("would be lost"));
        assert!(check(&["a.exr", "./a.exr"]).unwrap_err().contains("two results"));
        write(at("wood.direct.png"), "").unwrap();
        let inputs_of_layers = Inputs::new([at("wood.direct.png")]);
        assert!(inputs_of_layers.check_layers(&at("wood.png")).is_err());
        inputs_of_layers.check_layers(&at("wo.png")).unwrap();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("scene.toml", at("link.exr")).unwrap();
            std::os::unix::fs::symlink("a.exr", at("dangling.png")).unwrap();
            assert!(check(&["link.exr"]).unwrap_err().contains("would be lost"));
            assert!(check(&["a.exr", "dangling.png"]).unwrap_err().contains("two results"));
        }
    }
}
