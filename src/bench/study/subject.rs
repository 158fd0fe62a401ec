//! Scenes under study.

use super::store::hash_debug;
use super::{Study, StudyError};
use readers::{LoadOptions, Severity};
use render::session::{Opened, Session};
use std::io;
use std::path::{Path, PathBuf};
use world::view::View;

/// A scene, ready to be rendered.
pub struct Subject {
    /// Name.
    pub name: String,
    /// Hash of all its content once loaded, including generated geometry.
    pub hash: u64,
    /// Number of triangles.
    pub triangles: usize,
    /// Value of the quantity that differs between the scenes of a question; 0 without such a quantity.
    pub value: f64,
    /// Processor seconds of loading the scene and building its acceleration structure, if measured.
    pub load: Option<f64>,
    /// The scene, prepared for rendering.
    pub session: Session,
    /// View of the whole film by its still camera.
    pub view: View,
}

impl Study<'_> {
    /// Loads a scene and prepares it.
    pub fn subject(&self, path: &Path) -> Result<Subject, StudyError> {
        let Opened { mut session, warnings, .. } = Session::open(path, &LoadOptions::default())?;
        let warnings = warnings.iter().filter(|w| w.severity == Severity::Warning).count();
        if warnings > 0 {
            let path = path.display();
            (self.say)(&format!("{path}: {warnings} things are not supported; `info` lists them"));
        }
        let scene = &mut session.world.scene;
        // The hash does not depend on the paths of the files.
        let sources = std::mem::take(&mut scene.sources);
        let hash = hash_debug(&(&*scene, &session.cameras));
        scene.sources = sources;
        let (name, triangles) = (scene.name.clone(), scene.seen_triangle_count());
        let view = View::whole(session.cameras.still, self.plan.resolution);
        Ok(Subject { name, hash, triangles, value: 0.0, load: None, session, view })
    }

    /// Writes meshes of a scene of the study's own, and returns its description.
    pub fn write_scene(&self, write: impl Fn(&Path) -> io::Result<String>) -> Result<String, StudyError> {
        let folder = &self.plan.folder;
        write(folder).map_err(|source| StudyError::write(folder, source))
    }

    /// Writes a scene of the study's own into its folder, and loads it.
    pub fn own_subject(&self, name: &str, text: &str) -> Result<Subject, StudyError> {
        let path = self.plan.folder.join(format!("{name}.toml"));
        std::fs::write(&path, text).map_err(|source| StudyError::write(&path, source))?;
        self.subject(&path)
    }
}

impl Subject {
    /// Returns the views of a walk-through that ends at the view of the image: the frames of the camera path after the
    /// image, in reverse. `None` if the path has too few frames or lacks the image's camera.
    pub fn walk(&self, frames: usize) -> Option<Vec<View>> {
        let path = &self.session.cameras.path;
        let first = path.iter().position(|camera| *camera == self.view.camera)?;
        let cameras = path.get(first..first + frames)?.iter().rev();
        Some(cameras.map(|camera| View { camera: *camera, ..self.view }).collect())
    }
}

/// Returns the file of a scene, which is a path or the name of a scene in `folder`.
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
