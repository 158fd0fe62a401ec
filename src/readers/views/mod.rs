//! Lists of cameras, each of which is a view of a scene: `transforms.json` of NeRF data sets, a list in TOML, the
//! cameras of a glTF model, and the sensors of a Mitsuba scene.
//!
//! Cameras are in the coordinates of the scene's file. A list is read without the scene. [`ViewList::in_scene`]
//! converts its cameras to the coordinates of a scene. A camera that is wrong is named and left out. The others keep
//! their numbers.

mod names;
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

/// Maximum number of warnings about cameras that are left out. A further one counts the others.
const MAX_LEFT_OUT: usize = 10;

/// A list of cameras.
#[derive(Clone, Debug)]
pub struct ViewList {
    path: PathBuf,
    /// Numbers of the cameras in the list, counted from 1, in rising order.
    numbers: Vec<usize>,
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
        let outcomes = match extension.as_str() {
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
        if outcomes.is_empty() {
            return Err(place.wrong("there is no camera", "add one, or name another file"));
        }
        if outcomes.len() > MAX_FRAMES {
            let what = format!("there are {} cameras", outcomes.len());
            return Err(place.wrong(what, format!("divide the list; {MAX_FRAMES} are the maximum")));
        }
        let (numbers, views) = sound(outcomes, &place, &mut log)?;
        let file_names = names::file_names(&numbers, &views, &place, &mut log);
        Ok(ViewList { path: path.to_owned(), numbers, views, file_names, warnings: log.into_warnings() })
    }

    /// Returns the numbers of the views in the list, counted from 1. Cameras that are left out have none.
    pub fn numbers(&self) -> &[usize] {
        &self.numbers
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
        fnv1a(format!("{:?} {:?} {:?}", self.numbers, self.views, self.file_names).as_bytes())
    }

    /// Returns the cameras in the coordinates of a scene.
    ///
    /// # Errors
    /// If the rays of a camera cannot be represented there. The error has the number of the view.
    pub fn in_scene(&self, scene: &Scene) -> Result<Vec<SceneView>, SceneError> {
        let (centre, exponent) = (scene.centre, scene.exponent);
        let coordinates = LocalCoordinates { centre, exponent, vicinity: 0.0 };
        let place = Location::file(&self.path);
        let local = |(number, view): (&usize, &DraftView)| {
            check_camera(&view.camera, &coordinates, &place).map_err(|error| numbered(*number, error))?;
            let camera: &DraftCamera = &view.camera;
            Ok(SceneView { camera: coordinates.local_camera(camera), resolution: view.resolution })
        };
        self.numbers.iter().zip(&self.views).map(local).collect()
    }
}

/// Returns the cameras that can be rendered, with their numbers. Warnings name the others.
///
/// # Errors
/// If there is none, and under `strict` if one is left out.
fn sound(
    outcomes: Vec<Result<DraftView, SceneError>>,
    place: &Location,
    log: &mut Log,
) -> Result<(Vec<usize>, Vec<DraftView>), SceneError> {
    let (mut numbers, mut views, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for (number, outcome) in (1..).zip(outcomes) {
        match outcome {
            Ok(view) => {
                numbers.push(number);
                views.push(view);
            }
            Err(strict @ SceneError::Strict(_)) => return Err(strict),
            Err(error) => failed.push((number, error)),
        }
    }
    if views.is_empty() {
        return Err(SceneError::all(failed.into_iter().map(|(_, error)| error).collect()));
    }
    let others = failed.split_off(failed.len().min(MAX_LEFT_OUT)).len();
    for (number, error) in failed {
        log.add(match numbered(number, error) {
            SceneError::Value { place, what, remedy } => {
                Warning::new(place, what, format!("it is left out; to render it, {remedy}"))
            }
            other => Warning::new(place.clone(), other.to_string(), "it is left out"),
        })?;
    }
    if others > 0 {
        log.warn(place, format!("{others} more cameras are wrong"), "they are left out")?;
    }
    Ok((numbers, views))
}

/// Returns an error that names the number of its camera.
fn numbered(number: usize, error: SceneError) -> SceneError {
    match error {
        SceneError::Value { place, what, remedy } if !what.starts_with("frame ") => {
            SceneError::Value { place, what: format!("camera {number}: {what}"), remedy }
        }
        other => other,
    }
}

#[cfg(test)]
mod tests;
