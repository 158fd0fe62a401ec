//! Built-in scenes. A name without folder and extension, which no file has, means one of them.

use std::path::{Path, PathBuf};

/// Folder of the files of built-in scenes in messages and references. Names of real files hold no angle brackets.
const FOLDER: &str = "<built-in>";

/// Returns true if `path` is the name of a built-in scene.
pub fn is_built_in(path: &Path) -> bool {
    lightsplat_scenes::NAMES.iter().any(|name| path.as_os_str() == *name)
}

/// Lists the names of the built-in scenes.
pub fn names() -> String {
    lightsplat_scenes::NAMES.join(", ")
}

/// Returns the path of the description of the built-in scene that `path` means, unless a file has this name.
pub(crate) fn resolve(path: &Path) -> Option<PathBuf> {
    (is_built_in(path) && !path.is_file()).then(|| Path::new(FOLDER).join(path).with_extension("toml"))
}

/// Returns the content of a file of a built-in scene.
pub(crate) fn bytes(path: &Path) -> Option<&'static [u8]> {
    lightsplat_scenes::file(path.strip_prefix(FOLDER).ok()?.to_str()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadOptions, load};

    #[test]
    fn built_in_scenes_equal_their_files() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        for name in ["cornell", "knot"] {
            let built_in = load(Path::new(name), &LoadOptions::default()).unwrap();
            let file = load(&folder.join(name).with_extension("toml"), &LoadOptions::default()).unwrap();
            assert_eq!(built_in.hash, file.hash);
            assert_eq!(built_in.scene.meshes.len(), file.scene.meshes.len());
            assert_eq!(built_in.scene.sources.len(), file.scene.sources.len());
            assert!(built_in.warnings.is_empty() && built_in.scene.name == name);
        }
    }

    #[test]
    fn names_without_a_scene_are_errors_that_list_the_scenes() {
        for name in ["kitchens", "scenes/kitchen"] {
            let error = load(Path::new(name), &LoadOptions::default()).unwrap_err().to_string();
            assert!(error.contains("apartment, cornell, furnace"), "{error}");
        }
    }
}
