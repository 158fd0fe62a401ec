//! Errors of building and querying with Embree, each with its remedy.

use super::Version;

/// Reason that there is no device or no acceleration structure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EmbreeError {
    /// `rtcNewDevice` returned no device: the processor is too old, or memory is short.
    #[error("Embree gave no device: {code}: {message}")]
    NoDevice {
        /// Embree's name of the error code.
        code: String,
        /// Embree's explanation.
        message: String,
    },
    /// The library that was loaded is of a version that the bindings do not describe.
    #[error(
        "Embree {found} was loaded, but 4.3 or later below 5 is needed: run `make setup` and build again, \
         or point EMBREE_DIR at a fitting one"
    )]
    Version {
        /// Version that the library reports.
        found: Version,
    },
    /// The library was built without a feature that is needed here.
    #[error("this Embree was built without {feature}: run `make setup` without EMBREE_DIR and build again")]
    Feature {
        /// CMake option that is off.
        feature: &'static str,
    },
    /// Embree reported an error during a call.
    #[error("Embree failed while {during}: {code}: {message}")]
    Call {
        /// Activity during which it failed.
        during: &'static str,
        /// Embree's name of the error code.
        code: String,
        /// Embree's explanation.
        message: String,
    },
    /// Triangles that Embree would silently leave out.
    #[error(
        "mesh {mesh}: {count} triangles have a coordinate that is not finite or beyond ±1.8e18 \
         (the first is triangle {first}): sanitise the scene before building"
    )]
    InvalidTriangles {
        /// Index of the mesh.
        mesh: usize,
        /// Index of the first such triangle.
        first: usize,
        /// Number of such triangles in this mesh.
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
    #[error("{count} {what} are more than 32-bit ids can tell apart: split the scene")]
    TooMany {
        /// Name of the excessive objects.
        what: &'static str,
        /// Their number.
        count: usize,
    },
}
