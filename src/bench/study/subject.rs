//! A scene that is studied.

use super::store::hash_debug;
use super::{Study, StudyError};
use crate::embree::BuildQuality;
use crate::scene::formats::{Level, LoadOptions, load};
use crate::view::View;
use crate::world::World;
use std::path::{Path, PathBuf};

/// A scene, ready to be rendered.
pub struct Subject {
    /// Its name.
    pub name: String,
    /// Hash of all that it holds once loaded, generated geometry included.
    pub hash: u64,
    /// Number of triangles.
    pub triangles: usize,
    /// The scene.
    pub world: World,
    /// The whole film of its still camera.
    pub view: View,
    path: PathBuf,
}

impl Subject {
    /// Builds its acceleration structure anew.
    pub(super) fn rebuild(&mut self, quality: BuildQuality) -> Result<(), StudyError> {
        self.world.rebuild(quality).map_err(|source| StudyError::Build { path: self.path.clone(), source })
    }

    /// Loads it.
    pub(super) fn load(path: &Path, study: &Study) -> Result<Subject, StudyError> {
        let loaded = load(path, &LoadOptions::default())?;
        let warnings = loaded.warnings.iter().filter(|w| w.level == Level::Warning).count();
        if warnings > 0 {
            (study.say)(&format!(
                "{}: {warnings} things are not modelled; `info` lists them",
                path.display()
            ));
        }
        let mut scene = loaded.scene;
        // Where its files lie does not matter.
        let sources = std::mem::take(&mut scene.sources);
        let hash = hash_debug(&(&scene, &loaded.cameras));
        scene.sources = sources;
        let triangles = scene.meshes.iter().map(|m| m.triangles.len()).sum();
        let world = World::new(scene, study.plan.threads)
            .map_err(|source| StudyError::Build { path: path.to_owned(), source })?;
        let view = View::whole(loaded.cameras.still, study.plan.resolution);
        Ok(Subject { name: world.scene.name.clone(), hash, triangles, world, view, path: path.to_owned() })
    }
}

/// The file of a scene that is given by its path, or by the name of one in `folder`.
pub fn file_of(scene: &Path, folder: &Path) -> PathBuf {
    let named = scene.extension().is_none() && scene.components().count() == 1;
    if named { folder.join(scene).with_extension("toml") } else { scene.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_names_lie_in_the_folder_of_scenes_and_paths_where_they_say() {
        let file = |scene: &str| file_of(Path::new(scene), Path::new("scenes"));
        assert_eq!(file("knot"), Path::new("scenes/knot.toml"));
        assert_eq!(file("knot.toml"), Path::new("knot.toml"));
        assert_eq!(file("../a/scene.xml"), Path::new("../a/scene.xml"));
    }
}
