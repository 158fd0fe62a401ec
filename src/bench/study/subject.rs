//! A scene under study.

use super::store::hash_debug;
use super::{Study, StudyError};
use embree::BuildQuality;
use readers::{LoadOptions, Severity};
use render::session::{OpenError, Opened, Session};
use std::path::{Path, PathBuf};
use world::view::View;

/// A scene, ready to be rendered.
pub struct Subject {
    /// Its name.
    pub name: String,
    /// Hash of all its content once loaded, generated geometry included.
    pub hash: u64,
    /// Number of triangles.
    pub triangles: usize,
    /// The scene, prepared for rendering.
    pub session: Session,
    /// View of the whole film by its still camera.
    pub view: View,
}

impl Subject {
    /// Views of a walk-through that ends at the view of the picture: the frames of the camera path that come after it,
    /// the last one first. `None` if the path does not hold so many, or not the picture's camera.
    pub fn walk(&self, frames: usize) -> Option<Vec<View>> {
        let path = &self.session.cameras.path;
        let first = path.iter().position(|camera| *camera == self.view.camera)?;
        let cameras = path.get(first..first + frames)?.iter().rev();
        Some(cameras.map(|camera| View { camera: *camera, ..self.view }).collect())
    }

    /// Builds its acceleration structure anew.
    pub(super) fn rebuild(&mut self, quality: BuildQuality) -> Result<(), StudyError> {
        let rebuilt = self.session.world.rebuild(quality);
        rebuilt.map_err(|source| OpenError::Build { path: PathBuf::from(&self.name), source }.into())
    }

    /// Loads a scene and prepares it.
    pub(super) fn load(path: &Path, study: &Study) -> Result<Subject, StudyError> {
        let Opened { mut session, warnings, .. } = Session::open(path, &LoadOptions::default())?;
        let warnings = warnings.iter().filter(|w| w.severity == Severity::Warning).count();
        if warnings > 0 {
            (study.say)(&format!(
                "{}: {warnings} things are not modelled; `info` lists them",
                path.display()
            ));
        }
        // The hash does not depend on the paths of its files.
        let sources = std::mem::take(&mut session.world.scene.sources);
        let hash = hash_debug(&(&session.world.scene, &session.cameras));
        session.world.scene.sources = sources;
        let triangles = session.world.scene.triangle_count();
        let view = View::whole(session.cameras.still, study.plan.resolution);
        Ok(Subject { name: session.world.scene.name.clone(), hash, triangles, session, view })
    }
}

/// Returns the file of a scene given by its path, or by the name of one in `folder`.
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
