//! Triangle meshes as input of acceleration structures.

use super::EmbreeError;
use embree4_sys as sys;
use glam::Vec3;

/// Coordinate from which Embree leaves out a triangle (its `FLT_LARGE`).
const COORDINATE_LIMIT: f32 = 1.844e18;

/// Triangles to build from. [`crate::Accel::build`] copies them.
#[derive(Clone, Copy, Debug)]
pub struct TriangleMesh<'a> {
    /// Vertex positions.
    pub positions: &'a [Vec3],
    /// Vertex indices of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// False if queries for occlusion ignore it.
    pub occludes: bool,
}

/// Rejects meshes that Embree would read out of bounds or silently ignore.
pub(super) fn check<'a, 'm: 'a>(
    meshes: impl IntoIterator<Item = &'a TriangleMesh<'m>>,
) -> Result<(), EmbreeError> {
    let mut count = 0;
    for (index, mesh) in meshes.into_iter().enumerate() {
        validate(index, mesh)?;
        count = index + 1;
    }
    if u32::try_from(count).is_err() { Err(EmbreeError::TooMany { what: "meshes", count }) } else { Ok(()) }
}

/// Copies `items`, of three 32-bit numbers each, into a new buffer of Embree, which pads it as required.
///
/// Returns false if there is no memory. Embree has then reported it.
pub(super) fn copy_buffer<T: Copy>(
    geometry: sys::RTCGeometry,
    buffer_type: sys::RTCBufferType,
    format: sys::RTCFormat,
    items: &[T],
) -> bool {
    const { assert!(size_of::<T>() == 12) };
    // SAFETY: the geometry is live and the format is of 12 bytes.
    let buffer = unsafe {
        sys::rtcSetNewGeometryBuffer(geometry, buffer_type, 0, format, size_of::<T>(), items.len())
    };
    if buffer.is_null() {
        return false;
    }
    // SAFETY: the new buffer holds at least `items.len()` items of 12 bytes, is 16-byte aligned and
    // overlaps nothing of ours; `T` is `Copy`.
    unsafe { std::ptr::copy_nonoverlapping(items.as_ptr(), buffer.cast::<T>(), items.len()) };
    true
}

/// Rejects input that Embree would read out of bounds or silently ignore.
fn validate(mesh_index: usize, mesh: &TriangleMesh) -> Result<(), EmbreeError> {
    for (what, count) in [("triangles", mesh.triangles.len()), ("vertices", mesh.positions.len())] {
        if u32::try_from(count).is_err() {
            return Err(EmbreeError::TooMany { what, count });
        }
    }
    let (mut first, mut count) = (0, 0);
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        let mut is_valid = true;
        for &index in corners {
            let Some(p) = mesh.positions.get(index as usize) else {
                let vertices = mesh.positions.len();
                return Err(EmbreeError::VertexIndex { mesh: mesh_index, triangle, index, vertices });
            };
            // This is false for NaN.
            is_valid &= p.abs().cmplt(Vec3::splat(COORDINATE_LIMIT)).all();
        }
        if !is_valid {
            first = if count == 0 { triangle } else { first };
            count += 1;
        }
    }
    if count > 0 { Err(EmbreeError::InvalidTriangles { mesh: mesh_index, first, count }) } else { Ok(()) }
}
