//! Writes `src/bindings.rs` from Embree's headers.
//!
//! `EMBREE_DIR=/usr cargo build -p embree4-sys --features generate` with Debian's `libembree-dev`
//! 4.3.3 gives the file that is checked in.

use std::path::{Path, PathBuf};

/// Functions that the safe interface calls; types and constants follow from the signatures.
const FUNCTIONS: &[&str] = &[
    "rtc(New|Release|Commit)(Device|Scene|Geometry)",
    "rtcGetDevice(Property|Error|LastErrorMessage)",
    "rtcGetErrorString",
    "rtcSetDeviceErrorFunction",
    "rtcSetScene(BuildQuality|Flags)",
    "rtcSetGeometry(Mask|BuildQuality|InstancedScene|Transform)",
    "rtcSetNewGeometryBuffer",
    "rtcAttachGeometryByID",
    "rtcGetSceneBounds",
    "rtcIntersect(1|4|8|16)",
    "rtcOccluded(1|4|8|16)",
];
/// Types that occur only in casts: the views of a packet inside a filter, and the flags.
const TYPES: &[&str] =
    &["RTCRayQueryFlags", "RTCSceneFlags", "RTCHit", "RTCHit16", "RTCFilterFunctionNArguments"];

/// Runs bindgen over `$EMBREE_DIR/include/embree4/rtcore.h`.
pub fn write_bindings() -> Result<(), String> {
    println!("cargo::rerun-if-env-changed=EMBREE_DIR");
    let embree =
        std::env::var_os("EMBREE_DIR").ok_or("feature `generate` takes the headers from EMBREE_DIR")?;
    let include = PathBuf::from(embree).join("include");
    let header = include.join("embree4/rtcore.h");
    let mut builder = bindgen::Builder::default()
        .header(header.to_string_lossy())
        .clang_arg(format!("-I{}", include.display()))
        .prepend_enum_name(false)
        .generate_comments(false)
        .use_core()
        .sort_semantically(true)
        .merge_extern_blocks(true)
        .raw_line("// Generated from Embree 4.3.3 by `--features generate`. Do not edit.")
        .formatter(bindgen::Formatter::Rustfmt);
    for function in FUNCTIONS {
        builder = builder.allowlist_function(function);
    }
    for ty in TYPES {
        builder = builder.allowlist_type(ty);
    }
    let bindings = builder.generate().map_err(|e| format!("bindgen failed on {}: {e}", header.display()))?;
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").ok_or("CARGO_MANIFEST_DIR is not set: run by cargo")?;
    let path = Path::new(&package).join("src/bindings.rs");
    bindings.write_to_file(&path).map_err(|e| format!("cannot write {}: {e}", path.display()))
}
