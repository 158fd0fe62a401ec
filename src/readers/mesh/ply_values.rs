//! Values behind the header of a PLY file: text, or binary numbers of either byte order.

use super::numerals;
use super::wavefront::shown;

/// Reader of a binary number of some type.
pub(super) type Scalar = fn(&mut Binary) -> Result<f64, String>;

/// Returns the reader of a type by its name.
pub(super) fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => |binary| Ok(f64::from(i8::from_le_bytes(binary.take()?))),
        "uchar" | "uint8" => |binary| Ok(f64::from(u8::from_le_bytes(binary.take()?))),
        "short" | "int16" => |binary| Ok(f64::from(i16::from_le_bytes(binary.take()?))),
        "ushort" | "uint16" => |binary| Ok(f64::from(u16::from_le_bytes(binary.take()?))),
        "int" | "int32" => |binary| Ok(f64::from(i32::from_le_bytes(binary.take()?))),
        "uint" | "uint32" => |binary| Ok(f64::from(u32::from_le_bytes(binary.take()?))),
        "float" | "float32" => |binary| Ok(f64::from(f32::from_le_bytes(binary.take()?))),
        "double" | "float64" => |binary| Ok(f64::from_le_bytes(binary.take()?)),
        _ => return None,
    })
}

/// Sequence of the values after the header.
pub(super) trait PlyValues {
    fn next(&mut self, scalar: Scalar) -> Result<f64, String>;
    fn line(&self) -> Option<u32> {
        None
    }

    /// Returns the bytes not read yet.
    fn rest(&self) -> &[u8];
}

pub(super) struct Ascii<'a> {
    pub rest: &'a [u8],
    /// Number of lines before `rest`.
    pub line: u32,
    pub line_end: u8,
}

impl PlyValues for Ascii<'_> {
    fn next(&mut self, _: Scalar) -> Result<f64, String> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += self.rest[..start].iter().filter(|&&b| b == self.line_end).count() as u32;
        let rest = &self.rest[start..];
        let end = rest.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(rest.len());
        self.rest = &rest[end..];
        let token = &rest[..end];
        if token.is_empty() {
            return Err("the file ends too early".into());
        }
        numerals::number(token).ok_or_else(|| format!("cannot read the number \"{}\"", shown(token)))
    }

    fn line(&self) -> Option<u32> {
        Some(self.line + 1)
    }

    fn rest(&self) -> &[u8] {
        self.rest
    }
}

pub(super) struct Binary<'a> {
    pub rest: &'a [u8],
    pub big_endian: bool,
}

impl Binary<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or("the file ends too early")?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl PlyValues for Binary<'_> {
    fn next(&mut self, scalar: Scalar) -> Result<f64, String> {
        scalar(self)
    }

    fn rest(&self) -> &[u8] {
        self.rest
    }
}
