//! List of cameras in TOML: a `[[camera]]` for each view, with the keys of a scene's camera.

use super::camera::{check_names, film, still};
use super::mistake;
use super::source::SourceText;
use super::text::{CameraText, FixedArray, Number, NumberArray};
use crate::draft::DraftView;
use crate::error::{Location, SceneError};
use crate::file::read_text;
use serde::Deserialize;
use std::path::Path;
use toml::{Spanned, Table, Value};

/// Keys of a list.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ListText {
    /// Film size of all cameras without one.
    resolution: Option<Spanned<FixedArray<u32, 2>>>,
    camera: Vec<Spanned<ViewText>>,
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
    let list: ListText = toml::from_str(&text).map_err(|error| mistake::of(file, &error))?;
    let shared = film(file, list.resolution.as_ref())?;
    Ok(list.camera.into_iter().map(|view| self::view(file, view, shared)).collect())
}

fn view(
    file: SourceText,
    text: Spanned<ViewText>,
    shared: Option<[u32; 2]>,
) -> Result<DraftView, SceneError> {
    let place = file.place(text.span());
    let text = text.into_inner();
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
    let camera = still(&camera, [origin, target], resolution.unwrap_or([1, 1]), &place)?;
    Ok(DraftView { name: text.name.unwrap_or_default(), is_path: false, camera, resolution })
}
