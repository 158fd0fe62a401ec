//! Adds two folders to the run path of programs and tests: their own, so that a program may be moved together with its
//! libraries, and the folder of the Embree that `embree4-sys` linked. The loader would not find that folder otherwise.
//!
//! All crates that reach Embree share this script. Cargo hands the folder to direct dependents only, so the crate
//! `embree` passes it on.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-link-arg=-Wl,-rpath,$ORIGIN");
    // Absent if Embree is in a system folder.
    let directory = var("DEP_EMBREE4_LIBDIR").or_else(|_| var("DEP_EMBREE_LIBDIR"));
    if let Ok(directory) = directory {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
        if var("CARGO_MANIFEST_LINKS").is_ok() {
            println!("cargo::metadata=LIBDIR={directory}");
        }
    }
}
