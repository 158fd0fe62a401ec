//! Decompression of primitives: the extension `KHR_draco_mesh_compression`, with the crate `draco-core`.

use base::stats::available_bytes;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use gltf_json::accessor::{Accessor, ComponentType};
use gltf_json::mesh::Primitive;
use gltf_json::validation::Checked;
use gltf_json::{Index, Root, buffer};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Maximum number of decoded bytes per primitive: 2 GiB.
const MAX_DECODED_BYTES: u64 = 2 << 30;

/// Statements of the extension about a primitive.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct DracoPrimitive {
    buffer_view: u32,
    /// Numbers of the compressed attributes, by names of attributes.
    attributes: BTreeMap<String, u32>,
}

impl DracoPrimitive {
    /// Returns the statements about a primitive; `None` for a primitive that is not compressed.
    fn parse(primitive: &Primitive) -> Option<Result<DracoPrimitive, String>> {
        let value = primitive.extensions.as_ref()?.others.get("KHR_draco_mesh_compression")?;
        Some(serde_json::from_value(value.clone()).map_err(|error| error.to_string()))
    }
}

/// Returns the elements of the accessors of all compressed primitives by their indices, or what is wrong.
///
/// `view` returns the bytes of a buffer view.
pub(super) fn accessors<'a>(
    root: &Root,
    view: impl Fn(Index<buffer::View>) -> Option<&'a [u8]>,
) -> Result<BTreeMap<usize, Vec<u8>>, String> {
    let mut accessors = BTreeMap::new();
    for (i, mesh) in root.meshes.iter().enumerate() {
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let Some(compression) = DracoPrimitive::parse(primitive) else { continue };
            let wrong = |problem: String| format!("mesh {i}, primitive {j}: its compressed form {problem}");
            let compression = compression.map_err(|error| wrong(format!("is not described: {error}")))?;
            let bytes = view(Index::new(compression.buffer_view));
            let bytes = bytes.ok_or_else(|| wrong("is in no buffer view".into()))?;
            decode(root, primitive, &compression, bytes, &mut accessors).map_err(wrong)?;
        }
    }
    Ok(accessors)
}

/// Decodes a primitive, and adds the elements of its accessors.
fn decode(
    root: &Root,
    primitive: &Primitive,
    compression: &DracoPrimitive,
    bytes: &[u8],
    accessors: &mut BTreeMap<usize, Vec<u8>>,
) -> Result<(), String> {
    let accessor = |index: Index<Accessor>| {
        let accessor = root.accessors.get(index.value());
        accessor.ok_or_else(|| format!("belongs to accessor {}, which does not exist", index.value()))
    };
    let index = primitive.indices.ok_or("has no accessor of indices")?;
    let indices = accessor(index)?;
    // A few bytes may stand for millions of equal values.
    let most = available_bytes().map_or(MAX_DECODED_BYTES, |bytes| MAX_DECODED_BYTES.min(bytes / 4));
    let limits = DecodeLimits::default().with_max_decoded_bytes(most).with_max_faces(indices.count.0 / 3);
    let mut mesh = Mesh::new();
    let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
    decoded.map_err(|error| format!("cannot be decoded: {error}"))?;
    let size = match component(indices) {
        Some(kind @ (ComponentType::U8 | ComponentType::U16 | ComponentType::U32)) => kind.size(),
        _ => return Err("has indices of a wrong type".into()),
    };
    let corners = mesh.faces().iter().flatten().map(|point| point.0);
    accessors.insert(index.value(), corners.flat_map(|i| i.to_le_bytes().into_iter().take(size)).collect());
    for (semantic, index) in &primitive.attributes {
        let name = semantic.to_string();
        let Some(&number) = compression.attributes.get(&name) else { continue };
        let attribute = mesh.attribute_by_unique_id(number);
        let attribute = attribute.ok_or_else(|| format!("lacks {name}, attribute {number}"))?;
        let accessor = accessor(*index)?;
        let parts = match &accessor.type_ {
            Checked::Valid(kind) => kind.multiplicity(),
            Checked::Invalid => 0,
        };
        if Some(attribute.data_type()) != component(accessor).map(data_type)
            || attribute.num_components() as usize != parts
        {
            return Err(format!("has {name} of another type than its accessor"));
        }
        if accessor.count.0 != mesh.num_points() as u64 {
            return Err(format!("has {} vertices, and {name} {}", mesh.num_points(), accessor.count.0));
        }
        let values =
            values(attribute, mesh.num_points()).ok_or_else(|| format!("has too few values of {name}"))?;
        accessors.insert(index.value(), values);
    }
    Ok(())
}

/// Returns the values of an attribute by points, without gaps; `None` if some are missing.
fn values(attribute: &PointAttribute, points: usize) -> Option<Vec<u8>> {
    let size = attribute.data_type().byte_length() * usize::from(attribute.num_components());
    let (stride, data) = (usize::try_from(attribute.byte_stride()).ok()?, attribute.buffer().data());
    let mut values = Vec::new();
    for point in 0..points {
        let at = attribute.mapped_index(PointIndex(point as u32)).0 as usize;
        values.extend(data.get(at.checked_mul(stride)?..)?.get(..size)?);
    }
    Some(values)
}

fn component(accessor: &Accessor) -> Option<ComponentType> {
    match &accessor.component_type {
        Checked::Valid(component) => Some(component.0),
        Checked::Invalid => None,
    }
}

fn data_type(component: ComponentType) -> DataType {
    match component {
        ComponentType::I8 => DataType::Int8,
        ComponentType::U8 => DataType::Uint8,
        ComponentType::I16 => DataType::Int16,
        ComponentType::U16 => DataType::Uint16,
        ComponentType::U32 => DataType::Uint32,
        ComponentType::F32 => DataType::Float32,
    }
}
