//! Lists of cameras, each of which is a view of a scene: `transforms.json` of NeRF data sets, a list in TOML, the
//! cameras of a glTF model, and the sensors of a Mitsuba scene.
//!
//! Cameras are in the coordinates of the scene's file. A list is read without the scene. [`ViewList::in_scene`]
//! converts its cameras to the coordinates of a scene.

mod names;
mod statements;
mod transforms;

use crate::draft::{DraftCamera, DraftView};
use crate::error::{Location, Log, SceneError, Warning};
use crate::file::fnv1a;
use crate::finish::sanitize::check_camera;
use crate::local::LocalCoordinates;
use crate::options::LoadOptions;
use crate::{gltf, mitsuba, native};
use scene::{Camera, MAX_FRAMES, Scene};
use std::path::{Path, PathBuf};

/// A list of cameras.
#[derive(Clone, Debug)]
pub struct ViewList {
    path: PathBuf,
    views: Vec<DraftView>,
    file_names: Vec<PathBuf>,
    warnings: Vec<Warning>,
}

/// A camera of a list, in the coordinates of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneView {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the film in pixels; `None` for the size of the scene's film.
    pub resolution: Option<[u32; 2]>,
}

impl ViewList {
    /// Reads the list at `path`. Of the `options` of its scene, `strict` and, for a Mitsuba scene, `parameters` count.
    ///
    /// # Errors
    /// If the file cannot be read, is invalid, or has no camera.
    pub fn read(path: &Path, options: &LoadOptions) -> Result<ViewList, SceneError> {
        let place = Location::file(path);
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let mut log = Log::new(options.strict);
        let views = match extension.as_str() {
            "json" => transforms::read(path, &mut log)?,
            "toml" => native::read_views(path)?,
            "glb" | "gltf" => gltf::read_views(path)?,
            "xml" => mitsuba::read_views(path, &options.parameters, &mut log)?,
            _ => {
                let what = "this is no list of cameras";
                let remedy = "name the transforms.json of a NeRF data set, a .toml list, a .glb or .gltf model, or a \
                              Mitsuba scene (.xml)";
                return Err(place.wrong(what, remedy));
            }
        };
        if views.is_empty() {
            return Err(place.wrong("there is no camera", "add one, or name another file"));
        }
        if views.len() > MAX_FRAMES {
            let what = format!("there are {} cameras", views.len());
            return Err(place.wrong(what, format!("divide the list; {MAX_FRAMES} are the maximum")));
        }
        let file_names = names::file_names(&views, &place, &mut log);
        Ok(ViewList { path: path.to_owned(), views, file_names, warnings: log.into_warnings() })
    }

    /// Returns the file of the list.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the name of the image of each view: a relative path inside of any folder, without extension. No two
    /// views have one name.
    pub fn file_names(&self) -> &[PathBuf] {
        &self.file_names
    }

    /// Returns the warnings about what is not supported.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Returns a hash over names, cameras and films of all views.
    pub fn hash(&self) -> u64 {
        fnv1a(format!("{:?} {:?}", self.views, self.file_names).as_bytes())
    }

    /// Returns the cameras in the coordinates of a scene.
    ///
    /// # Errors
    /// If the rays of a camera cannot be represented there.
    pub fn in_scene(&self, scene: &Scene) -> Result<Vec<SceneView>, SceneError> {
        let (centre, exponent) = (scene.centre, scene.exponent);
        let coordinates = LocalCoordinates { centre, exponent, vicinity: 0.0 };
        let place = Location::file(&self.path);
        let local = |view: &DraftView| {
            check_camera(&view.camera, &coordinates, &place)?;
            let camera: &DraftCamera = &view.camera;
            Ok(SceneView { camera: coordinates.local_camera(camera), resolution: view.resolution })
        };
        self.views.iter().map(local).collect()
    }
}

#[cfg(test)]
mod tests;
