//! A file with its buffers, and the look-up of its objects.

use super::container::{Container, Description};
use super::draco;
use super::meshopt;
use super::statements;
use super::transform::Local;
use super::uri::{self, Resolved};
use crate::error::{Location, SceneError};
use crate::file::{fnv1a, folder_of, read_file};
use gltf_json::accessor::Accessor;
use gltf_json::{Index, Root, buffer, root::Get};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Extensions that are read, at least in part.
const KNOWN: [&str; 17] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_texture_transform",
];

/// A file with its buffers.
pub(super) struct GltfFile {
    pub root: Root,
    /// Transforms of the nodes at rest.
    pub locals: Vec<Local>,
    /// Location of the file, for messages.
    pub place: Location,
    /// Folder to which file names are relative.
    pub folder: PathBuf,
    /// Files read, with the hash of the bytes of each.
    pub sources: Vec<(PathBuf, u64)>,
    /// Statements that are not read.
    pub unread: statements::Unread,
    buffers: Vec<Vec<u8>>,
    /// Bytes of compressed buffer views, by index.
    views: BTreeMap<usize, Vec<u8>>,
    /// Bytes of accessors of compressed primitives, by index.
    accessors: BTreeMap<usize, Vec<u8>>,
}

impl GltfFile {
    /// Reads the file, to which `from` refers, and its buffers.
    pub fn open(path: &Path, from: &Location) -> Result<GltfFile, SceneError> {
        let bytes = read_file(path, from)?;
        let container = Container::parse(&bytes, &Location::file(path))?;
        let mut document = GltfFile::described(path, &bytes, &container)?;
        for i in 0..document.root.buffers.len() {
            let buffer = document.buffer(i, container.binary)?;
            document.buffers.push(buffer);
        }
        let views = meshopt::views(&document.root, &document.buffers);
        document.views = views.map_err(|what| document.wrong(what))?;
        let accessors = draco::accessors(&document.root, |view| document.view(view).ok());
        document.accessors = accessors.map_err(|what| document.wrong(what))?;
        Ok(document)
    }

    /// Reads the description in the file, to which `from` refers, without its buffers.
    pub fn without_buffers(path: &Path, from: &Location) -> Result<GltfFile, SceneError> {
        let bytes = read_file(path, from)?;
        let container = Container::parse(&bytes, &Location::file(path))?;
        GltfFile::described(path, &bytes, &container)
    }

    /// Returns the description in the bytes of a file, without its buffers.
    fn described(path: &Path, bytes: &[u8], container: &Container) -> Result<GltfFile, SceneError> {
        let place = Location::file(path);
        let Description { root, locals, unread } = container.description(&place)?;
        check_extensions(&root, &place)?;
        Ok(GltfFile {
            root,
            locals,
            folder: folder_of(path).to_owned(),
            sources: vec![(path.to_owned(), fnv1a(bytes))],
            unread,
            buffers: Vec::new(),
            views: BTreeMap::new(),
            accessors: BTreeMap::new(),
            place,
        })
    }

    /// Returns the object of an index.
    pub fn get<T>(&self, index: Index<T>, what: &str) -> Result<&T, SceneError>
    where
        Root: Get<T>,
    {
        let missing = || self.wrong(format!("{what} {} does not exist", index.value()));
        self.root.get(index).ok_or_else(missing)
    }

    /// Returns the bytes of a view of a buffer.
    pub fn view(&self, index: Index<buffer::View>) -> Result<&[u8], SceneError> {
        if let Some(bytes) = self.views.get(&index.value()) {
            return Ok(bytes);
        }
        let view = self.get(index, "buffer view")?;
        let buffer = self.buffers.get(view.buffer.value()).map_or(&[][..], Vec::as_slice);
        let start = view.byte_offset.unwrap_or_default().0 as usize;
        let end = start.checked_add(view.byte_length.0 as usize);
        let bytes = end.and_then(|end| buffer.get(start..end));
        bytes.ok_or_else(|| self.wrong(format!("buffer view {} reaches beyond its buffer", index.value())))
    }

    /// Returns the bytes of an accessor's elements, without gaps, if they come from a compressed primitive.
    pub fn decoded(&self, index: Index<Accessor>) -> Option<&[u8]> {
        self.accessors.get(&index.value()).map(Vec::as_slice)
    }

    /// Returns the bytes in a data URI, or the path of the file that a URI names.
    pub fn resolve(&self, uri: &str) -> Result<Resolved, SceneError> {
        uri::resolve(uri, &self.folder).ok_or_else(|| self.wrong("a data URI is not in base64".into()))
    }

    /// Returns the error of damaged content.
    pub fn wrong(&self, what: String) -> SceneError {
        SceneError::mesh(self.place.clone(), what)
    }

    fn buffer(&mut self, i: usize, binary: Option<&[u8]>) -> Result<Vec<u8>, SceneError> {
        if meshopt::is_placeholder(&self.root, i) {
            return Ok(Vec::new());
        }
        let buffer = &self.root.buffers[i];
        let length = buffer.byte_length.0;
        let mut bytes = match &buffer.uri {
            Some(uri) => match self.resolve(uri)? {
                Resolved::Bytes(bytes) => bytes,
                Resolved::File(path) => {
                    let bytes = read_file(&path, &self.place)?;
                    self.sources.push((path, fnv1a(&bytes)));
                    bytes
                }
            },
            None => binary.filter(|_| i == 0).unwrap_or_default().to_vec(),
        };
        if (bytes.len() as u64) < length {
            let what = format!("buffer {i} has {} bytes of {length}", bytes.len());
            return Err(self.wrong(what));
        }
        bytes.truncate(length as usize);
        Ok(bytes)
    }
}

fn check_extensions(root: &Root, place: &Location) -> Result<(), SceneError> {
    let unknown = root.extensions_required.iter().find(|name| !KNOWN.contains(&name.as_str()));
    let Some(name) = unknown else { return Ok(()) };
    let remedy = match name.as_str() {
        "KHR_texture_basisu" | "EXT_texture_avif" | "MSFT_texture_dds" => {
            "export textures as PNG, JPEG or WebP"
        }
        _ => "export the model without it",
    };
    Err(place.wrong(format!("the file requires the extension {name}, which is not supported"), remedy))
}

/// Returns the names of extensions that are used, and neither read nor found in the file.
pub(super) fn unread_extensions(document: &GltfFile) -> impl Iterator<Item = &String> {
    let is_unread =
        |name: &&String| !KNOWN.contains(&name.as_str()) && !document.unread.extensions.contains(*name);
    document.root.extensions_used.iter().filter(is_unread)
}
