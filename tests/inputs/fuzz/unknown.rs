//! Valid files with one statement more, which no reader knows: a warning or an error tells it, unless it cannot change
//! a picture.
//!
//! Comments, `extras`, names that a format reserves for other programs, and channels of an image besides its picture
//! cannot change a picture. Nothing may be said about them.
//!
//! A case follows from its number, as those of [`super::fuzz`] do, and the same variables of the environment count.

use super::Extent;
use super::additions::{self, Addition};
use super::mutate::Random;
use super::seeds;
use super::target::{Workplace, without_sky};
use lightsplat::readers::{LoadOptions, ViewList};
use lightsplat::scene::Environment;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Tries `count` additions to files of a format, or those that the environment asks for.
fn add(format: &str, count: u64) {
    let extent = Extent::start(count);
    let first = extent.first;
    let name = format!("unknown-{format}-{first}");
    let workplace = Workplace::new(Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(name));
    // The environment is the picture of EXR files.
    let options = if format == "exr" { LoadOptions::default() } else { without_sky() };
    // Number of warnings about a file; `None` if it does not load.
    let warnings = |extension: &str, bytes: &[u8]| -> Result<usize, String> {
        fs::write(workplace.case(extension), bytes).unwrap();
        if extension == "json" {
            let list =
                ViewList::read(&workplace.case(extension), &options).map_err(|error| error.to_string())?;
            return Ok(list.warnings().len());
        }
        let loaded = workplace.load(extension, &options).map_err(|error| error.to_string())?;
        if let Some(Environment::Map(map)) = loaded.scene.environment.filter(|_| format == "exr") {
            assert!(map.radiance.iter().all(|texel| *texel == additions::SKY), "another channel is read");
        }
        Ok(loaded.warnings.len())
    };
    let seeds: Vec<_> = match format {
        // All additions to pictures and PLY meshes begin with the same file.
        "exr" | "ply" => vec![(0, format, Vec::new())],
        _ => (seeds::seeds_of(format).into_iter())
            .filter(|seed| format != "gltf" || seed.extension == "gltf")
            .filter(|seed| format != "stl" || seed.bytes.is_ascii())
            .filter_map(|seed| {
                Some((warnings(seed.extension, &seed.bytes).ok()?, seed.extension, seed.bytes))
            })
            .collect(),
    };
    assert!(!seeds.is_empty(), "no seed of {format} loads");
    let mut wrong: BTreeMap<String, String> = BTreeMap::new();
    let (mut case, mut told) = (first, 0);
    while extent.has(case) {
        let mut random = Random::new(case);
        let (before, extension, bytes) = random.pick(&seeds);
        let Addition { bytes, kind, is_told } = additions::add(format, bytes, &mut random);
        let after = warnings(extension, &bytes);
        let was_told = !matches!(&after, Ok(after) if after <= before);
        told += u64::from(was_told);
        if was_told != is_told {
            let said = if was_told { "is told" } else { "falls through" };
            wrong.entry(kind.clone()).or_insert_with(|| format!("{kind} {said} in case {case}: {after:?}"));
        }
        case += 1;
    }
    if extent.is_asked_for {
        let (count, seconds) = (case - first, extent.spent());
        eprintln!(
            "{format}: {count} additions from {first}, of which {told} are told, in {seconds:.0} s of the processor"
        );
    }
    let _ = fs::remove_dir_all(workplace.case("").parent().unwrap());
    assert!(wrong.is_empty(), "{:#?}", wrong.values().collect::<Vec<_>>());
    assert!(told > 0 || format == "exr", "no addition is told");
}

#[test]
fn statements_of_native_scenes_are_told() {
    add("toml", 300);
}

#[test]
fn statements_of_ply_are_told() {
    add("ply", 300);
}

#[test]
fn channels_of_exr_besides_the_picture_are_no_trouble() {
    add("exr", 300);
}

#[test]
fn statements_of_stl_are_told() {
    add("stl", 300);
}

#[test]
fn keys_of_lists_of_cameras_are_told() {
    add("views", 300);
}

#[test]
fn statements_of_obj_are_told() {
    add("obj", 300);
}

#[test]
fn statements_of_mtl_are_told() {
    add("mtl", 300);
}

#[test]
fn statements_of_gltf_are_told() {
    add("gltf", 300);
}

#[test]
fn statements_of_mitsuba_are_told() {
    add("xml", 300);
}
