//! Conversion of accessors to numbers.
//!
//! The file's statements about an accessor are checked before memory is read or allocated.

use super::document::GltfFile;
use crate::error::SceneError;
use gltf_json::accessor::{Accessor, ComponentType, Type};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Index, buffer};

/// Maximum number of elements of an accessor without bytes of its own.
const MAX_ZEROS: u64 = 1 << 24;

/// Elements in the bytes of a view.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl Elements<'_> {
    fn iter(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.count).map(|i| &self.bytes[i * self.stride..][..self.size])
    }
}

impl GltfFile {
    /// Returns the vectors of `N` numbers of the accessor; `what` names it in errors.
    ///
    /// If the accessor is `normalized`, integers are fractions of their range.
    pub fn vectors<const N: usize>(
        &self,
        index: Index<Accessor>,
        what: &str,
    ) -> Result<Vec<[f32; N]>, SceneError> {
        let accessor = self.get(index, "accessor")?;
        let wrong = |problem: &str| self.wrong(format!("{what}: accessor {} {problem}", index.value()));
        let Checked::Valid(component) = &accessor.component_type else {
            return Err(wrong("has an unknown type of component"));
        };
        let component = component.0;
        if components(&accessor.type_) != Some(N) || component == ComponentType::U32 {
            return Err(wrong("is of another type than it should be"));
        }
        let decode = |bytes: &[u8]| {
            let mut vector = [0.0; N];
            let parts = bytes.chunks_exact(component.size());
            vector
                .iter_mut()
                .zip(parts)
                .for_each(|(v, part)| *v = number(component, part, accessor.normalized));
            vector
        };
        let size = N * component.size();
        let mut vectors: Vec<[f32; N]> = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default();
                self.elements(view, offset, accessor.count, size, what)?.iter().map(decode).collect()
            }
            None if accessor.count.0 <= MAX_ZEROS => vec![[0.0; N]; accessor.count.0 as usize],
            None => return Err(wrong("claims to have more elements than any real model")),
        };
        if let Some(sparse) = &accessor.sparse {
            let (indices, values) = (&sparse.indices, &sparse.values);
            let Checked::Valid(kind) = &indices.component_type else {
                return Err(wrong("has sparse indices of an unknown type"));
            };
            let at =
                self.elements(indices.buffer_view, indices.byte_offset, sparse.count, kind.0.size(), what)?;
            let new = self.elements(values.buffer_view, values.byte_offset, sparse.count, size, what)?;
            for (at, new) in at.iter().zip(new.iter()) {
                let place = vectors.get_mut(unsigned(at) as usize);
                *place.ok_or_else(|| wrong("has a sparse index that is out of range"))? = decode(new);
            }
        }
        Ok(vectors)
    }

    /// Returns the unsigned integers of the accessor.
    pub fn integers(&self, index: Index<Accessor>, what: &str) -> Result<Vec<u32>, SceneError> {
        let accessor = self.get(index, "accessor")?;
        let wrong = |problem: &str| self.wrong(format!("{what}: accessor {} {problem}", index.value()));
        let size = match &accessor.component_type {
            Checked::Valid(kind) => match kind.0 {
                kind @ (ComponentType::U8 | ComponentType::U16 | ComponentType::U32) => kind.size(),
                _ => return Err(wrong("is of another type than it should be")),
            },
            Checked::Invalid => return Err(wrong("has an unknown type of component")),
        };
        let (Some(1), Some(view), None) =
            (components(&accessor.type_), accessor.buffer_view, &accessor.sparse)
        else {
            return Err(wrong("is not a plain list of numbers"));
        };
        let offset = accessor.byte_offset.unwrap_or_default();
        Ok(self.elements(view, offset, accessor.count, size, what)?.iter().map(unsigned).collect())
    }

    fn elements(
        &self,
        view: Index<buffer::View>,
        offset: USize64,
        count: USize64,
        size: usize,
        what: &str,
    ) -> Result<Elements<'_>, SceneError> {
        let bytes = self.view(view)?;
        let stride = self.get(view, "buffer view")?.byte_stride.as_ref().map_or(size, |stride| stride.0);
        if count.0 == 0 {
            return Ok(Elements { bytes: &[], stride, size, count: 0 });
        }
        let end = (count.0 - 1).checked_mul(stride as u64).and_then(|end| end.checked_add(offset.0));
        let end = end.and_then(|end| end.checked_add(size as u64));
        if stride < size || end.is_none_or(|end| end > bytes.len() as u64) {
            let what = format!("{what}: {} elements do not fit into buffer view {}", count.0, view.value());
            return Err(self.wrong(what));
        }
        Ok(Elements { bytes: &bytes[offset.0 as usize..], stride, size, count: count.0 as usize })
    }
}

/// Returns the number of components of a type.
fn components(kind: &Checked<Type>) -> Option<usize> {
    match kind {
        Checked::Valid(kind) => Some(kind.multiplicity()),
        Checked::Invalid => None,
    }
}

fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

/// Returns a component of a vector. If `normalized`, integers are fractions of their range.
fn number(kind: ComponentType, bytes: &[u8], normalized: bool) -> f32 {
    let bits = unsigned(bytes);
    let (value, range) = match kind {
        ComponentType::F32 => return f32::from_bits(bits),
        ComponentType::I8 => (f32::from(bits as u8 as i8), 127.0),
        ComponentType::U8 => (bits as f32, 255.0),
        ComponentType::I16 => (f32::from(bits as u16 as i16), 32767.0),
        ComponentType::U16 => (bits as f32, 65535.0),
        ComponentType::U32 => (bits as f32, f32::MAX),
    };
    if normalized { (value / range).max(-1.0) } else { value }
}
