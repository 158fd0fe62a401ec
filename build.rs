//! Lets binaries and tests find the Embree that `embree4-sys` linked, where the loader would not.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=DEP_EMBREE4_LIBDIR");
    // Absent where Embree lies in a folder of the system.
    if let Ok(directory) = std::env::var("DEP_EMBREE4_LIBDIR") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
    }
}
