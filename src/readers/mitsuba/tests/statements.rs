//! Every statement of the tables against the reader: statements that are read change the scene, those without effect do
//! not, and others are named.

use super::*;
use crate::mitsuba::statements::HEADINGS;
use crate::statements::{Fate, Statement, table};
use glam::{UVec3, Vec3};
use rayon::prelude::*;
use scene::{Cameras, Environment, Scene};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::mem;
use std::path::Path;

/// Files beside every scene.
const FILES: [(&str, &str); 5] = [
    (
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0\nvt 0 1\nvn 0 0 1\nvn 0 1 1\nvn 1 0 1\nf 1/1/1 2/2/2 3/3/3\n",
    ),
    ("b.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n"),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
        property float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 .25\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n",
    ),
    (
        "c.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float red\nproperty float green\nproperty float blue\nproperty float weight_0\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 .1\n3 0 0 0 1 0 .5\n0 1 0 0 0 1 .9\n3 0 1 2\n",
    ),
    (
        "b.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0\n0 1 0\n3 0 1 2\n",
    ),
];

/// Images beside every scene: name and texels of a row.
fn write_images(folder: &Path) {
    for (name, texels) in [("a.png", [0u8, 60, 200, 255]), ("b.png", [9, 80, 20, 5])] {
        image::GrayImage::from_raw(2, 2, texels.to_vec()).unwrap().save(folder.join(name)).unwrap();
    }
    for (name, value) in [("a.hdr", 1.0f32), ("b.hdr", 2.0)] {
        let texels = vec![image::Rgb([value, 0.5, 0.25]); 8];
        let file = fs::File::create(folder.join(name)).unwrap();
        image::codecs::hdr::HdrEncoder::new(file).encode(&texels, 4, 2).unwrap();
    }
}

/// Content that a plugin needs.
fn needed(tag: &str, plugin: &str) -> &'static str {
    match (tag, plugin) {
        ("shape", "obj") => "<string name=\"filename\" value=\"a.obj\"/>",
        ("shape", "ply") => "<string name=\"filename\" value=\"a.ply\"/>",
        ("shape", "instance") => "<ref id=\"g\"/>",
        ("shape", "merge" | "shapegroup") => "<shape type=\"cube\"/>",
        ("emitter", "envmap") => "<string name=\"filename\" value=\"a.hdr\"/>",
        ("emitter", "spot") => "<float name=\"cutoff_angle\" value=\"60\"/>",
        ("bsdf", "twosided" | "mask" | "coating" | "roughcoating") => "<bsdf type=\"diffuse\"/>",
        ("bsdf", "bumpmap" | "bump" | "normalmap") => {
            "<bsdf type=\"diffuse\"/><texture name=\"normalmap\" type=\"checkerboard\"/>"
        }
        ("bsdf", "blendbsdf") => "<bsdf type=\"diffuse\"/><bsdf type=\"conductor\"/>",
        ("bsdf", "mixturebsdf") => {
            "<string name=\"weights\" value=\".5 .2\"/><bsdf type=\"diffuse\"/><bsdf type=\"conductor\"/>"
        }
        ("sensor", "thinlens") => "<float name=\"aperture_radius\" value=\".1\"/>",
        ("texture", "bitmap") => "<string name=\"filename\" value=\"a.png\"/>",
        ("texture", "scale") => "<texture type=\"checkerboard\"/>",
        ("texture", "mesh_attribute") => "<string name=\"name\" value=\"vertex_color\"/>",
        ("texture", "rawconstant") => "<float name=\"value\" value=\".5\"/>",
        ("integrator", "aov" | "moment" | "stokes" | "multichannel" | "adaptive" | "irrcache") => {
            "<integrator type=\"path\"/>"
        }
        _ => "",
    }
}

/// Content with which alone a parameter has an effect.
fn companion(plugin: &str, parameter: &str) -> &'static str {
    match (plugin, parameter) {
        (_, "fov_axis") => "<float name=\"fov\" value=\"50\"/>",
        ("coating" | "roughcoating", "thickness") => "<rgb name=\"sigma_a\" value=\".1\"/>",
        ("principled", "sheen_tint") => {
            "<float name=\"sheen\" value=\".5\"/><rgb name=\"base_color\" value=\".2 .4 .6\"/>"
        }
        ("principledthin", "spec_tint") => {
            "<float name=\"spec_trans\" value=\".5\"/><rgb name=\"base_color\" value=\".2 .4 .6\"/>"
        }
        ("principled", "clearcoat_gloss") => "<float name=\"clearcoat\" value=\".5\"/>",
        (_, "k") => "<rgb name=\"eta\" value=\"2\"/>",
        ("conductor" | "roughconductor", "ext_eta") => "<string name=\"material\" value=\"Cr\"/>",
        _ => "",
    }
}

/// Values of a parameter to try.
fn values(parameter: &str) -> Vec<String> {
    let special: &[&str] = match parameter {
        "filename" => &["b.obj", "b.ply", "b.png", "b.hdr"],
        "material" => &["Ag"],
        "name" => &["vertex_weight"],
        "distribution" => &["ggx"],
        "fov_axis" => &["y"],
        "focal_length" => &["35mm"],
        "filter_type" => &["nearest"],
        "wrap_mode" => &["clamp"],
        "weights" => &[".1 .8"],
        "pixel_format" => &["luminance"],
        _ => &["x"],
    };
    let strings = special.iter().map(|value| format!("<string name=\"{parameter}\" value=\"{value}\"/>"));
    let elements = [
        ("float", "value=\".3\""),
        ("float", "value=\"1\""),
        ("float", "value=\"1.7\""),
        ("float", "value=\"20\""),
        ("float", "value=\"4000\""),
        ("integer", "value=\"1\""),
        ("integer", "value=\"3\""),
        ("integer", "value=\"2015\""),
        ("boolean", "value=\"true\""),
        ("boolean", "value=\"false\""),
        ("rgb", "value=\".3 .2 .1\""),
        ("point", "x=\"1\" y=\"2\" z=\"3\""),
    ];
    let plain = elements.iter().map(|(tag, value)| format!("<{tag} name=\"{parameter}\" {value}/>"));
    let others = [
        format!("<texture name=\"{parameter}\" type=\"checkerboard\"/>"),
        format!(
            "<texture name=\"{parameter}\" type=\"bitmap\"><string name=\"filename\" value=\"a.png\"/></texture>"
        ),
        format!("<transform name=\"{parameter}\"><rotate x=\"1\" angle=\"30\"/></transform>"),
        format!("<transform name=\"{parameter}\"><translate x=\"1\"/></transform>"),
        format!("<transform name=\"{parameter}\"><scale value=\".5\"/></transform>"),
        format!("<medium name=\"{parameter}\" type=\"homogeneous\"/>"),
    ];
    strings.chain(plain).chain(others).collect()
}

/// Content that a plugin needs, without the elements that have the name of one in `inside`.
fn needed_beside(tag: &str, plugin: &str, inside: &str) -> String {
    let name = |element: &str| {
        element.split("name=\"").nth(1).and_then(|rest| rest.split('"').next()).map(str::to_owned)
    };
    let given = name(inside);
    let elements = needed(tag, plugin).split_inclusive("/>");
    elements.filter(|element| given.is_none() || name(element) != given).collect()
}

/// Returns a scene with an object of a plugin and its content.
fn scene(tag: &str, plugin: &str, inside: &str) -> String {
    let needed = needed_beside(tag, plugin, inside);
    let object = |tag: &str| format!("<{tag} type=\"{plugin}\">{needed}{inside}</{tag}>");
    let size = |film: &str| {
        let number = |(name, value): (&str, u32)| match film.contains(&format!("\"{name}\"")) {
            true => String::new(),
            false => format!("<integer name=\"{name}\" value=\"{value}\"/>"),
        };
        let numbers = [("width", 8), ("height", 4), ("crop_width", 4), ("crop_height", 2)];
        numbers.map(number).concat() + film
    };
    let film = match tag {
        "film" => format!("<film type=\"{plugin}\">{}<rfilter type=\"box\"/></film>", size(inside)),
        "rfilter" => format!("<film type=\"hdrfilm\">{}{}</film>", size(""), object(tag)),
        _ => format!("<film type=\"hdrfilm\">{}<rfilter type=\"box\"/></film>", size("")),
    };
    let sensor = match tag {
        "sensor" => format!("<sensor type=\"{plugin}\">{needed}{inside}{film}</sensor>"),
        "sampler" => format!("<sensor type=\"perspective\">{}{film}</sensor>", object(tag)),
        _ => format!("<sensor type=\"perspective\">{film}</sensor>"),
    };
    let group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/></shape>";
    let shape = |content: &str| {
        format!(
            "<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/>{content}</shape>{}",
            if content.contains("emitter") { "" } else { SKY }
        )
    };
    let content = match tag {
        "shape" => {
            let textured =
                "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"checkerboard\"/></bsdf>";
            let inside = match plugin {
                "shapegroup" | "instance" | "merge" => String::new(),
                _ => textured.to_owned(),
            };
            object(tag).replace("</shape>", &format!("{inside}</shape>")) + SKY + group
        }
        "emitter" if plugin == "area" => shape(&object(tag)),
        "emitter" => object(tag) + "<emitter type=\"point\"/><shape type=\"cube\"/>",
        "bsdf" => shape(&object(tag)),
        // A black body is too bright for a reflectance.
        "texture" if plugin == "blackbody" => {
            let texture = object(tag).replace("<texture type", "<texture name=\"radiance\" type");
            shape(&format!("<emitter type=\"area\">{texture}</emitter>"))
        }
        "texture" => {
            let texture = object(tag).replace("<texture type", "<texture name=\"reflectance\" type");
            // Only the outer texture is the reflectance.
            let texture = texture.replace(
                "<texture name=\"reflectance\" type=\"checkerboard\"/>",
                "<texture type=\"checkerboard\"/>",
            );
            let shape = shape(&format!("<bsdf type=\"diffuse\">{texture}</bsdf>"));
            if plugin == "mesh_attribute" {
                shape.replacen("obj", "ply", 1).replace("a.obj", "c.ply")
            } else {
                shape
            }
        }
        "integrator" => shape("") + &object(tag),
        _ => shape(""),
    };
    format!("<scene version=\"3.0.0\">{sensor}{content}</scene>")
}

/// Scene and cameras as text, and the texts of warnings; the error if there is one.
fn outcome(path: &Path, text: &str) -> Result<(String, Vec<String>), String> {
    fs::write(path, text).unwrap();
    let loaded = load(path, &LoadOptions::default()).map_err(|error| error.to_string())?;
    let such = loaded.warnings.iter().filter(|warning| warning.severity == Severity::Warning);
    let warnings = such.map(|warning| warning.to_string()).collect();
    Ok((description(loaded.scene, &loaded.cameras), warnings))
}

/// Returns a scene and its cameras as text, and the hash of long lists of numbers, whose text would take long.
fn description(mut scene: Scene, cameras: &Cameras) -> String {
    let mut hash = DefaultHasher::new();
    let mut add =
        |vectors: Vec<Vec3>| vectors.iter().for_each(|v| v.to_array().map(f32::to_bits).hash(&mut hash));
    if let Some(Environment::Map(map)) = &mut scene.environment {
        add(mem::take(&mut map.radiance));
    }
    for mesh in &mut scene.meshes {
        add(mem::take(&mut mesh.positions));
        add(mem::take(&mut mesh.normals));
        add(mesh.uvs.drain(..).map(|uv| uv.extend(0.0)).collect());
        add(mesh.triangles.drain(..).map(|corners| UVec3::from(corners).as_vec3()).collect());
    }
    format!("{scene:?} {cameras:?} {:x}", hash.finish())
}

/// Says why a row of the table for `tag` is wrong; `None` if it is right. `path` is a scene beside the files.
fn problem(path: &Path, tag: &str, row: &Statement) -> Option<String> {
    let (plugin, parameter) = match row.name.split_once(": ") {
        Some((plugin, parameter)) => (plugin, Some(parameter)),
        None => (row.name, None),
    };
    let companion = parameter.map_or("", |parameter| companion(plugin, parameter));
    let base = outcome(path, &scene(tag, plugin, companion));
    let Some(parameter) = parameter else {
        let is_right = match (&base, row.fate) {
            (Err(_), fate) => fate == Fate::Refused,
            (Ok((_, warnings)), Fate::Named) => warnings.iter().any(|text| text.contains(plugin)),
            (Ok((_, warnings)), fate) => fate != Fate::Refused && warnings.is_empty(),
        };
        return (!is_right).then(|| format!("{tag} {}: {:?}", row.name, base.map(|(_, warnings)| warnings)));
    };
    let (before, known) = match base {
        Ok(base) => base,
        Err(error) => return Some(format!("{tag} {}: {error}", row.name)),
    };
    let of_plugin = format!("the {tag} \"{plugin}\" is not supported");
    let is_new = |warning: &String| !known.contains(warning) && !warning.contains(&of_plugin);
    // Whether the scene changes, and new warnings, for the values that are accepted.
    let texts = values(parameter);
    let mut outcomes = texts
        .iter()
        .filter_map(|value| outcome(path, &scene(tag, plugin, &format!("{companion}{value}"))).ok())
        .map(|(after, warnings)| (after != before, warnings.into_iter().filter(is_new).count()));
    let is_right = match row.fate {
        Fate::Read => outcomes.any(|outcome| outcome == (true, 0)),
        Fate::NoEffect => {
            let silent: Vec<bool> =
                outcomes.filter(|(_, warnings)| *warnings == 0).map(|(changes, _)| changes).collect();
            !silent.is_empty() && !silent.contains(&true)
        }
        Fate::Named => {
            let all: Vec<(bool, usize)> = outcomes.collect();
            all.iter().any(|(_, warnings)| *warnings > 0) && !all.contains(&(true, 0))
        }
        Fate::Refused => outcomes.next().is_none(),
    };
    (!is_right).then(|| format!("{tag} {}: is not {:?}", row.name, row.fate))
}

#[test]
fn statements_become_what_their_tables_say() {
    let folder = tempfile::tempdir().unwrap();
    FILES.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    write_images(folder.path());
    let rows = HEADINGS.iter().flat_map(|(tag, heading)| table(heading).iter().map(move |row| (*tag, row)));
    // Files of the format `serialized` are binary; the tests of meshes read one.
    let rows: Vec<(&str, &Statement)> = rows.filter(|(_, row)| !row.name.starts_with("serialized")).collect();
    let check = |(number, (tag, row)): (usize, &(&str, &Statement))| {
        problem(&folder.path().join(format!("{number}.xml")), tag, row)
    };
    let wrong: Vec<String> = rows.par_iter().enumerate().filter_map(check).collect();
    assert!(wrong.is_empty(), "{} rows:\n{}", wrong.len(), wrong.join("\n"));
}
