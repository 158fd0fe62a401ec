//! Additions of one statement to a valid file of each format.

use super::mutate::Random;
use lightsplat::film::{Film, Image, Layer, write_exr};
use lightsplat::math::Rgb;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::sync::Mutex;

/// A file with one statement more.
pub struct Addition {
    pub bytes: Vec<u8>,
    /// Kind of the statement, and its place.
    pub kind: String,
    /// True if a warning or an error has to tell it.
    pub is_told: bool,
}

impl Addition {
    fn told(bytes: impl Into<Vec<u8>>, kind: impl Into<String>) -> Addition {
        Addition { bytes: bytes.into(), kind: kind.into(), is_told: true }
    }

    fn without_effect(bytes: impl Into<Vec<u8>>, kind: impl Into<String>) -> Addition {
        Addition { is_told: false, ..Addition::told(bytes, kind) }
    }
}

/// Adds a statement to a file of a format.
pub fn add(format: &str, bytes: &[u8], random: &mut Random) -> Addition {
    let text = || String::from_utf8_lossy(bytes).into_owned();
    match format {
        "toml" => to_toml(&text(), random),
        "ply" => ply(random),
        "exr" => exr(random),
        "views" => to_views(&text(), random),
        "mtl" if random.below(8) == 0 => to_library(&text(), random),
        "obj" | "mtl" | "stl" => to_lines(&text(), random),
        "gltf" => to_gltf(bytes, random),
        "xml" => to_xml(&text(), random),
        other => panic!("no additions to {other}"),
    }
}

/// A name that no format knows.
fn name(random: &mut Random) -> String {
    let letters: String = (0..1 + random.below(8)).map(|_| (b'a' + random.below(26) as u8) as char).collect();
    format!("zz{letters}")
}

/// Inserts a line before a line of a text, but for the first, and not into a continued line.
fn with_line(text: &str, line: &str, random: &mut Random) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let mut at = 1 + random.below(lines.len());
    while lines[at - 1].ends_with('\\') && at < lines.len() {
        at += 1;
    }
    lines.insert(at, line);
    lines.join("\n") + "\n"
}

fn to_toml(text: &str, random: &mut Random) -> Addition {
    let mut scene = toml::Value::Table(text.parse().unwrap());
    if random.below(8) == 0 {
        let text = toml::to_string(&scene).unwrap();
        return Addition::without_effect(with_line(&text, "# zz = 1", random), "a comment");
    }
    let value: toml::Value = match random.below(5) {
        0 => 1.into(),
        1 => 0.5.into(),
        2 => "tile.png".into(),
        3 => true.into(),
        _ => vec![0.1, 0.2, 0.3].into(),
    };
    let mut at = random.below(tables(&scene));
    let place = insert(&mut scene, &mut at, &name(random), &value, "").unwrap();
    Addition::told(toml::to_string(&scene).unwrap(), format!("a key in {place}"))
}

fn tables(value: &toml::Value) -> usize {
    match value {
        toml::Value::Table(table) => 1 + table.values().map(tables).sum::<usize>(),
        toml::Value::Array(values) => values.iter().map(tables).sum(),
        _ => 0,
    }
}

/// Inserts a key in table number `at`; returns the path of the table.
fn insert(
    to: &mut toml::Value,
    at: &mut usize,
    key: &str,
    value: &toml::Value,
    path: &str,
) -> Option<String> {
    match to {
        toml::Value::Table(table) if *at == 0 => {
            table.insert(key.to_owned(), value.clone());
            Some(format!("[{path}]"))
        }
        toml::Value::Table(table) => {
            *at -= 1;
            table.iter_mut().find_map(|(own, to)| insert(to, at, key, value, &format!("{path}.{own}")))
        }
        toml::Value::Array(values) => values.iter_mut().find_map(|to| insert(to, at, key, value, path)),
        _ => None,
    }
}

/// A triangle with a further property or element in any place, in any encoding.
fn ply(random: &mut Random) -> Addition {
    let encoding = *random.pick(&["ascii", "binary_little_endian", "binary_big_endian"]);
    let (own, line) = (name(random), random.below(3));
    let (is_list, place) =
        (random.below(2) == 0, *random.pick(&["vertex", "face", "element", "comment", "none"]));
    let property =
        if is_list { format!("property list uchar float {own}") } else { format!("property float {own}") };
    let mut values: Vec<Vec<u8>> = Vec::new();
    let mut put = |number: f64, is_byte: bool| {
        let mut bytes = if is_byte { vec![number as u8] } else { (number as f32).to_le_bytes().to_vec() };
        if encoding == "binary_big_endian" {
            bytes.reverse();
        }
        values.push(if encoding == "ascii" { format!("{number} ").into_bytes() } else { bytes });
    };
    let more = |put: &mut dyn FnMut(f64, bool)| {
        if is_list {
            put(2.0, true);
            put(0.25, false);
        }
        put(0.75, false);
    };
    let mut header = vec![format!("ply\nformat {encoding} 1.0")];
    let element = |put: &mut dyn FnMut(f64, bool), header: &mut Vec<String>, count: usize| {
        header.push(format!("element {own} {count}\n{property}"));
        (0..count).for_each(|_| more(put));
    };
    let count = random.below(3);
    if place == "element" && line == 0 {
        element(&mut put, &mut header, count);
    }
    header.push("element vertex 3".to_owned());
    let is_before = |of: &str| place == of && line == 0;
    let is_after = |of: &str| place == of && line > 0;
    let lines = |of: &str, known: &[&str], header: &mut Vec<String>| {
        let own = || property.clone();
        header.extend(is_before(of).then(own));
        header.extend(known.iter().map(|&line| line.to_owned()));
        header.extend(is_after(of).then(own));
    };
    lines("vertex", &["property float x", "property float y", "property float z"], &mut header);
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] {
        if is_before("vertex") {
            more(&mut put);
        }
        [x, y, 0.5].into_iter().for_each(|v| put(v, false));
        if is_after("vertex") {
            more(&mut put);
        }
    }
    if place == "comment" {
        header.push(format!("{} {property}", random.pick(&["comment", "obj_info"])));
    }
    header.push("element face 1".to_owned());
    lines("face", &["property list uchar uchar vertex_indices"], &mut header);
    if is_before("face") {
        more(&mut put);
    }
    [3.0, 0.0, 1.0, 2.0].into_iter().for_each(|v| put(v, true));
    if is_after("face") {
        more(&mut put);
    }
    if place == "element" && line > 0 {
        element(&mut put, &mut header, count);
    }
    let bytes = [header.join("\n").as_bytes(), b"\nend_header\n", &values.concat()].concat();
    match place {
        "comment" | "none" => Addition::without_effect(bytes, place),
        "element" if count == 0 => Addition::without_effect(bytes, "an element without number"),
        _ => Addition::told(bytes, format!("a property or element ({place}, {encoding}, list: {is_list})")),
    }
}

/// Colour of a picture before further layers.
pub const SKY: Rgb = Rgb::splat(0.5);

/// A picture with a further layer.
fn exr(random: &mut Random) -> Addition {
    let (own, kind) = (name(random), random.below(4));
    // Channels of all names stand behind those of the picture, so a name of the same length can be replaced.
    let known = format!("zz{}", "_".repeat(own.len() - 2));
    let template = layered(&known, kind);
    let mut bytes = template.clone();
    for (at, _) in template.windows(known.len()).enumerate().filter(|(_, run)| *run == known.as_bytes()) {
        bytes[at..at + own.len()].copy_from_slice(own.as_bytes());
    }
    Addition::without_effect(bytes, "a layer")
}

/// Returns the file of a picture with a layer of a kind. Each file is written once, since that waits for the disk.
fn layered(layer: &str, kind: usize) -> Vec<u8> {
    static FILES: Mutex<BTreeMap<(String, usize), Vec<u8>>> = Mutex::new(BTreeMap::new());
    let mut files = FILES.lock().unwrap();
    let write = || {
        let image = |value: f32| Image { width: 3, height: 2, pixels: vec![Rgb::splat(value); 6] };
        let mut film = Film::new(image(SKY.x));
        film.layers.push(match kind {
            0 => Layer::color(layer, image(2.0)),
            1 => Layer::vector(layer, image(2.0)),
            2 => Layer::scalar(layer, image(2.0).map(|pixel| pixel.x)),
            _ => Layer::id(layer, image(2.0).map(|_| 7)),
        });
        film.metadata.set("zz", "an attribute");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        write_exr(&path, &film).unwrap();
        fs::read(path).unwrap()
    };
    files.entry((layer.to_owned(), kind)).or_insert_with(write).clone()
}

fn to_lines(text: &str, random: &mut Random) -> Addition {
    if random.below(8) == 0 {
        return Addition::without_effect(with_line(text, "# zz 1", random), "a comment");
    }
    let values = *random.pick(&["", " 1", " 0.5 0.5 0.5", " -s 1 1 1 tile.png", " name"]);
    let line = format!("{}{values}", name(random));
    Addition::told(with_line(text, &line, random), "a keyword")
}

/// Defines a material of a library again, with or without a comment behind its name.
fn to_library(text: &str, random: &mut Random) -> Addition {
    let definitions: Vec<&str> = text.lines().filter(|line| line.starts_with("newmtl ")).collect();
    let definition = random.pick(&definitions);
    let comment = *random.pick(&["", " # again"]);
    // The last definition of a library counts, so all that was told is told yet.
    Addition::told(format!("{definition}{comment}\nKd 0.11 0.22 0.33\n{text}"), "a definition again")
}

/// Extensions that a warning names as a whole.
const NAMED_AS_A_WHOLE: [&str; 3] = ["KHR_materials_unlit", "KHR_materials_iridescence", "EXT_x"];

/// Adds to the JSON text of a model; files in other forms stay.
fn to_gltf(bytes: &[u8], random: &mut Random) -> Addition {
    let Ok(mut model) = serde_json::from_slice::<serde_json::Value>(bytes) else {
        return Addition::without_effect(bytes, "nothing");
    };
    let own = name(random);
    let mut pointers = Vec::new();
    collect(&model, String::new(), &mut pointers);
    let path = random.pick(&pointers).clone();
    let object = model.pointer_mut(&path).unwrap().as_object_mut().unwrap();
    let (is_told, kind) = match random.below(4) {
        _ if path.ends_with("/extensions") => {
            object.insert(format!("ZZ_{own}"), json!({ "factor": 0.5 }));
            (true, "an extension")
        }
        choice if path.ends_with("/attributes") => {
            // Names that begin with _ are those of applications.
            let is_own = choice < 2;
            // Draco streams may hold attributes that a primitive does not name.
            let is_of_draco = path.contains("draco");
            object.insert(format!("{}{}", if is_own { "_" } else { "" }, own.to_uppercase()), json!(0));
            (!is_own && !is_of_draco, "an attribute")
        }
        0 if !object.contains_key("extras") => {
            object.insert("extras".to_owned(), json!({ own: 1 }));
            (false, "extras")
        }
        1 if !object.contains_key("extensions") => {
            object.insert("extensions".to_owned(), json!({ format!("ZZ_{own}"): {} }));
            (true, "an extension")
        }
        _ => {
            object.insert(own, json!(0.5));
            (true, "a property")
        }
    };
    // An extension that is named as a whole hides its properties.
    let is_hidden = NAMED_AS_A_WHOLE.iter().any(|name| path.contains(name));
    let is_told = is_told && !is_hidden;
    // Numbers of array elements say nothing about the kind.
    let place: String = path.chars().filter(|c| !c.is_ascii_digit()).collect();
    Addition { bytes: serde_json::to_vec(&model).unwrap(), kind: format!("{kind} in {place}"), is_told }
}

/// Adds a key to a list of cameras or to one of its frames.
fn to_views(text: &str, random: &mut Random) -> Addition {
    let mut list: serde_json::Value = serde_json::from_str(text).unwrap();
    let path = *random.pick(&["", "/frames/0"]);
    let values = [
        json!(0.5),
        json!("tile.png"),
        json!(true),
        json!([0.1, 0.2]),
        json!({ "zz": 1 }),
        json!(0),
        json!(null),
    ];
    let at = random.below(values.len());
    list.pointer_mut(path).unwrap()[name(random)] = values[at].clone();
    let kind = format!("a key in \"{path}\": {}", values[at]);
    // Zero and null change nothing.
    Addition { bytes: serde_json::to_vec(&list).unwrap(), kind, is_told: at < 5 }
}

/// Collects the pointers to the objects of a JSON text, but for those of applications.
fn collect(value: &serde_json::Value, path: String, to: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(members) => {
            let others = members.iter().filter(|(key, _)| *key != "extras");
            others.for_each(|(key, value)| collect(value, format!("{path}/{key}"), to));
            to.push(path);
        }
        serde_json::Value::Array(values) => {
            values.iter().enumerate().for_each(|(i, value)| collect(value, format!("{path}/{i}"), to));
        }
        _ => {}
    }
}

/// Adds a child to an element of a scene of Mitsuba.
fn to_xml(text: &str, random: &mut Random) -> Addition {
    const PARENTS: [&str; 9] =
        ["<scene", "<shape", "<bsdf", "<emitter", "<sensor", "<film", "<sampler", "<integrator", "<texture"];
    // Ends of start tags that have children.
    let places: Vec<(usize, &str)> = PARENTS
        .iter()
        .flat_map(|parent| text.match_indices(parent))
        .filter_map(|(start, parent)| {
            let end = start + text[start..].find('>')?;
            let rest = &text[start + parent.len()..end];
            (rest.starts_with(' ') && !rest.ends_with('/')).then_some((end + 1, parent))
        })
        .collect();
    let (at, parent) = *random.pick(&places);
    let own = name(random);
    let (child, is_told) = match random.below(7) {
        0 => ("<!-- zz -->".to_owned(), false),
        1 => (format!("<float name=\"{own}\" value=\"0.5\"/>"), true),
        2 => (format!("<boolean name=\"{own}\" value=\"true\"/>"), true),
        3 => (format!("<string name=\"{own}\" value=\"x\"/>"), true),
        4 => (format!("<rgb name=\"{own}\" value=\"0.1, 0.2, 0.3\"/>"), true),
        // A BSDF that no shape has changes nothing.
        5 => (format!("<bsdf type=\"{own}\"/>"), parent != "<scene"),
        _ => (format!("<{own} name=\"a\" value=\"1\"/>"), true),
    };
    let kind =
        format!("{} in {parent}>", child.split([' ', '/']).next().unwrap_or_default().replace(&own, "zz"));
    Addition { bytes: [&text[..at], &child, &text[at..]].concat().into_bytes(), kind, is_told }
}
