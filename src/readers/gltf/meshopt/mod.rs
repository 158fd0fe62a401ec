//! Decompression of buffer views: the extensions `EXT_meshopt_compression` and `KHR_meshopt_compression`.
//!
//! Source: appendices A (bit stream) and B (filters) of the specification of `KHR_meshopt_compression`, Khronos Group.
//! Attributes are read in versions 0 and 1.

mod attributes;
mod filters;
mod indices;
mod reader;

use crate::budget::lacking;
use gltf_json::Root;
use gltf_json::buffer::View;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Names of the extension.
const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Statements of the extension about a buffer view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct MeshoptView {
    /// Index of the buffer with the compressed bytes.
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: usize,
    count: usize,
    mode: String,
    #[serde(default)]
    filter: Option<String>,
}

impl MeshoptView {
    /// Returns the statements about a view; `None` for a view that is not compressed.
    fn parse(view: &View) -> Option<Result<MeshoptView, String>> {
        let others = &view.extensions.as_ref()?.others;
        let value = NAMES.iter().find_map(|name| others.get(*name))?;
        Some(serde_json::from_value(value.clone()).map_err(|error| error.to_string()))
    }

    /// Returns the elements in compressed `bytes`, or what is wrong.
    fn decode(&self, bytes: &[u8]) -> Result<Vec<u8>, &'static str> {
        let MeshoptView { byte_stride: stride, count, .. } = *self;
        let filter = self.filter.as_deref().unwrap_or("NONE");
        match (self.mode.as_str(), stride) {
            ("ATTRIBUTES", 4..=256) if stride % 4 == 0 => {
                let mut elements = attributes::decode(bytes, count, stride)?;
                filters::apply(filter, &mut elements, stride)?;
                Ok(elements)
            }
            ("TRIANGLES", 2 | 4) if filter == "NONE" => indices::triangles(bytes, count, stride),
            ("INDICES", 2 | 4) if filter == "NONE" => indices::sequence(bytes, count, stride),
            ("ATTRIBUTES" | "TRIANGLES" | "INDICES", _) => {
                Err("has a stride or a filter that its mode excludes")
            }
            _ => Err("is of an unknown mode"),
        }
    }
}

/// Returns the bytes of all compressed buffer views by their indices, or what is wrong.
pub(super) fn views(root: &Root, buffers: &[Vec<u8>]) -> Result<BTreeMap<usize, Vec<u8>>, String> {
    let mut views = BTreeMap::new();
    for (i, view) in root.buffer_views.iter().enumerate() {
        let Some(compression) = MeshoptView::parse(view) else { continue };
        let wrong = |problem: &str| format!("buffer view {i} {problem}");
        let compression =
            compression.map_err(|error| wrong(&format!("is compressed in an unknown way: {error}")))?;
        if let Some(lack) = lacking((compression.count as u64).saturating_mul(compression.byte_stride as u64))
        {
            return Err(wrong(&format!("takes {lack}")));
        }
        let end = compression.byte_offset.checked_add(compression.byte_length);
        let buffer = buffers.get(compression.buffer);
        let bytes = buffer.zip(end).and_then(|(buffer, end)| buffer.get(compression.byte_offset..end));
        let bytes = bytes.ok_or_else(|| wrong("reaches beyond its buffer"))?;
        views.insert(i, compression.decode(bytes).map_err(wrong)?);
    }
    Ok(views)
}

/// True if a buffer merely stands for the bytes of compressed views, so that nothing reads it.
pub(super) fn is_placeholder(root: &Root, buffer: usize) -> bool {
    let compressions = || root.buffer_views.iter().filter_map(MeshoptView::parse);
    let mut views = root.buffer_views.iter().filter(|view| view.buffer.value() == buffer).peekable();
    views.peek().is_some()
        && views.all(|view| MeshoptView::parse(view).is_some())
        && !compressions()
            .any(|compression| compression.is_ok_and(|compression| compression.buffer == buffer))
}

#[cfg(test)]
mod tests;
