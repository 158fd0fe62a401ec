//! List of cameras in TOML: a `[[camera]]` for each view, with the keys of a scene's camera.

use super::camera::{check_names, film, still};
use super::mistake;
use super::source::SourceText;
use super::text::{CameraText, FixedArray, Number, NumberArray};
use crate::draft::DraftView;
use crate::error::{Location, SceneError};
use crate::file::read_text;
use serde::{Deserialize, Deserializer};
use std::path::Path;
use toml::{Spanned, Table, Value};

/// Keys of a list.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ListText<T> {
    /// Film size of all cameras without one.
    resolution: Option<Spanned<FixedArray<u32, 2>>>,
    camera: Vec<Spanned<T>>,
}

/// A value, or what is wrong with it.
struct Tried<T>(Result<T, String>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Tried<T> {
    fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Tried<T>, D::Error> {
        Ok(Tried(T::deserialize(source).map_err(|error| error.to_string().trim_end().to_owned())))
    }
}

/// Keys of a camera: name and film size, and the keys of a scene's camera but `path`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewText {
    name: Option<String>,
    resolution: Option<Spanned<FixedArray<u32, 2>>>,
    origin: Option<NumberArray<3>>,
    target: Option<NumberArray<3>>,
    up: Option<NumberArray<3>>,
    fov: Option<Number>,
    fov_axis: Option<Spanned<String>>,
    near: Option<f64>,
    far: Option<f64>,
    aperture_radius: Option<Number>,
    focus_distance: Option<Number>,
    film_width: Option<Number>,
    filter: Option<Spanned<String>>,
}

/// Reads the list at `path`.
pub fn read(path: &Path) -> Result<Vec<Result<DraftView, SceneError>>, SceneError> {
    let (text, _) = read_text(path, &Location::file(path))?;
    let file = SourceText { path, text: &text };
    let is_table = |table: Table| table.get("camera").is_some_and(Value::is_table);
    if text.parse().is_ok_and(is_table) {
        let what = "`camera` is a single table, as in a scene";
        return Err(Location::file(path).wrong(what, "write [[camera]] in double brackets for each view"));
    }
    let mistake = |error: toml::de::Error| mistake::error(file, &error);
    // Other cameras than the first wrong one are read, too. Their mistakes have the line of the camera alone.
    let mut first = toml::from_str::<ListText<ViewText>>(&text).err().map(mistake);
    let list: ListText<Tried<ViewText>> = toml::from_str(&text).map_err(mistake)?;
    let shared = film(file, list.resolution.as_ref())?;
    let mut view = |view: Spanned<Tried<ViewText>>| {
        let place = file.place(view.span());
        match view.into_inner().0 {
            Ok(text) => self::view(file, text, &place, shared),
            Err(what) => Err(first.take().unwrap_or_else(|| place.wrong(what, "correct the camera"))),
        }
    };
    Ok(list.camera.into_iter().map(&mut view).collect())
}

fn view(
    file: SourceText,
    text: ViewText,
    place: &Location,
    shared: Option<[u32; 2]>,
) -> Result<DraftView, SceneError> {
    let resolution = film(file, text.resolution.as_ref())?.or(shared);
    let by_height = text.fov_axis.as_ref().is_some_and(|axis| axis.get_ref() == "y");
    if by_height && resolution.is_none() {
        return Err(place.wrong("fov_axis is y, and the film has no size", "add `resolution` to the list"));
    }
    let camera = CameraText {
        origin: text.origin,
        target: text.target,
        up: text.up,
        fov: text.fov,
        fov_axis: text.fov_axis,
        near: text.near,
        far: text.far,
        aperture_radius: text.aperture_radius,
        focus_distance: text.focus_distance,
        film_width: text.film_width,
        filter: text.filter,
        path: None,
    };
    check_names(file, &camera)?;
    let (Some(origin), Some(target)) = (camera.origin, camera.target) else {
        return Err(place.wrong("a camera of a list has no origin or no target", "give both"));
    };
    // Only the aspect ratio of the film matters here, and only to a vertical field of view.
    let camera = still(&camera, [origin, target], resolution.unwrap_or([1, 1]), place)?;
    Ok(DraftView { name: text.name.unwrap_or_default(), is_path: false, camera, resolution })
}
