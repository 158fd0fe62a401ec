//! Errors of Embree, each with its remedy.

use super::Version;

/// Reason why there is no device or no acceleration structure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EmbreeError {
    /// `rtcNewDevice` returned no device: the processor is too old, or memory is short.
    #[error("Embree cannot create a device: {code}: {message}")]
    NoDevice {
        /// Embree's name of the error code.
        code: String,
        /// Embree's explanation.
        message: String,
    },
    /// The loaded library has a version that the bindings do not support.
    #[error(
        "Embree {found} was loaded, but lightsplat needs 4.3 or a later 4.x: run `make setup` and build \
         again, or set EMBREE_DIR to such a version"
    )]
    Version {
        /// Version that the library reports.
        found: Version,
    },
    /// The library lacks a required feature.
    #[error("this Embree was built without {feature}: run `make setup` without EMBREE_DIR and build again")]
    Feature {
        /// CMake option that is off.
        feature: &'static str,
    },
    /// Embree reported an error during a call.
    #[error("Embree failed while {during}: {code}: {message}")]
    Call {
        /// Activity that failed.
        during: &'static str,
        /// Embree's name of the error code.
        code: String,
        /// Embree's explanation.
        message: String,
    },
    /// Triangles that Embree would silently ignore.
    #[error(
        "mesh {mesh}: {count} triangles have a coordinate that is not finite or beyond ±1.8e18 \
         (the first is triangle {first}): sanitise the scene before building"
    )]
    InvalidTriangles {
        /// Index of the mesh.
        mesh: usize,
        /// Index of the first such triangle.
        first: usize,
        /// Number of such triangles in the mesh.
        count: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error("mesh {mesh}: triangle {triangle} names vertex {index}, but there are {vertices} vertices")]
    VertexIndex {
        /// Index of the mesh.
        mesh: usize,
        /// Index of the triangle.
        triangle: usize,
        /// The index out of range.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// More meshes, vertices or triangles than 32-bit ids can distinguish.
    #[error("{count} {what} exceed the range of 32-bit ids: split the scene")]
    TooMany {
        /// Kind of the objects.
        what: &'static str,
        /// Number of the objects.
        count: usize,
    },
}
