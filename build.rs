//! Adds to the run path of binaries and tests their own folder, so that a program may be moved with its libraries, and
//! that of the Embree that `embree4-sys` linked, where the loader would not find it.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=DEP_EMBREE4_LIBDIR");
    println!("cargo::rustc-link-arg=-Wl,-rpath,$ORIGIN");
    // Absent where Embree is in a system folder.
    if let Ok(directory) = std::env::var("DEP_EMBREE4_LIBDIR") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
    }
}
