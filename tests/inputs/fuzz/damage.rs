//! Valid files with damage whose meaning is known: a warning, a repair or an error tells it, unless the scene is equal.
//!
//! - A file that is cut off: what is lost is told. A cut at the end of a statement is valid in OBJ, MTL and TOML, whose
//!   files do not say where they end.
//! - A wrong number of triangles, vertices, faces, elements or bytes.
//! - Another encoding: UTF-16, a byte order mark, line ends of other systems. The scene is equal, or it is told.
//! - NaN in place of a number.
//! - Swapped bytes. They may be other valid values, so only an emptier scene has to be told. Digits are not swapped: a
//!   smaller number of vertices may be valid, too.
//!
//! A case follows from its number, as those of [`super::fuzz`] do, and the same variables of the environment count.

use super::mutate::{Random, number_places};
use super::seeds::{self, Seed};
use super::target::{Workplace, without_sky};
use super::{Extent, MEMORY, listen};
use lightsplat::readers::{LoadOptions, Loaded, ViewList};
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Maximum memory of a run that the environment asks for.
const MAX_BYTES: usize = 1 << 30;
/// Maximum time of a case in seconds, elapsed and of the processor.
const MAX_SECONDS: f64 = 1.0;

/// Outcome that a damaged file must have.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    /// An equal scene, or anything that is told.
    EqualOrTold,
    /// A scene with as much in it, or anything that is told.
    FullOrTold,
    /// Anything but a panic.
    Any,
}

/// A file as it was read.
#[derive(Clone, PartialEq)]
struct Read {
    /// Everything that an image depends on.
    content: String,
    /// Number of triangles, textures and lights, or of views.
    amount: usize,
    /// Warnings and repairs.
    told: Vec<String>,
}

/// Reads a file; returns the error that tells its damage.
fn read(workplace: &Workplace, extension: &str, bytes: &[u8]) -> Result<Read, String> {
    fs::write(workplace.case(extension), bytes).unwrap();
    if extension == "json" {
        let list =
            ViewList::read(&workplace.case(extension), &without_sky()).map_err(|error| error.to_string())?;
        let told = list.warnings().iter().map(ToString::to_string).collect();
        let content = format!("{:?} {:x}", list.file_names(), list.hash());
        return Ok(Read { content, amount: list.file_names().len(), told });
    }
    let options = LoadOptions { most_copied: Some(0), ..without_sky() };
    let loaded = workplace.load(extension, &options).map_err(|error| error.to_string())?;
    let Loaded { scene, cameras, warnings, repairs, .. } = loaded;
    let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let amount = triangles + scene.textures.len() + scene.lights.len();
    let content = format!(
        "{:?} {:?} {:?} {:?} {:?} {cameras:?}",
        scene.meshes, scene.groups, scene.materials, scene.textures, scene.lights
    );
    let told = warnings.iter().map(ToString::to_string).chain([repairs.to_string()]).collect();
    Ok(Read { content, amount, told })
}

/// Damages a file of a format; returns its bytes, what was done, and what it has to become.
fn damage(format: &str, bytes: &[u8], random: &mut Random) -> (Vec<u8>, String, Rule) {
    let text = std::str::from_utf8(bytes).ok();
    let ends = !matches!(format, "obj" | "mtl" | "toml");
    match random.below(5) {
        0 => {
            let at = random.below(bytes.len());
            let rule = if ends { Rule::EqualOrTold } else { Rule::Any };
            (bytes[..at].to_vec(), format!("cut at {at} of {}", bytes.len()), rule)
        }
        1 if matches!(format, "stl" | "ply") => with_count(bytes, random),
        1 if format == "serialized" => with_inflated_count(bytes, random),
        1 if format == "gltf" => with_member(bytes, random),
        2 if text.is_some() => {
            let (bytes, kind) = encoded(text.unwrap_or_default(), random);
            (bytes, kind.to_owned(), Rule::EqualOrTold)
        }
        3 => with_nan(bytes, format, random),
        _ => swapped(bytes, random),
    }
}

/// States another number in a header.
fn with_count(bytes: &[u8], random: &mut Random) -> (Vec<u8>, String, Rule) {
    let count = *random.pick(&[0, 1, 2, 3, 5, 7, 100, 65_536, u32::MAX]);
    let text = String::from_utf8_lossy(bytes);
    let mut damaged = bytes.to_vec();
    match text.match_indices("element ").map(|(at, _)| at).collect::<Vec<_>>()[..] {
        [] if text.is_ascii() => {}
        [] => damaged[80..84].copy_from_slice(&count.to_le_bytes()),
        ref all => {
            // The header is ASCII, so places in the text are places in the file.
            let start = *random.pick(all) + "element ".len();
            let number = start + text[start..].find(' ').unwrap_or_default() + 1;
            let end = number + text[number..].find(['\n', '\r']).unwrap_or_default();
            damaged.splice(number..end, count.to_string().into_bytes());
        }
    }
    (damaged, format!("a count of {count}"), Rule::EqualOrTold)
}

/// States another number of vertices or triangles in an inflated mesh, behind its flags and its name.
fn with_inflated_count(bytes: &[u8], random: &mut Random) -> (Vec<u8>, String, Rule) {
    let count = *random.pick(&[0u64, 1, 2, 3, 5, 7, 100, 65_536, u64::MAX]);
    let mut damaged = bytes.to_vec();
    // Names hold no zero.
    let name = if bytes.get(4) == Some(&b's') { "square\0".len() } else { 0 };
    let at = 4 + name + 8 * random.below(2);
    if let Some(number) = damaged.get_mut(at..at + 8) {
        number.copy_from_slice(&count.to_le_bytes());
    }
    (damaged, format!("a count of {count}"), Rule::EqualOrTold)
}

/// States another number of elements or bytes in the JSON of a model.
///
/// A file of fewer elements may be valid.
fn with_member(bytes: &[u8], random: &mut Random) -> (Vec<u8>, String, Rule) {
    let (key, rule) = *random.pick(&[("count", Rule::FullOrTold), ("byteLength", Rule::EqualOrTold)]);
    let unchanged = || (bytes.to_vec(), format!("no {key}"), Rule::EqualOrTold);
    let Ok(text) = std::str::from_utf8(bytes) else { return unchanged() };
    let start = format!("\"{key}\": ");
    let places: Vec<usize> = text.match_indices(&start).map(|(at, _)| at + start.len()).collect();
    if places.is_empty() {
        return unchanged();
    }
    let at = *random.pick(&places);
    let end = at + text[at..].find(|c: char| !c.is_ascii_digit()).unwrap_or_default();
    let before: u64 = text[at..end].parse().unwrap_or_default();
    let count = *random.pick(&[0, 1, 2, 3, 5, 7, 100, 65_536, u64::from(u32::MAX), before + 1, before + 3]);
    let rule = if key == "count" && count < before { Rule::Any } else { rule };
    (format!("{}{count}{}", &text[..at], &text[end..]).into_bytes(), format!("a {key} of {count}"), rule)
}

/// Writes a text in another encoding, or with other line ends.
fn encoded(text: &str, random: &mut Random) -> (Vec<u8>, &'static str) {
    let units = || format!("\u{feff}{text}").encode_utf16().collect::<Vec<u16>>();
    match random.below(5) {
        0 => (units().iter().flat_map(|unit| unit.to_le_bytes()).collect(), "UTF-16, little-endian"),
        1 => (units().iter().flat_map(|unit| unit.to_be_bytes()).collect(), "UTF-16, big-endian"),
        2 => (format!("\u{feff}{text}").into_bytes(), "a byte order mark"),
        3 => (text.replace('\n', "\r\n").into_bytes(), "line ends of Windows"),
        _ => (text.replace('\n', "\r").into_bytes(), "line ends of old Macintoshes"),
    }
}

/// Puts NaN in place of a number.
fn with_nan(bytes: &[u8], format: &str, random: &mut Random) -> (Vec<u8>, String, Rule) {
    let mut damaged = bytes.to_vec();
    let mut numbers = number_places(bytes);
    if format == "gltf" {
        // Names may hold any number.
        numbers.retain(|place| bytes[..place.start].iter().filter(|byte| **byte == b'"').count() % 2 == 0);
    }
    if format == "stl" && !bytes.is_ascii() {
        // One of the nine coordinates behind the normal.
        let records = (bytes.len() - 84) / 50;
        let at = 84 + 50 * random.below(records) + 12 + 4 * random.below(9);
        damaged[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    } else if std::str::from_utf8(bytes).is_ok() && !numbers.is_empty() {
        let nan = *random.pick(&["nan", "NaN", "-nan(ind)", "1.#QNAN"]);
        damaged.splice(random.pick(&numbers).clone(), nan.bytes());
    } else if matches!(format, "ply" | "gltf" | "serialized") && bytes.len() >= 4 {
        // Any four bytes may be other numbers.
        let at = random.below(bytes.len() - 3);
        let nan = if random.below(2) == 0 { f32::NAN.to_le_bytes() } else { f32::NAN.to_be_bytes() };
        damaged[at..at + 4].copy_from_slice(&nan);
        return (damaged, format!("NaN at {at}"), Rule::FullOrTold);
    }
    (damaged, "NaN".to_owned(), Rule::EqualOrTold)
}

/// Swaps two bytes that stand beside each other: letters of texts, or any bytes but digits.
fn swapped(bytes: &[u8], random: &mut Random) -> (Vec<u8>, String, Rule) {
    let mut damaged = bytes.to_vec();
    let is_text = std::str::from_utf8(bytes).is_ok();
    let may = |byte: u8| if is_text { byte.is_ascii_alphabetic() } else { !byte.is_ascii_digit() };
    let at = random.below(bytes.len().saturating_sub(1));
    if bytes.len() > 1 && may(bytes[at]) && may(bytes[at + 1]) {
        damaged.swap(at, at + 1);
    }
    (damaged, format!("bytes swapped at {at}"), Rule::FullOrTold)
}

/// Returns what is wrong with the outcome of a case.
fn fault(before: &Read, after: &Result<Read, String>, rule: Rule) -> Option<&'static str> {
    let Ok(after) = after else { return None };
    let is_told = after.told.iter().any(|said| !before.told.contains(said));
    match rule {
        Rule::Any => None,
        _ if is_told => None,
        Rule::EqualOrTold => (after.content != before.content).then_some("the scene is another, in silence"),
        Rule::FullOrTold => (after.amount < before.amount).then_some("the scene is emptier, in silence"),
    }
}

/// Returns the bytes around the first difference of two files.
fn difference(whole: &[u8], damaged: &[u8]) -> String {
    let at = whole.iter().zip(damaged).take_while(|(a, b)| a == b).count();
    let around =
        |bytes: &[u8]| bytes[at.saturating_sub(20)..bytes.len().min(at + 20)].escape_ascii().to_string();
    format!("\"{}\" is \"{}\"", around(whole), around(damaged))
}

/// Tries `count` damaged files of a format, or those that the environment asks for.
fn try_damage(format: &str, count: u64) {
    listen();
    let extent = Extent::start(count);
    let first = extent.first;
    if extent.is_asked_for {
        MEMORY.set_limit(MAX_BYTES).unwrap();
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(format!("damage-{format}-{first}"));
    let workplace = Workplace::new(folder);
    let seeds: Vec<(Read, Seed)> = (seeds::seeds_of(format).into_iter())
        .filter_map(|seed| {
            let bytes = seed.pack(seed.bytes.clone());
            Some((read(&workplace, seed.extension, &bytes).ok()?, seed))
        })
        .collect();
    assert!(!seeds.is_empty(), "no seed of {format} loads");
    let mut wrong: BTreeMap<String, String> = BTreeMap::new();
    let (mut case, mut loaded) = (first, 0);
    while extent.has(case) {
        let mut random = Random::new(case);
        let (before, seed) = random.pick(&seeds);
        let extension = seed.extension;
        // Half of the cases damage what is packed.
        let (whole, bytes, kind, rule) = match random.below(2) {
            0 => {
                let (bytes, kind, rule) = damage(format, &seed.bytes, &mut random);
                (seed.bytes.clone(), seed.pack(bytes), kind, rule)
            }
            _ => {
                let whole = seed.pack(seed.bytes.clone());
                let (bytes, kind, rule) = damage(format, &whole, &mut random);
                (whole, bytes, kind, rule)
            }
        };
        let begun = lightsplat::stats::Stopwatch::start();
        let after = catch_unwind(AssertUnwindSafe(|| read(&workplace, extension, &bytes)));
        let time = begun.elapsed();
        loaded += u64::from(matches!(after, Ok(Ok(_))));
        let is_slow = time.wall_seconds.min(time.cpu_seconds) > MAX_SECONDS;
        let fault = match &after {
            Err(_) => Some("a panic"),
            Ok(_) if is_slow => Some("it takes too long"),
            Ok(after) => fault(before, after, rule),
        };
        if let Some(fault) = fault {
            // Numbers say nothing about the kind.
            let kind_alone: String = kind.chars().filter(|c| !c.is_ascii_digit()).collect();
            let shown =
                || format!("case {case}, {extension}: {kind}: {fault}: {}", difference(&whole, &bytes));
            wrong.entry(format!("{extension} {kind_alone} {fault}")).or_insert_with(shown);
        }
        case += 1;
    }
    if extent.is_asked_for {
        let (count, seconds) = (case - first, extent.spent());
        eprintln!(
            "{format}: {count} damaged files from {first}, of which {loaded} load, in {seconds:.0} s of the processor"
        );
    }
    let _ = fs::remove_dir_all(workplace.case("").parent().unwrap());
    assert!(wrong.is_empty(), "{:#?}", wrong.values().collect::<Vec<_>>());
}

macro_rules! formats {
    ($($name:ident)+) => {$(
        #[test]
        fn $name() {
            try_damage(stringify!($name), 200);
        }
    )+};
}

formats! { stl ply obj mtl gltf toml xml serialized pictures exr views }
