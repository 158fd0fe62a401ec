//! Files of lightsplat's own scenes as part of the program: descriptions, and the meshes that they name.

/// Names of the scenes, each that of its TOML file.
pub const NAMES: [&str; 10] =
    ["apartment", "cornell", "furnace", "glass", "hall", "kitchen", "knot", "nave", "plaza", "terrace"];

macro_rules! files {
    ($($path:literal)*) => {
        /// Files by their paths below the folder of the scenes.
        static FILES: &[(&str, &[u8])] = &[$(($path, include_bytes!(concat!("../../", $path)))),*];
    };
}

files! {
    "apartment.toml"
    "cornell.toml"
    "cornell/green.obj"
    "cornell/lamp.obj"
    "cornell/red.obj"
    "cornell/room.obj"
    "cornell/short_block.obj"
    "cornell/tall_block.obj"
    "furnace.toml"
    "glass.toml"
    "hall.toml"
    "kitchen.toml"
    "knot.toml"
    "nave.toml"
    "plaza.toml"
    "terrace.toml"
}

/// Returns the bytes of a file, by its path below the folder of the scenes.
pub fn file(path: &str) -> Option<&'static [u8]> {
    FILES.iter().find(|(known, _)| *known == path).map(|(_, bytes)| *bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    #[test]
    fn every_scene_of_the_folder_is_part_of_the_program() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut found: Vec<String> = fs::read_dir(&folder)
            .unwrap()
            .filter_map(|entry| {
                let path = entry.unwrap().path();
                let is_scene = path.extension().is_some_and(|extension| extension == "toml");
                is_scene.then(|| path.file_stem().unwrap().to_string_lossy().into_owned())
            })
            .collect();
        found.sort();
        assert_eq!(found, NAMES);
        for (path, bytes) in FILES {
            assert!(fs::read(folder.join(path)).unwrap() == *bytes, "{path}");
        }
    }
}
