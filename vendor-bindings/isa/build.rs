//! Compiles the check of the processor for the instruction sets that Rust's code is compiled for.

use std::path::PathBuf;
use std::{env, fs};

/// Instruction sets that compilers use unasked, oldest first. A processor that lacks another one lacks one of these.
const SETS: [&str; 25] = [
    "sse3",
    "ssse3",
    "sse4.1",
    "sse4.2",
    "popcnt",
    "avx",
    "fma",
    "f16c",
    "bmi1",
    "bmi2",
    "lzcnt",
    "movbe",
    "avx2",
    "avx512f",
    "avx512cd",
    "avx512bw",
    "avx512dq",
    "avx512vl",
    "avx512ifma",
    "avx512vbmi",
    "avx512vbmi2",
    "avx512vnni",
    "avx512bitalg",
    "avx512vpopcntdq",
    "gfni",
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/check.c");
    if env::var("CARGO_CFG_TARGET_ARCH")? != "x86_64" {
        return Ok(());
    }
    let built_for = env::var("CARGO_CFG_TARGET_FEATURE")?;
    let is_needed = |set: &str| built_for.split(',').any(|feature| feature == set);
    let lines = SETS.iter().filter(|set| is_needed(set)).map(|set| format!("NEEDS(\"{set}\")\n"));
    let folder = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(folder.join("needs.h"), lines.collect::<String>())?;
    cc::Build::new().file("src/check.c").include(&folder).compile("isa_check");
    Ok(())
}
