//! Reader of Mitsuba's `.serialized` meshes, file versions 3 and 4: deflated blocks and a table of their offsets.

use super::RawMesh;
use crate::attributes::{NamedAttribute, VERTEX_COLOUR};
use crate::error::{Location, SceneError, Warning};
use crate::statements::{Fate, Statement, fate, note, table};
use flate2::read::ZlibDecoder;
use glam::{DVec3, Vec2};
use std::io::Read;
use std::path::Path;

const MAGIC: u16 = 0x041C;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLOURS: u32 = 0x0008;
const DOUBLE: u32 = 0x2000;

/// Returns the flags of a mesh.
fn listed_flags() -> &'static [Statement] {
    table("Serialized meshes of Mitsuba")
}

/// Maximum number of bytes of a mesh's name.
const MAX_NAME: usize = 1 << 16;

/// Reads mesh number `index` of the file `bytes`; `path` is for messages. Names in `remarks` what is not read.
pub fn read(
    bytes: &[u8],
    index: usize,
    path: &Path,
    remarks: &mut Vec<Warning>,
) -> Result<RawMesh, SceneError> {
    let fail = |what: String| SceneError::mesh(Location::file(path), format!("mesh {index}: {what}"));
    let Block { mesh, flags, has_more } = read_block(bytes, index).map_err(fail)?;
    let bits = (0..u32::BITS).map(|bit| 1 << bit).filter(|bit| flags & bit != 0);
    let named = |name: &String| fate(listed_flags(), name) == Fate::Named;
    for name in bits.map(|bit| format!("0x{bit:04x}")).filter(named) {
        let note = note(listed_flags(), &name);
        let what = format!("mesh {index}: the flag {name} is not read");
        remarks.push(Warning::new(Location::file(path), what, note));
    }
    if has_more {
        let what = format!("mesh {index}: data follows the last of its {} triangles", mesh.triangles.len());
        remarks.push(Warning::new(Location::file(path), what, "it is left out; export the mesh again"));
    }
    Ok(mesh)
}

/// A mesh as its block describes it.
struct Block {
    mesh: RawMesh,
    flags: u32,
    /// True if data follows the last triangle.
    has_more: bool,
}

/// Reads a mesh. Triangles may have vertices that do not exist.
fn read_block(bytes: &[u8], index: usize) -> Result<Block, String> {
    let magic = array(bytes, 0).map(u16::from_le_bytes);
    let version = array(bytes, 2).map(u16::from_le_bytes);
    if magic != Some(MAGIC) {
        return Err("this is not a serialized mesh file".into());
    }
    let version = version.filter(|v| *v == 3 || *v == 4);
    let version = version.ok_or("only versions 3 and 4 of the serialized format are understood")?;
    let start = if index == 0 { 0 } else { offset(bytes, index, version)? };
    let block = bytes.get(start..).and_then(|b| b.get(4..)).ok_or("its offset lies outside the file")?;
    let mut stream = Stream { inner: ZlibDecoder::new(block), limit: block.len() };

    let [flags] = stream.u32s::<1>()?;
    if version == 4 {
        stream.skip_name()?;
    }
    let [vertex_count, triangle_count] = stream.u64s::<2>()?;
    let doubles = flags & DOUBLE != 0;
    let mut mesh = RawMesh::default();
    let positions = stream.floats(vertex_count, 3, doubles)?;
    mesh.positions = positions.as_chunks::<3>().0.iter().map(|&p| DVec3::from(p)).collect();
    if flags & HAS_NORMALS != 0 {
        let normals = stream.floats(vertex_count, 3, doubles)?;
        mesh.normals = normals.as_chunks::<3>().0.iter().map(|&n| DVec3::from(n).as_vec3()).collect();
    }
    if flags & HAS_UVS != 0 {
        let uvs = stream.floats(vertex_count, 2, doubles)?;
        mesh.uvs = uvs.as_chunks::<2>().0.iter().map(|&[u, v]| Vec2::new(u as f32, v as f32)).collect();
    }
    if flags & HAS_COLOURS != 0 {
        let colours = stream.floats(vertex_count, 3, doubles)?;
        let colours = colours.as_chunks::<3>().0.iter().map(|&c| DVec3::from(c).as_vec3()).collect();
        mesh.attributes.push(NamedAttribute::of_vertices(VERTEX_COLOUR, colours));
    }
    let indices = stream.bytes(triangle_count, 12)?;
    let index_of = |t: &[u8; 12], k: usize| array(t, 4 * k).map_or(u32::MAX, u32::from_le_bytes);
    let triangles = indices.as_chunks::<12>().0.iter();
    mesh.triangles = triangles.map(|t| [index_of(t, 0), index_of(t, 1), index_of(t, 2)]).collect();
    let has_more = stream.bytes(1, 1).is_ok();
    Ok(Block { mesh, flags, has_more })
}

/// Returns the offset of block `index`, from the table at the file's end.
fn offset(bytes: &[u8], index: usize, version: u16) -> Result<usize, String> {
    let broken = || "the table of offsets at the file's end is broken".to_string();
    let table_end = bytes.len().checked_sub(4).ok_or_else(broken)?;
    let count = array(bytes, table_end).map(u32::from_le_bytes).ok_or_else(broken)? as usize;
    if index >= count {
        return Err(format!("the file holds only {count}, numbered from 0"));
    }
    let width = if version == 4 { 8 } else { 4 };
    let at = table_end.checked_sub((count - index).saturating_mul(width)).ok_or_else(broken)?;
    let offset = match version {
        4 => array(bytes, at).map(u64::from_le_bytes),
        _ => array(bytes, at).map(|b| u64::from(u32::from_le_bytes(b))),
    };
    offset.and_then(|o| usize::try_from(o).ok()).ok_or_else(broken)
}

fn array<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// A deflated block.
///
/// Deflate expands by at most 1032. A count beyond that is rejected before anything is allocated.
struct Stream<'a> {
    inner: ZlibDecoder<&'a [u8]>,
    limit: usize,
}

impl Stream<'_> {
    fn bytes(&mut self, count: u64, size: u64) -> Result<Vec<u8>, String> {
        let bytes = count.checked_mul(size).filter(|&b| b <= self.limit as u64 * 1040);
        let bytes =
            bytes.ok_or_else(|| format!("{count} elements cannot be stored in {} bytes", self.limit))?;
        let mut data = Vec::with_capacity(bytes.min(1 << 24) as usize);
        let read = self.inner.by_ref().take(bytes).read_to_end(&mut data);
        read.map_err(|e| format!("the compressed data is broken ({e})"))?;
        if data.len() as u64 != bytes {
            return Err("the compressed data ends too early".into());
        }
        Ok(data)
    }

    fn floats(&mut self, count: u64, dimension: u64, doubles: bool) -> Result<Vec<f64>, String> {
        if doubles {
            let data = self.bytes(count, 8 * dimension)?;
            return Ok(data.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect());
        }
        let data = self.bytes(count, 4 * dimension)?;
        Ok(data.as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect())
    }

    fn u32s<const N: usize>(&mut self) -> Result<[u32; N], String> {
        let data = self.bytes(N as u64, 4)?;
        let mut values = data.as_chunks().0.iter().map(|b| u32::from_le_bytes(*b));
        Ok(std::array::from_fn(|_| values.next().unwrap_or_default()))
    }

    fn u64s<const N: usize>(&mut self) -> Result<[u64; N], String> {
        let data = self.bytes(N as u64, 8)?;
        let mut values = data.as_chunks().0.iter().map(|b| u64::from_le_bytes(*b));
        Ok(std::array::from_fn(|_| values.next().unwrap_or_default()))
    }

    fn skip_name(&mut self) -> Result<(), String> {
        for _ in 0..MAX_NAME {
            if self.bytes(1, 1)? == [0] {
                return Ok(());
            }
        }
        Err(format!("its name is longer than {MAX_NAME} bytes"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write;

    #[test]
    fn the_page_lists_these_flags_and_each_is_read_or_named() {
        for flag in listed_flags().iter().map(|flag| flag.name).chain(["0x0100", "0x80000000"]) {
            let bit = u32::from_str_radix(&flag[2..], 16).unwrap();
            let width = if bit == DOUBLE { 8 } else { 4 };
            let floats = match bit {
                HAS_UVS => 5,
                HAS_NORMALS | HAS_COLOURS => 6,
                _ => 3,
            };
            let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
            zlib.write_all(
                &[&bit.to_le_bytes()[..], b"m\0", &3u64.to_le_bytes(), &1u64.to_le_bytes()].concat(),
            )
            .unwrap();
            zlib.write_all(&vec![0; 3 * floats * width]).unwrap();
            zlib.write_all(&[0u32, 1, 2].map(u32::to_le_bytes).concat()).unwrap();
            let file = [&MAGIC.to_le_bytes()[..], &4u16.to_le_bytes(), &zlib.finish().unwrap()].concat();
            let mut remarks = Vec::new();
            let mesh = read(&file, 0, Path::new("a.serialized"), &mut remarks).unwrap();
            assert_eq!(mesh.triangles, [[0, 1, 2]], "{flag}");
            let is_named = remarks.iter().any(|remark| remark.what.contains(flag));
            assert_eq!(is_named, fate(listed_flags(), flag) == Fate::Named, "{flag}");
            assert!(remarks.len() < 2, "{flag}");
        }
    }

    #[test]
    fn data_behind_the_last_triangle_is_named() {
        let said = |triangles: u64| -> Vec<String> {
            let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
            zlib.write_all(&[0x1000u32.to_le_bytes().to_vec(), 3u64.to_le_bytes().to_vec()].concat())
                .unwrap();
            zlib.write_all(&triangles.to_le_bytes()).unwrap();
            zlib.write_all(&[0; 36]).unwrap();
            zlib.write_all(&[0u32, 1, 2, 0, 1, 7].map(u32::to_le_bytes).concat()).unwrap();
            let file = [&MAGIC.to_le_bytes()[..], &3u16.to_le_bytes(), &zlib.finish().unwrap()].concat();
            let mut remarks = Vec::new();
            let mesh = read(&file, 0, Path::new("a.serialized"), &mut remarks).unwrap();
            assert_eq!(mesh.triangles.len() as u64, triangles);
            remarks.iter().map(Warning::to_string).collect()
        };
        assert_eq!(said(2), [""; 0]);
        assert!(said(1)[0].contains("data follows the last of its 1 triangles"), "{:?}", said(1));
    }

    #[test]
    fn a_name_without_an_end_is_an_error_at_once() {
        let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
        zlib.write_all(&0x1000u32.to_le_bytes()).unwrap();
        (0..300).for_each(|_| zlib.write_all(&[b'a'; 1 << 20]).unwrap());
        let file = [&MAGIC.to_le_bytes()[..], &4u16.to_le_bytes(), &zlib.finish().unwrap()].concat();
        let message = read(&file, 0, Path::new("a.serialized"), &mut Vec::new()).unwrap_err().to_string();
        assert!(message.contains("a.serialized") && message.contains("its name is longer"), "{message}");
    }
}
