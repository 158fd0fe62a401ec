//! `transforms.json` of NeRF data sets: intrinsics in pixels or as a field of view, and a matrix per frame.
//!
//! Intrinsics of a frame replace the intrinsics of the file. Cameras look along -z with y up, as in OpenGL and Blender.
//! A scale of the matrix has no effect. Numbers may be texts, and Python's `NaN` and `Infinity` are read as texts.

use crate::draft::{DraftCamera, DraftView};
use crate::error::{Location, Log, SceneError};
use crate::file::read_text;
use crate::json_text;
use crate::statements::{self, Fate, fate, note};
use base::math::{right_of, unit};
use glam::DVec3;
use scene::MAX_SIDE;
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

/// Models of cameras whose image is a perspective one, apart from distortion.
const PERSPECTIVE: [&str; 7] =
    ["OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "FULL_OPENCV", "PERSPECTIVE"];

/// Relative deviation of a matrix from a scaled rotation that is named. Calibrations round their matrices.
const SKEW: f64 = 1e-2;

/// Reads the list at `path`.
pub fn read(path: &Path, log: &mut Log) -> Result<Vec<Result<DraftView, SceneError>>, SceneError> {
    let place = Location::file(path);
    let (text, _) = read_text(path, &place)?;
    let root = json_text::parse(python_numbers_quoted(&text).as_bytes()).map_err(|error| {
        let line = u32::try_from(error.line()).unwrap_or(u32::MAX);
        Location::line(path, line).malformed(error.to_string())
    })?;
    let shape = || place.wrong("there is no list `frames`", "name the transforms.json of a NeRF data set");
    let root = root.as_object().ok_or_else(shape)?;
    let frames = root.get("frames").and_then(Value::as_array).ok_or_else(shape)?;
    let mut reader = Reader { place: &place, root, named: BTreeSet::new(), skewed: Vec::new() };
    reader.name_unread(root, log)?;
    let mut view = |number: usize, frame: &Value| {
        let wrong =
            || place.wrong(format!("frame {number} is no table"), "write { \"transform_matrix\": ... }");
        let frame = frame.as_object().ok_or_else(wrong)?;
        reader.name_unread(frame, log)?;
        reader.view(number, frame)
    };
    let views = (1..).zip(frames).map(|(number, frame)| view(number, frame)).collect();
    if let Some((first, others)) = reader.skewed.split_first() {
        let more = if others.is_empty() { String::new() } else { format!(" and of {} more", others.len()) };
        let what = format!("the transform_matrix of {first}{more} shears, mirrors or scales unevenly");
        log.warn(&place, what, "the camera keeps its position and direction, and y is up")?;
    }
    Ok(views)
}

/// Returns JSON in which the numbers that Python writes beside the numbers of JSON are texts.
fn python_numbers_quoted(text: &str) -> Cow<'_, str> {
    const WORDS: [&str; 3] = ["-Infinity", "Infinity", "NaN"];
    if !WORDS.iter().any(|word| text.contains(word)) {
        return text.into();
    }
    let (mut quoted, mut rest, mut in_string) = (String::with_capacity(text.len()), text, false);
    while let Some(first) = rest.chars().next() {
        let word = WORDS.iter().find(|word| !in_string && rest.starts_with(**word));
        // A backslash keeps the character after it from ending the string.
        let taken = if in_string && first == '\\' { 2 } else { 1 };
        let length =
            word.map_or_else(|| rest.chars().take(taken).map(char::len_utf8).sum(), |word| word.len());
        let (piece, after) = rest.split_at(length);
        match word {
            Some(word) => quoted.extend(["\"", word, "\""]),
            None => quoted.push_str(piece),
        }
        in_string ^= first == '"';
        rest = after;
    }
    quoted.into()
}

/// Returns a number, which may be a text; `None` if it is none or not finite.
fn number(value: &Value) -> Option<f64> {
    let number = match value {
        Value::String(text) => text.trim().parse().ok(),
        value => value.as_f64(),
    };
    number.filter(|number: &f64| number.is_finite())
}

/// Returns a value as messages show it.
fn shown(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() > 40 { "no number".to_owned() } else { text.trim_matches('"').to_owned() }
}

struct Reader<'a> {
    place: &'a Location,
    root: &'a Map<String, Value>,
    /// Keys that a warning named.
    named: BTreeSet<String>,
    /// Frames whose matrix is no rotation.
    skewed: Vec<String>,
}

/// A frame, and its name in messages.
struct Frame<'a> {
    own: &'a Map<String, Value>,
    root: &'a Map<String, Value>,
    place: &'a Location,
    name: String,
}

impl Reader<'_> {
    /// Names keys whose values change the image and are not supported, each once. Zeros change nothing.
    fn name_unread(&mut self, table: &Map<String, Value>, log: &mut Log) -> Result<(), SceneError> {
        let keys = statements::table("Lists of cameras");
        for (key, value) in table {
            let is_nothing = match value {
                Value::Number(number) => number.as_f64() == Some(0.0),
                Value::Bool(is_so) => !is_so,
                Value::Null => true,
                Value::Array(values) => values.iter().all(|value| value.as_f64() == Some(0.0)),
                Value::String(_) | Value::Object(_) => false,
            };
            if is_nothing || fate(keys, key) != Fate::Named || !self.named.insert(key.clone()) {
                continue;
            }
            log.warn(self.place, format!("`{key}` is not supported"), note(keys, key))?;
        }
        let model = table.get("camera_model").and_then(Value::as_str);
        if let Some(model) = model.filter(|model| !PERSPECTIVE.contains(model))
            && self.named.insert(format!("camera_model {model}"))
        {
            let what = format!("the camera_model \"{model}\" is not supported");
            log.warn(self.place, what, "the image is a perspective one")?;
        }
        Ok(())
    }

    fn view(&mut self, number: usize, own: &Map<String, Value>) -> Result<DraftView, SceneError> {
        let file = match own.get("file_path") {
            None | Some(Value::Null) => "",
            Some(Value::String(file)) => file,
            Some(_) => {
                let what = format!("frame {number}: file_path is no text");
                return Err(self.place.wrong(what, "write the name of the image"));
            }
        };
        let name =
            if file.is_empty() { format!("frame {number}") } else { format!("frame {number} (\"{file}\")") };
        let frame = Frame { own, root: self.root, place: self.place, name };
        let (placed, is_rotation) = frame.placed()?;
        if !is_rotation {
            self.skewed.push(frame.name.clone());
        }
        let resolution = frame.resolution()?;
        let camera = frame.with_lens(placed, resolution)?;
        Ok(DraftView { name: file.to_owned(), is_path: true, camera, resolution })
    }
}

impl Frame<'_> {
    fn wrong(&self, what: impl AsRef<str>, remedy: &str) -> SceneError {
        self.place.wrong(format!("{}: {}", self.name, what.as_ref()), remedy)
    }

    /// Returns a number of a table; `None` if it has none.
    fn number_in(&self, table: &Map<String, Value>, key: &str) -> Result<Option<f64>, SceneError> {
        let value = match table.get(key) {
            None | Some(Value::Null) => return Ok(None),
            Some(value) => value,
        };
        number(value)
            .map(Some)
            .ok_or_else(|| self.wrong(format!("{key} is {}", shown(value)), "write a number"))
    }

    /// Returns a number of the frame, or else of the file.
    fn number(&self, key: &str) -> Result<Option<f64>, SceneError> {
        match self.number_in(self.own, key)? {
            None => self.number_in(self.root, key),
            own => Ok(own),
        }
    }

    fn resolution(&self) -> Result<Option<[u32; 2]>, SceneError> {
        let side = |key: &str| -> Result<Option<u32>, SceneError> {
            let Some(number) = self.number(key)? else { return Ok(None) };
            let is_whole = number.fract() == 0.0 && (1.0..=f64::from(MAX_SIDE)).contains(&number);
            let remedy = format!("write a whole number from 1 to {MAX_SIDE}");
            is_whole
                .then_some(Some(number as u32))
                .ok_or_else(|| self.wrong(format!("{key} is {number}"), &remedy))
        };
        match (side("w")?, side("h")?) {
            (Some(width), Some(height)) => Ok(Some([width, height])),
            (None, None) => Ok(None),
            _ => Err(self.wrong("there is only one of w and h", "write both, or leave both out")),
        }
    }

    /// Returns the camera with the lens that the intrinsics describe.
    fn with_lens(&self, placed: DraftCamera, film: Option<[u32; 2]>) -> Result<DraftCamera, SceneError> {
        const FOCAL: [&str; 4] = ["fl_x", "fl_y", "camera_angle_x", "camera_angle_y"];
        let is_own = FOCAL.iter().any(|key| self.own.get(*key).is_some_and(|value| !value.is_null()));
        let table = if is_own { self.own } else { self.root };
        let positive = |key: &str| -> Result<Option<f64>, SceneError> {
            let number = self.number_in(table, key)?;
            match number {
                Some(number) if number <= 0.0 => {
                    Err(self.wrong(format!("{key} is {number}"), "write a number above 0"))
                }
                number => Ok(number),
            }
        };
        let tangent = |key: &str| -> Result<Option<f64>, SceneError> {
            let Some(angle) = positive(key)? else { return Ok(None) };
            let remedy = "write an angle in radians, below 3.14";
            let tangent = (angle < std::f64::consts::PI).then(|| (0.5 * angle).tan());
            tangent.map(Some).ok_or_else(|| self.wrong(format!("{key} is {angle}"), remedy))
        };
        let [fl_x, fl_y] = [positive("fl_x")?, positive("fl_y")?];
        let [tan_x, tan_y] = [tangent("camera_angle_x")?, tangent("camera_angle_y")?];
        let Some([width, height]) = film.map(|film| film.map(f64::from)) else {
            if let (None, None, Some(tan_half_x), [None, None]) =
                (fl_x, fl_y, tan_x, [self.number("cx")?, self.number("cy")?])
            {
                return Ok(DraftCamera { tan_half_x, ..placed });
            }
            let what = "without w and h, there must be camera_angle_x, and no other intrinsics";
            return Err(self.wrong(what, "add w and h, the size of the image in pixels"));
        };
        let from_angle = |side: f64, tangent: Option<f64>| tangent.map(|tangent| 0.5 * side / tangent);
        let x = fl_x.or(from_angle(width, tan_x));
        let y = fl_y.or(if fl_x.is_some() { None } else { from_angle(height, tan_y) });
        let [x, y] = match [x, y] {
            [None, None] => {
                return Err(self
                    .wrong("there is no focal length", "add fl_x in pixels, or camera_angle_x in radians"));
            }
            [x, y] => [x.or(y).unwrap_or(1.0), y.or(x).unwrap_or(1.0)],
        };
        let [cx, cy] =
            [self.number("cx")?.unwrap_or(0.5 * width), self.number("cy")?.unwrap_or(0.5 * height)];
        let shift = [(0.5 * width - cx) / x, (cy - 0.5 * height) / y];
        Ok(DraftCamera { tan_half_x: 0.5 * width / x, shift, pixel_height: x / y, ..placed })
    }

    /// Returns the camera in its place, and whether the matrix is a rotation with a scale and a translation.
    fn placed(&self) -> Result<(DraftCamera, bool), SceneError> {
        let rows = self.own.get("transform_matrix").and_then(Value::as_array);
        let remedy = "write four rows of four numbers, the last row 0, 0, 0, 1";
        let wrong = || self.wrong("there is no valid transform_matrix", remedy);
        let rows = rows.ok_or_else(wrong)?;
        let mut entries = rows.iter().filter_map(Value::as_array).flatten();
        if let Some(bad) = entries.find(|entry| number(entry).is_none()) {
            return Err(self.wrong(format!("the transform_matrix holds {}", shown(bad)), "write numbers"));
        }
        let row = |row: &Value| -> Option<[f64; 4]> {
            let numbers: Option<Vec<f64>> = row.as_array()?.iter().map(number).collect();
            numbers?.try_into().ok()
        };
        let rows: Option<Vec<[f64; 4]>> = rows.iter().map(row).collect();
        let is_one = |w: f64| (w - 1.0).abs() < 1e-6;
        let [x, y, z] = match rows.ok_or_else(wrong)?[..] {
            [x, y, z] => [x, y, z],
            [x, y, z, [0.0, 0.0, 0.0, w]] if is_one(w) => [x, y, z],
            [[.., 0.0], [.., 0.0], [.., 0.0], [.., w]] if is_one(w) => {
                let what = "the transform_matrix has its translation in the last row";
                return Err(self.wrong(what, "transpose it: the translation belongs to the last column"));
            }
            _ => return Err(wrong()),
        };
        let axes: [DVec3; 4] = std::array::from_fn(|i| DVec3::new(x[i], y[i], z[i]));
        let forward = unit(-axes[2]);
        let right = forward.and_then(|forward| right_of(forward, axes[1]));
        let (Some(forward), Some(right)) = (forward, right) else {
            let what = "the camera of transform_matrix looks nowhere, or along its y axis";
            return Err(
                self.wrong(what, "correct the matrix: its first three columns are x, y and -z of the image")
            );
        };
        let up = right.cross(forward);
        let scale = axes[2].length();
        let is_near = |(unit, axis): (&DVec3, &DVec3)| (*axis - *unit * scale).length() < SKEW * scale;
        let is_rotation = [right, up, -forward].iter().zip(&axes).all(is_near);
        Ok((DraftCamera { origin: axes[3], forward, right, up, ..DraftCamera::default() }, is_rotation))
    }
}
