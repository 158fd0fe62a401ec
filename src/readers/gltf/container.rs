//! The container: JSON and binary chunk of a `.gltf` or `.glb` file.

use crate::error::{Location, SceneError};
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
    pub fn of(bytes: &'a [u8], place: &Location) -> Result<Container<'a>, SceneError> {
        let container = match bytes.starts_with(b"glTF") {
            true => chunks(bytes, place)?,
            false => Container { json: bytes, binary: None, is_text: true },
        };
        for (mark, encoding) in
            [(&b"\xEF\xBB\xBF"[..], "UTF-8"), (b"\xFE\xFF", "UTF-16"), (b"\xFF\xFE", "UTF-16")]
        {
            if container.json.starts_with(mark) {
                let what = format!("the JSON begins with a byte order mark of {encoding}");
                return Err(place.wrong(what, "save it as UTF-8 without a byte order mark"));
            }
        }
        Ok(container)
    }

    /// Parses the JSON of glTF 2.0.
    pub fn root(&self, place: &Location) -> Result<Root, SceneError> {
        let parsed =
            serde_json::from_slice(self.json).or_else(|error| without_pointers(self.json).ok_or(error));
        let root: Root = parsed.map_err(|error| {
            if is_old(self.json) {
                return place.wrong("this is a file of glTF 1.0", CONVERT);
            }
            let place = match self.is_text {
                true => Location::line(&place.path, error.line() as u32),
                false => place.clone(),
            };
            place.malformed(error.to_string())
        })?;
        let needed = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
        let version = needed.split_once('.').and_then(|(major, minor)| {
            let [major, minor] = [major, minor].map(|part| part.parse::<u32>().ok());
            Some((major?, minor?))
        });
        match version {
            Some((2, minor)) if minor == 0 || root.asset.min_version.is_none() => Ok(root),
            Some((0 | 1, _)) => Err(place.wrong(format!("this is a file of glTF {needed}"), CONVERT)),
            _ => Err(place.wrong(format!("the file asks for glTF {needed}"), "export it as glTF 2.0")),
        }
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

/// Parses JSON after the channels of animations that move no node are taken out; `None` if there are none.
fn without_pointers(json: &[u8]) -> Option<Root> {
    let mut value: Value = serde_json::from_slice(json).ok()?;
    for animation in value.get_mut("animations")?.as_array_mut()? {
        let channels = animation.get_mut("channels")?.as_array_mut()?;
        channels.retain(|channel| channel.pointer("/target/node").is_some());
    }
    serde_json::from_slice(&serde_json::to_vec(&value).ok()?).ok()
}

/// True if JSON is that of glTF 1.0, whose lists are objects.
fn is_old(json: &[u8]) -> bool {
    let Ok(value) = serde_json::from_slice::<Value>(json) else { return false };
    let version = value.pointer("/asset/version");
    let is_old = match version {
        Some(Value::String(version)) => version.starts_with("1.") || version == "1",
        Some(Value::Number(version)) => version.as_f64().is_some_and(|version| version < 2.0),
        _ => false,
    };
    is_old || version.is_none() && ["meshes", "nodes", "buffers"].iter().any(|key| value[*key].is_object())
}
