//! Tests of the page `docs/scene-format.md` against the code: keys, types, kinds and defaults.

use super::text::{
    AttributeText, CameraText, EnvironmentText, InstanceText, KeyText, LightText, MaterialText, MeshText,
    PathText, SceneText, SkyText, StepText, TextureText,
};
use crate::constants::conductor_names;
use crate::{LoadOptions, fnv1a, load};
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::path::Path;

const PAGE: &str = include_str!("../../../docs/scene-format.md");

/// A key of a table, as the page describes it.
#[derive(Clone, Debug)]
struct KeyRow {
    key: &'static str,
    kind: &'static str,
    default: &'static str,
}

/// Returns the tables of keys with their headings; tables of kinds are named `parent: kind`.
fn tables() -> Vec<(String, Vec<KeyRow>)> {
    let mut tables: Vec<(String, Vec<KeyRow>)> = Vec::new();
    let (mut parent, mut heading) = ("", String::new());
    for line in PAGE.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            parent = title;
            heading = title.to_owned();
        } else if let Some(title) = line.strip_prefix("### ") {
            heading = format!("{parent}: {title}");
        } else if line.starts_with("| key |") {
            tables.push((heading.clone(), Vec::new()));
        } else if let (Some(row), Some((_, rows))) = (line.strip_prefix("| `"), tables.last_mut()) {
            let cells: Vec<&str> = row.split('|').map(str::trim).collect();
            let [key, kind, _, default, ..] = cells[..] else { panic!("{line}") };
            rows.push(KeyRow { key: key.trim_end_matches('`'), kind, default });
        }
    }
    tables
}

fn table(heading: &str) -> Vec<KeyRow> {
    let found = tables().into_iter().find(|(name, _)| name == heading);
    found.unwrap_or_else(|| panic!("the page lacks {heading}")).1
}

/// Returns the kinds under a heading, and their tables.
fn kinds(heading: &str) -> Vec<(String, Vec<KeyRow>)> {
    let prefix = format!("{heading}: `kind = \"");
    let kind = |(name, rows): (String, Vec<KeyRow>)| {
        Some((name.strip_prefix(&prefix)?.trim_end_matches("\"`").to_owned(), rows))
    };
    tables().into_iter().filter_map(kind).collect()
}

fn keys(rows: &[KeyRow]) -> BTreeSet<String> {
    rows.iter().map(|row| row.key.to_owned()).collect()
}

/// Returns the keys of a table in the code, as its parser lists them.
fn known<T: DeserializeOwned>() -> BTreeSet<String> {
    let message = toml::from_str::<T>("zzz = 0").map(|_| ()).unwrap_err().message().to_owned();
    let (_, expected) = message.split_once("expected").unwrap();
    expected.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Returns values that a type of the page accepts, and values that it rejects.
fn values(kind: &str) -> (Vec<&'static str>, Vec<&'static str>) {
    let colours = vec!["0.5", "2", "[0.1, 0.2, 3]", "\"#ff8800\"", "{ colour = \"#ff8800\", scale = 9.0 }"];
    let images = vec!["\"a.png\"", "{ file = \"a.png\", tiles = [2, 2] }"];
    let attributes =
        vec!["{ attribute = \"color\" }", "{ attribute = \"vertex_a\", scale = 2, image = \"a.png\" }"];
    match kind {
        "text" => (vec![], vec!["1", "[1.0]"]),
        "name or names" => (vec!["\"a\"", "[\"a\", \"b\"]"], vec!["1", "[1]"]),
        "integer" => (vec!["2"], vec!["0.5", "\"x\"", "-1"]),
        "number" => (vec!["0.5", "2"], vec!["\"x\"", "true"]),
        "yes or no" => (vec!["true", "false"], vec!["1", "\"yes\""]),
        "vector" => (vec!["[1, 2.5, 3]"], vec!["1", "[1, 2]", "\"#ffffff\""]),
        "pair" => (vec!["[1, 2]"], vec!["1", "[1]"]),
        "colour" => (colours, vec!["true", "[1, 2]"]),
        "colour or image" => ([colours, images, attributes].concat(), vec!["true", "[1, 2]"]),
        "image" => (images, vec!["true", "0.5"]),
        "number or image" => ([vec!["0.5"], images, attributes].concat(), vec!["true", "[1, 2, 3]"]),
        "places" => (vec!["[[1,0,0,0, 0,1,0,0, 0,0,1,0]]", "\"a.txt\""], vec!["1", "[1]", "true"]),
        "moment" => (vec!["2024-06-21T12:00:00Z"], vec!["1", "\"noon\""]),
        "table" | "list of tables" | "list of numbers" => (vec![], vec!["true", "1"]),
        other => panic!("the page has no type \"{other}\""),
    }
}

/// Returns a value for a required key.
fn sample(row: &KeyRow) -> &'static str {
    match row.kind {
        _ if row.key == "target" => "[0, 0, 0]",
        "text" => "\"a.png\"",
        "list of tables" => "[{ origin = [0, 0, 5], target = [0, 0, 0] }]",
        kind => values(kind).0[0],
    }
}

/// Loads a scene with an image, a mesh and the material `m`; returns all its content as text.
fn outcome(text: &str) -> Result<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenes/valid");
    let own = tempfile::tempdir().unwrap();
    for (from, to) in [("tile.png", "a.png"), ("leaf.serialized", "leaf.serialized")] {
        std::fs::copy(folder.join(from), own.path().join(to)).unwrap();
    }
    let path = own.path().join("s.toml");
    std::fs::write(&path, text).unwrap();
    let loaded = load(&path, &LoadOptions::default()).map_err(|e| e.to_string())?;
    let sources = loaded.scene.sources.len();
    let scene = scene::Scene { sources: Vec::new(), ..loaded.scene };
    let text = format!("{scene:?} {:?} {sources}", loaded.cameras);
    // The texels of a sky are left out.
    Ok(if text.len() > 1 << 20 { format!("{:016x}", fnv1a(text.as_bytes())) } else { text })
}

/// Returns the scene of a template: `@` is replaced by the required keys of the table and `more`.
fn with(template: &str, rows: &[KeyRow], more: &str) -> String {
    let is_given = |row: &&KeyRow| row.default == "required" && !template.contains(&format!("{} =", row.key));
    let required = rows.iter().filter(is_given).map(|row| format!("{} = {}", row.key, sample(row)));
    let given: Vec<String> = required.chain((!more.is_empty()).then(|| more.to_owned())).collect();
    template.replace('@', &given.join(", "))
}

const MATERIAL: &str = "material = [{ name = \"m\", kind = \"diffuse\", reflectance = 0.5 }]\nmesh = [{ shape = \"cube\", material = \"m\" }]\n";

/// Returns the templates of tables without kinds.
fn templates() -> Vec<(&'static str, String)> {
    let of = |heading, text: &str| (heading, text.to_owned());
    vec![
        ("The file itself", format!("@\n{MATERIAL}")),
        ("`[camera]`", format!("camera = {{ @ }}\n{MATERIAL}")),
        ("`[camera.path]`", format!("camera = {{ path = {{ frames = 2, @ }} }}\n{MATERIAL}")),
        (
            "`[camera.path]`: `keys`",
            format!("camera = {{ path = {{ frames = 2, keys = [{{ @ }}] }} }}\n{MATERIAL}"),
        ),
        of(
            "`[[mesh]]`",
            "material = [{ name = \"m\", kind = \"diffuse\", reflectance = 0.5 }]\n\
            mesh = [{ file = \"leaf.serialized\", material = \"m\", @ }]",
        ),
        of("`[[material]]`", "material = [{ name = \"m\", kind = \"diffuse\", reflectance = 0.5, @ }]"),
        of("Images", "material = [{ name = \"m\", kind = \"diffuse\", reflectance = { @ } }]"),
        of("Attributes of meshes", "material = [{ name = \"m\", kind = \"diffuse\", reflectance = { @ } }]"),
        of("`[environment]`", "environment = { file = \"a.png\", @ }"),
        of("`[sky]`", "sky = { date = 2024-06-21T12:00:00Z, place = [50, 10], @ }"),
    ]
}

/// Returns the templates of every kind under a heading.
fn kind_templates(heading: &str, list: &str) -> Vec<(String, String, Vec<KeyRow>)> {
    let template = |(kind, rows): (String, Vec<KeyRow>)| {
        let name = if list == "material" { "name = \"m\", " } else { "" };
        let preset = if kind == "conductor" { "preset = \"Au\", " } else { "" };
        // The sample value of a text is also the name of a material.
        let other = match list {
            "material" => "{ name = \"a.png\", kind = \"mirror\" }, ",
            _ => "",
        };
        let text = format!("{list} = [{other}{{ {name}kind = \"{kind}\", {preset}@ }}]");
        (format!("{heading}: {kind}"), text, rows)
    };
    kinds(heading).into_iter().map(template).collect()
}

fn all_templates() -> Vec<(String, String, Vec<KeyRow>)> {
    let plain = templates().into_iter().map(|(heading, text)| (heading.to_owned(), text, table(heading)));
    let materials = kind_templates("`[[material]]`", "material");
    plain.chain(materials).chain(kind_templates("`[[light]]`", "light")).collect()
}

fn check_types<T: DeserializeOwned>(heading: &str, rows: &[KeyRow]) {
    let error = |row: &KeyRow, value: &str| {
        let parsed = toml::from_str::<T>(&format!("{} = {value}", row.key));
        parsed.err().map(|e| e.message().to_owned()).filter(|message| !message.contains("missing field"))
    };
    for row in rows {
        let (right, wrong) = values(row.kind);
        for value in right {
            assert_eq!(error(row, value), None, "{heading}: {} = {value}", row.key);
        }
        for value in wrong {
            assert!(error(row, value).is_some(), "{heading}: {} = {value}", row.key);
        }
    }
}

#[test]
fn the_page_lists_every_key_and_its_type() {
    fn check<T: DeserializeOwned>(heading: &str) {
        let rows = table(heading);
        assert_eq!(keys(&rows), known::<T>(), "{heading}");
        check_types::<T>(heading, &rows);
    }
    check::<SceneText>("The file itself");
    check::<CameraText>("`[camera]`");
    check::<PathText>("`[camera.path]`");
    check::<KeyText>("`[camera.path]`: `keys`");
    check::<MeshText>("`[[mesh]]`");
    check::<StepText>("`[[mesh]]`: `transform`");
    check::<InstanceText>("`[[instance]]`");
    check::<TextureText>("Images");
    check::<AttributeText>("Attributes of meshes");
    check::<EnvironmentText>("`[environment]`");
    check::<SkyText>("`[sky]`");
    for (kind, rows) in kinds("`[[material]]`") {
        check_types::<MaterialText>(&kind, &rows);
    }
    for (kind, rows) in kinds("`[[light]]`") {
        check_types::<LightText>(&kind, &rows);
    }
}

/// Asserts that each kind of a list accepts exactly the keys that the page gives it.
fn check_kinds<T: DeserializeOwned>(heading: &str, list: &str) {
    let common = keys(&table(heading));
    let all: Vec<(String, Vec<KeyRow>)> = kinds(heading);
    let described: BTreeSet<String> = all.iter().flat_map(|(_, rows)| keys(rows)).collect();
    assert_eq!(&described | &common, known::<T>(), "{heading}");
    let unknown = outcome(
        &format!("{list} = [{{ name = \"m\", kind = \"zzz\" }}]")
            .replace("name = \"m\", ", if list == "material" { "name = \"m\", " } else { "" }),
    );
    let unknown = unknown.unwrap_err();
    let (_, listed) = unknown.split_once("; use ").unwrap();
    let listed: BTreeSet<&str> = listed.split(", ").flat_map(|name| name.split(" or ")).collect();
    assert_eq!(listed, all.iter().map(|(kind, _)| kind.as_str()).collect(), "{heading}");
    for (name, template, rows) in kind_templates(heading, list) {
        for key in &described {
            let of_any = || all.iter().flat_map(|(_, rows)| rows).find(|row| row.key == *key).unwrap();
            let text = template.replace('@', &format!("{key} = {}", sample(of_any())));
            let is_refused = outcome(&text).is_err_and(|message| message.contains("has no effect on"));
            assert_eq!(is_refused, !keys(&rows).contains(key), "{name}: {key}");
        }
    }
}

#[test]
fn the_page_lists_every_kind_and_its_keys() {
    check_kinds::<MaterialText>("`[[material]]`", "material");
    check_kinds::<LightText>("`[[light]]`", "light");
    for preset in conductor_names().split(", ") {
        assert!(PAGE.contains(&format!("`\"{preset}\"`")), "{preset}");
    }
}

#[test]
fn the_defaults_of_the_page_are_those_of_the_code() {
    let mut checked = 0;
    for (name, template, rows) in all_templates() {
        let base = outcome(&with(&template, &rows, "")).unwrap_or_else(|e| panic!("{name}: {e}"));
        for row in &rows {
            let Some(default) = row.default.strip_prefix('`').and_then(|d| d.strip_suffix('`')) else {
                continue;
            };
            let given = with(&template, &rows, &format!("{} = {default}", row.key));
            assert_eq!(outcome(&given), Ok(base.clone()), "{name}: {}", row.key);
            checked += 1;
        }
    }
    assert!(checked >= 30, "{checked}");
}

#[test]
fn colours_are_the_same_everywhere_and_images_only_where_the_page_says() {
    for (name, template, rows) in all_templates() {
        for row in rows.iter().filter(|row| row.kind.starts_with("colour")) {
            let template = match row.key {
                "radiance" => template.replace("file = \"a.png\", ", ""),
                "eta" | "k" => {
                    template.replace("preset = \"Au\"", if row.key == "eta" { "k = 1" } else { "eta = 1" })
                }
                _ => template.clone(),
            };
            let others: Vec<KeyRow> = rows.iter().filter(|other| other.key != row.key).cloned().collect();
            let of = |value: &str| outcome(&with(&template, &others, &format!("{} = {value}", row.key)));
            let grey = of("0.25").unwrap_or_else(|e| panic!("{name}: {e}"));
            for same in ["[0.25, 0.25, 0.25]", "{ colour = \"#ffffff\", scale = 0.25 }"] {
                assert_eq!(of(same).as_ref(), Ok(&grey), "{name}: {} = {same}", row.key);
            }
            assert!(of("\"#ffff\"").unwrap_err().contains("#rrggbb"));
            let image = of("\"a.png\"");
            assert_eq!(image.is_ok(), row.kind == "colour or image", "{name}: {} {image:?}", row.key);
        }
    }
}

#[test]
fn the_tutorial_loads_by_itself() {
    let page = include_str!("../../../docs/first-scene.md");
    let (_, rest) = page.split_once("<!-- tutorial -->\n```toml\n").unwrap();
    let text = rest.split("```").next().unwrap();
    assert!(text.lines().filter(|line| !line.is_empty()).count() <= 20);
    outcome(text).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_examples_of_the_page_parse() {
    let blocks: Vec<&str> =
        PAGE.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(!blocks.is_empty());
    for block in blocks {
        toml::from_str::<SceneText>(block).unwrap_or_else(|e| panic!("{e}\n{block}"));
    }
}
