//! The container: JSON and binary chunk of a `.gltf` or `.glb` file.

use super::json;
use super::statements::{self, Unread};
use super::transform::Local;
use crate::error::{Location, SceneError};
use crate::json_text;
use gltf_json::Root;
use serde_json::Value;

/// Remedy for files of glTF 1.0.
const CONVERT: &str = "convert it to glTF 2.0";

/// Parts of a file.
pub(super) struct Container<'a> {
    pub json: &'a [u8],
    pub binary: Option<&'a [u8]>,
    /// True if all of the file is JSON.
    is_text: bool,
}

impl<'a> Container<'a> {
    /// Divides a file into its parts.
    pub fn parse(bytes: &'a [u8], place: &Location) -> Result<Container<'a>, SceneError> {
        match bytes.starts_with(b"glTF") {
            true => chunks(bytes, place),
            false => Ok(Container { json: bytes, binary: None, is_text: true }),
        }
    }

    /// Parses the JSON of glTF 2.0.
    pub fn description(&self, place: &Location) -> Result<Description, SceneError> {
        let located = |error: serde_json::Error| {
            let place = match self.is_text && error.line() > 0 {
                true => Location::line(&place.path, error.line() as u32),
                false => place.clone(),
            };
            place.malformed(error.to_string())
        };
        let mut value = match json_text::parse(self.json) {
            Err(error) if error.is_data() => return Err(located(error)),
            // Text that nests too deeply for this is read without repairs.
            parsed => parsed.unwrap_or_default(),
        };
        let is_old = is_old(&value);
        let is_repaired = json::repair(&mut value);
        let unread = statements::unread(&value);
        let is_repaired = json::drop_pointers(&mut value) || is_repaired;
        let nodes = match is_repaired {
            true => value.get("nodes").cloned(),
            false => value.get_mut("nodes").map(Value::take),
        };
        let nodes = nodes.unwrap_or_default();
        let parsed = match is_repaired {
            true => serde_json::from_value(value),
            false => serde_json::from_slice(self.json),
        };
        let root: Root = parsed.map_err(|error| match is_old {
            true => place.wrong("this is a file of glTF 1.0", CONVERT),
            false => located(error),
        })?;
        check_version(&root, place)?;
        let local = |(i, node)| Local::read(node, nodes.get(i).unwrap_or(&Value::Null));
        let locals = root.nodes.iter().enumerate().map(local).collect();
        Ok(Description { root, locals, unread })
    }
}

/// Content of a file's JSON.
pub(super) struct Description {
    pub root: Root,
    /// Transforms of the nodes at rest.
    pub locals: Vec<Local>,
    pub unread: Unread,
}

fn check_version(root: &Root, place: &Location) -> Result<(), SceneError> {
    let needed = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    let version = needed.split_once('.').and_then(|(major, minor)| {
        let [major, minor] = [major, minor].map(|part| part.parse::<u32>().ok());
        Some((major?, minor?))
    });
    match version {
        Some((2, minor)) if minor == 0 || root.asset.min_version.is_none() => Ok(()),
        Some((0 | 1, _)) => Err(place.wrong(format!("this is a file of glTF {needed}"), CONVERT)),
        _ => Err(place.wrong(format!("the file asks for glTF {needed}"), "export it as glTF 2.0")),
    }
}

/// Returns the JSON of a GLB file and its binary chunk. Chunks of other kinds are skipped, as the specification asks.
fn chunks<'a>(bytes: &'a [u8], place: &Location) -> Result<Container<'a>, SceneError> {
    let cut = || SceneError::mesh(place.clone(), "the file ends within a header");
    let word = |at: usize| {
        let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
        four.map(u32::from_le_bytes).ok_or_else(cut)
    };
    let version = word(4)?;
    if version != 2 {
        return Err(place.wrong(format!("it is binary glTF of version {version}, not 2"), CONVERT));
    }
    let chunk = |at: usize| {
        let (length, kind) = (word(at)? as usize, word(at + 4)?.to_le_bytes());
        let content = bytes.get(at + 8..).and_then(|rest| rest.get(..length));
        let content =
            content.ok_or_else(|| SceneError::mesh(place.clone(), "the file ends within a chunk"))?;
        Ok::<_, SceneError>((content, kind, at + 8 + length.next_multiple_of(4)))
    };
    let (json, kind, mut next) = chunk(12)?;
    if kind != *b"JSON" {
        return Err(SceneError::mesh(place.clone(), "the first chunk is not JSON"));
    }
    let mut binary = None;
    while binary.is_none() && next + 8 <= bytes.len() {
        let (content, kind, after) = chunk(next)?;
        binary = Some(content).filter(|_| kind == *b"BIN\0");
        next = after;
    }
    // Some exporters pad the text with zeros instead of spaces.
    let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    Ok(Container { json: &json[..end], binary, is_text: false })
}

/// True if JSON is that of glTF 1.0, whose lists are objects.
fn is_old(value: &Value) -> bool {
    let version = value.pointer("/asset/version");
    let is_old = match version {
        Some(Value::String(version)) => version.starts_with("1.") || version == "1",
        Some(Value::Number(version)) => version.as_f64().is_some_and(|version| version < 2.0),
        _ => false,
    };
    is_old || version.is_none() && ["meshes", "nodes", "buffers"].iter().any(|key| value[*key].is_object())
}
