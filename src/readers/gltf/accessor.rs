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
        let component = self.component(accessor, index, N, what)?;
        if component == ComponentType::U32 {
            return Err(self.misfit(index, what, "has the wrong type"));
        }
        let number = |bytes: &[u8]| number(component, bytes, accessor.normalized);
        self.numbers(accessor, index, component.size(), what, number)
    }

    /// Returns the vectors of `N` unsigned integers of the accessor.
    pub fn integers<const N: usize>(
        &self,
        index: Index<Accessor>,
        what: &str,
    ) -> Result<Vec<[u32; N]>, SceneError> {
        let accessor = self.get(index, "accessor")?;
        let component = self.component(accessor, index, N, what)?;
        if !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Err(self.misfit(index, what, "has the wrong type"));
        }
        self.numbers(accessor, index, component.size(), what, unsigned)
    }

    /// Returns the type of the components of an accessor of vectors of `n` numbers.
    fn component(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        n: usize,
        what: &str,
    ) -> Result<ComponentType, SceneError> {
        let Checked::Valid(component) = &accessor.component_type else {
            return Err(self.misfit(index, what, "has an unknown type of component"));
        };
        let fits = match &accessor.type_ {
            // Columns of matrices of bytes and shorts are padded; no file needs them.
            Checked::Valid(Type::Mat4) => n == 16 && component.0 == ComponentType::F32,
            Checked::Valid(Type::Mat2 | Type::Mat3) | Checked::Invalid => false,
            Checked::Valid(kind) => n == kind.multiplicity(),
        };
        if fits { Ok(component.0) } else { Err(self.misfit(index, what, "has the wrong type")) }
    }

    fn misfit(&self, index: Index<Accessor>, what: &str, problem: &str) -> SceneError {
        self.wrong(format!("{what}: accessor {} {problem}", index.value()))
    }

    /// Returns the vectors of an accessor whose components take `size` bytes each. Sparse values replace others.
    fn numbers<T: Copy + Default, const N: usize>(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        size: usize,
        what: &str,
        number: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>, SceneError> {
        let decode = |bytes: &[u8]| {
            let mut vector = [T::default(); N];
            vector.iter_mut().zip(bytes.chunks_exact(size)).for_each(|(v, part)| *v = number(part));
            vector
        };
        let size = N * size;
        if let Some(bytes) = self.decoded(index) {
            return Ok(bytes.chunks_exact(size).map(decode).collect());
        }
        let mut vectors: Vec<[T; N]> = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default();
                self.elements(view, offset, accessor.count, size, what)?.iter().map(decode).collect()
            }
            None if accessor.count.0 <= MAX_ZEROS => vec![[T::default(); N]; accessor.count.0 as usize],
            None => {
                return Err(self.misfit(index, what, "claims more elements than any real model has"));
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let (indices, values) = (&sparse.indices, &sparse.values);
            let Checked::Valid(kind) = &indices.component_type else {
                return Err(self.misfit(index, what, "has sparse indices of an unknown type"));
            };
            let at =
                self.elements(indices.buffer_view, indices.byte_offset, sparse.count, kind.0.size(), what)?;
            let new = self.elements(values.buffer_view, values.byte_offset, sparse.count, size, what)?;
            for (at, new) in at.iter().zip(new.iter()) {
                let place = vectors.get_mut(unsigned(at) as usize);
                let missing = || self.misfit(index, what, "has a sparse index that is out of range");
                *place.ok_or_else(missing)? = decode(new);
            }
        }
        Ok(vectors)
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
