//! Small models, built from pieces.

use serde_json::{Value, json};

/// A model under construction: its JSON and its binary chunk.
pub struct Model {
    pub json: Value,
    pub binary: Vec<u8>,
}

pub const COMPONENT_U16: u32 = 5123;
pub const COMPONENT_F32: u32 = 5126;

impl Model {
    pub fn new() -> Model {
        let json = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] });
        Model { json, binary: Vec::new() }
    }

    /// Adds an object to a list of the file; returns its index.
    pub fn push(&mut self, list: &str, object: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(object);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor =
            json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        self.push("accessors", accessor)
    }

    pub fn floats<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = vectors.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let kind = if N == 16 { "MAT4" } else { ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1] };
        self.accessor(&bytes, COMPONENT_F32, kind, vectors.len())
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor(&bytes, COMPONENT_U16, "SCALAR", indices.len())
    }

    /// Changes the attributes of the first primitive of mesh `mesh`.
    pub fn attributes(&mut self, mesh: usize, attributes: &[(&str, usize)]) {
        for (name, accessor) in attributes {
            self.json["meshes"][mesh]["primitives"][0]["attributes"][name] = json!(accessor);
        }
    }

    /// Adds a mesh of one square from (-1, -1, 0) to (1, 1, 0) that faces +z.
    pub fn square(&mut self, material: Option<usize>) -> usize {
        let positions =
            self.floats(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]);
        let normals = self.floats(&[[0.0, 0.0, 1.0]; 4]);
        let uvs = self.floats(&[[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        let indices = self.indices(&[0, 1, 2, 0, 2, 3]);
        let mut primitive = json!({
            "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs }, "indices": indices,
        });
        if let Some(material) = material {
            primitive["material"] = json!(material);
        }
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// Adds a node to the scene.
    pub fn node(&mut self, node: Value) -> usize {
        let number = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(number));
        number
    }

    /// Adds a square of a material as a node of the scene.
    pub fn shown(&mut self, material: Value) -> usize {
        let material = self.push("materials", material);
        let mesh = self.square(Some(material));
        self.node(json!({ "mesh": mesh }))
    }

    /// Adds an image of 2 by 2 texels, top row first, and a texture of it.
    pub fn texture(&mut self, texels: [[u8; 4]; 4], sampler: Value) -> usize {
        let image = image::RgbaImage::from_fn(2, 2, |x, y| image::Rgba(texels[(2 * y + x) as usize]));
        let mut png = std::io::Cursor::new(Vec::new());
        image.write_to(&mut png, image::ImageFormat::Png).unwrap();
        let view = self.view(png.get_ref());
        let image = self.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({ "source": image, "sampler": sampler }))
    }

    pub fn uses(&mut self, extension: &str) {
        self.push("extensionsUsed", json!(extension));
    }

    /// Returns the binary file, whose one buffer is the binary chunk.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if let (Some(object), false) = (json.as_object_mut(), self.binary.is_empty()) {
            object.insert("buffers".to_owned(), json!([{ "byteLength": self.binary.len() }]));
        }
        Model { json, binary: self.binary.clone() }.glb_as_is()
    }

    /// Returns the binary file with the buffers that the JSON lists.
    pub fn glb_as_is(&self) -> Vec<u8> {
        let json = &self.json;
        let padded = |bytes: &[u8], with: u8| {
            let mut bytes = bytes.to_vec();
            bytes.resize(bytes.len().next_multiple_of(4), with);
            bytes
        };
        let (text, binary) = (padded(json.to_string().as_bytes(), b' '), padded(&self.binary, 0));
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend(((28 + text.len() + binary.len()) as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }
}
