//! Adds two folders to the run path of programs and tests: their own, so that a program may be moved together with its
//! libraries, and the folder of the Embree that `embree4-sys` linked. The loader would not find that folder otherwise.
//!
//! All crates that reach Embree share this script. Cargo hands the folder to direct dependents only, so the crate
//! `embree` passes it on.

use std::env::var;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if var("CARGO_PKG_NAME").is_ok_and(|name| name == "bench") {
        tell_commit();
        tell_compiler();
    }
    println!("cargo::rerun-if-env-changed=LIGHTSPLAT_MOVABLE");
    println!("cargo::rustc-link-arg=-Wl,-rpath,$ORIGIN");
    // Packages hold their libraries, and name no folder of the machine that makes them.
    let is_movable = var("LIGHTSPLAT_MOVABLE").is_ok_and(|value| !value.is_empty());
    // Absent if Embree is in a system folder.
    let directory = var("DEP_EMBREE4_LIBDIR").or_else(|_| var("DEP_EMBREE_LIBDIR"));
    if let Ok(directory) = directory {
        if !is_movable {
            println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
        }
        if var("CARGO_MANIFEST_LINKS").is_ok() {
            println!("cargo::metadata=LIBDIR={directory}");
        }
    }
}

/// Sets the variable `LIGHTSPLAT_RUSTC` to the compiler's version for the crate.
fn tell_compiler() {
    let rustc = var("RUSTC").unwrap_or("rustc".to_owned());
    let output =
        Command::new(rustc).arg("--version").output().ok().and_then(|o| String::from_utf8(o.stdout).ok());
    if let Some(version) = output {
        println!("cargo::rustc-env=LIGHTSPLAT_RUSTC={}", version.trim());
    }
}

/// Sets the variable `LIGHTSPLAT_COMMIT` for the crate, if the sources are a git checkout.
fn tell_commit() {
    let git = |arguments: &[&str]| {
        let output =
            Command::new("git").args(arguments).output().ok().filter(|output| output.status.success());
        output.and_then(|output| String::from_utf8(output.stdout).ok()).map(|text| text.trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=10", "HEAD"]) else { return };
    println!("cargo::rustc-env=LIGHTSPLAT_COMMIT={commit}");
    // The log of HEAD changes with every commit and checkout.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
}
