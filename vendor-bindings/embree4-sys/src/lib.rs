//! Bindings to the part of Embree 4's C API that lightsplat uses.
//!
//! `bindings.rs` is bindgen's output from the 4.3.3 headers, checked in so that a build needs no libclang;
//! feature `generate` writes it anew. Enumerations are integer constants: a value that a newer library
//! returns is then no undefined behaviour. Embree keeps its ABI within a major version from 4.3 on; 4.2 had a
//! smaller `RTCHit`, so that callers must check `RTC_DEVICE_PROPERTY_VERSION` before the first ray.

#![allow(non_upper_case_globals, non_camel_case_types, non_snake_case)]
#![allow(clippy::all, missing_docs)]

mod bindings;
mod layout;

pub use bindings::*;

/// Lane value of `valid` for a ray to be traced; 0 for one to be skipped.
pub const RTC_LANE_VALID: i32 = -1;

/// Id of no geometry, primitive or instance (a macro in C).
pub const RTC_INVALID_GEOMETRY_ID: u32 = u32::MAX;
