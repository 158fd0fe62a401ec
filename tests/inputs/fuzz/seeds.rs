//! Files that cases are made of: the corpus of valid scenes, and small files of every other format.

#[path = "../../../src/readers/gltf/tests/model.rs"]
mod model;
#[path = "../../../src/readers/gltf/tests/packed.rs"]
mod packed;
#[path = "../../../src/readers/gltf/tests/samples.rs"]
mod samples;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use image::codecs::png::PngEncoder;
use image::{DynamicImage, ImageEncoder, ImageFormat};
use lightsplat::film::{Film, Image, Layer, write_exr};
use lightsplat::math::Rgb;
use lightsplat::method::Method;
use lightsplat::progress::Control;
use lightsplat::readers::LoadOptions;
use lightsplat::session::{Goal, Session};
use lightsplat::view::{Framing, View};
use lightsplat::walk::{RetentionLimits, Walk};
use model::Model;
use moxcms::ColorProfile;
use serde_json::json;
use std::fs;
use std::io::{Cursor, Write};
use std::iter;
use std::path::{Path, PathBuf};

/// Bytes to change, and how they become a file.
pub struct Seed {
    /// Extension of the file, which tells its reader.
    pub extension: &'static str,
    pub bytes: Vec<u8>,
    pack: Box<dyn Fn(Vec<u8>) -> Vec<u8>>,
}

impl Seed {
    /// A file as it is.
    fn plain(extension: &'static str, bytes: impl Into<Vec<u8>>) -> Seed {
        Seed { extension, bytes: bytes.into(), pack: Box::new(|bytes| bytes) }
    }

    /// The file of changed bytes.
    pub fn pack(&self, bytes: Vec<u8>) -> Vec<u8> {
        (self.pack)(bytes)
    }
}

/// Folder of the corpus of a kind.
pub fn corpus(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(kind)
}

/// Files of the corpus whose names end so.
fn valid(extension: &'static str) -> Vec<Seed> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(corpus("valid")).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    let right = |path: &PathBuf| path.extension().is_some_and(|own| own == extension);
    files
        .iter()
        .filter(|path| right(path))
        .map(|path| Seed::plain(extension, fs::read(path).unwrap()))
        .collect()
}

/// Lists of cameras of NeRF data sets.
const VIEWS: [&str; 2] = [
    r#"{ "camera_angle_x": 0.7, "frames": [{ "file_path": "./train/r_0", "rotation": 0.01, "transform_matrix":
        [[1, 0, 0, 0], [0, 0.8, -0.6, 2], [0, 0.6, 0.8, 3], [0, 0, 0, 1]] }] }"#,
    r#"{ "fl_x": 50, "fl_y": 40, "cx": 30.5, "cy": 20, "w": 64, "h": 48, "k1": 0.1, "camera_model": "OPENCV",
        "frames": [{ "file_path": "../a/b.png", "fl_x": 60, "transform_matrix":
        [[0, 0, 1, 1], [1, 0, 0, 2], [0, 1, 0, 3], [0, 0, 0, 1]] }] }"#,
];

/// Seeds of a target.
pub fn seeds_of(target: &str) -> Vec<Seed> {
    match target {
        "toml" => valid("toml"),
        "views" => VIEWS.iter().map(|list| Seed::plain("json", *list)).collect(),
        "xml" => valid("xml"),
        "obj" => valid("obj").into_iter().chain(vec![Seed::plain("obj", ALL_OF_OBJ)]).collect(),
        "mtl" => valid("mtl").into_iter().chain(vec![Seed::plain("mtl", ALL_OF_MTL)]).collect(),
        "ply" => valid("ply").into_iter().chain(vec![binary_ply(true), binary_ply(false)]).collect(),
        "stl" => vec![Seed::plain("stl", STL), Seed::plain("stl", FACET), binary_stl()],
        "serialized" => valid("serialized").into_iter().chain(vec![inflated(3), inflated(4)]).collect(),
        "gltf" => samples::all().into_iter().flat_map(|(_, model, _)| gltf(model)).collect(),
        "exr" => valid("exr").into_iter().chain(vec![layered_exr()]).collect(),
        "pictures" => valid("png").into_iter().chain(pictures()).collect(),
        "spectrum" => vec![Seed::plain("spd", "# nm\n400 0.1\n500 0.5, \n600, 0.7 # red\n700 0.2\n")],
        "records" => vec![Seed::plain("records", records())],
        "job" => vec![Seed::plain("job", JOB)],
        "picture" => {
            // As many of each format: of damaged models fewest load.
            let models = seeds_of("gltf");
            let as_many = |format| iter::repeat_with(move || seeds_of(format)).flatten().take(models.len());
            as_many("toml").chain(as_many("xml")).chain(seeds_of("gltf")).collect()
        }
        other => panic!("no target {other}"),
    }
}

const ALL_OF_OBJ: &str = "mtllib no.mtl roof.mtl my roof.mtl # both\nv 0 0 0 # a\nv 1 0 \\\n 0\nv 0 1 0 1\nv 0 0 1\n\
    vt 0 0\nvt 1 0\nvt 0 1 0\nvn 0 0 1\ns 1\no a b\ng c d # e\nusemtl slab # f\nf 1/1/1 2/2/1 \\\n 3/3/1 # g\n\
    l 1 2\np 1\ncurv 0 1 1 2\nusemtl none\nfo -4 -3 -1 -2\nf 1/1 2//1 4\nsurf 0 1 0 1 1\nend\nbevel on\nlod 3\n";

const ALL_OF_MTL: &str = "newmtl slab\nKd 0.6 0.6 0.5\nKe 1 2 3\nmap_Ke tile.png\nd 0.5\nmap_d tile.png\nillum 1\n\
    newmtl tiles\nKd 0\nKs 0.9 0.7 0.4\nNs 98\nNi 1.4\nTr 0.25\nillum 2\nmap_Kd -s 2 2 1 tile.png\nmap_bump x.png\n\
    newmtl mirror\nKs 1 1 1\nillum 3\nnewmtl glass\nNi 1.5\nTf 0.5 0.6 \\\n 0.7\nillum 7\n\
    newmtl brick # more\nKa 1 1 1\nKd 0.9 0.6 0.2\nKs 0.5\nPr 0.25\nPm 1\nPs 0.1\nPc 0.8\nPcr 0.03\naniso 0.5\n\
    anisor 0.2\nmap_Pr -imfchan g tile.png\nmap_Pm -mm 0.1 0.8 tile.png\nnorm -bm 0.5 tile.png\nillum 3\n\
    newmtl plaster\nKa 0.5 0.5 0.5\nKd 0.9 0.6 0.2\nKs 0.5\nNs 90\nillum 6\nd 0.5\nbump tile.png -s 2 -o 0.1 0.2\n\
    map_Ks -clamp on -t 1 1 1 tile.png\nmap_d -blendu off -blendv off tile.png\ndisp no.png\nKm 1\nKd xyz 1 1 1\n";

const STL: &str = "solid roof # of a house\n# two slopes\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   \
    vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   \
    vertex 1 1 0.5\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid roof\n";

const FACET: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
    endfacet\nendsolid a\n";

/// Triangles with colours of VisCAM.
fn binary_stl() -> Seed {
    let mut bytes = b"solid by an exporter".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for i in 0..4u8 {
        let x = f32::from(i);
        let numbers = [0.0, 0.0, 1.0, x, 0.25, 0.5, x + 1.0, 0.25, 0.5, x, 1.5, 0.75f32];
        numbers.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend((0x8000u16 | 0x1234 << i & 0x7FFF).to_le_bytes());
    }
    Seed::plain("stl", bytes)
}

/// Scenes that are not there: nothing is rendered.
const JOB: &str = "options = { spp = 8, resolution = \"64x32\", denoise = true, strict = false }\n\
    [[picture]]\nscene = \"none.toml\"\noutput = \"a.exr\"\nspp = 2\naccuracy = [0.5, 0.25]\n\
    [[picture]]\nscene = \"none.xml\"\noutput = \"b.##.exr\"\nframes = \"1-4\"\ndefine = [\"X=1\", \"Y=2\"]\n\
    [[picture]]\nscene = \"none.toml\"\noutput = \"c.exr\"\nmethod = \"path\"\ncrop = [1, 2, 3, 4]\nexposure = 1.5\n";

fn binary_ply(little: bool) -> Seed {
    let format = if little { "binary_little_endian" } else { "binary_big_endian" };
    let head = format!(
        "ply\nformat {format} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\n\
        property float u\nproperty float v\nelement face 2\nproperty list uchar int vertex_indices\nproperty short n\n\
        end_header\n"
    );
    let mut bytes = head.into_bytes();
    let mut put = |number: &[u8]| match little {
        true => bytes.extend(number),
        false => bytes.extend(number.iter().rev()),
    };
    for [x, y] in [[0.0f32, 0.0], [1.0, 0.0], [0.25, 0.25], [0.0, 1.0]] {
        [x, y].iter().for_each(|v| put(&v.to_le_bytes()));
        put(&0.5f64.to_le_bytes());
        [x, y].iter().for_each(|v| put(&v.to_le_bytes()));
    }
    // Polygons of other shapes would have other numbers of triangles.
    for corners in [[0i32, 1, 2], [0, 2, 3]] {
        put(&[3]);
        corners.iter().for_each(|i| put(&i.to_le_bytes()));
        put(&7i16.to_le_bytes());
    }
    Seed::plain("ply", bytes)
}

/// A square, to be changed before it is deflated.
fn inflated(version: u16) -> Seed {
    // With normals, texture coordinates, colours, in single precision.
    let mut mesh = 0x100Bu32.to_le_bytes().to_vec();
    if version == 4 {
        mesh.extend(b"square\0");
    }
    [4u64, 2].iter().for_each(|count| mesh.extend(count.to_le_bytes()));
    let mut put =
        |vectors: &[&[f32]]| vectors.iter().flat_map(|v| *v).for_each(|v| mesh.extend(v.to_le_bytes()));
    put(&[&[0.0, 0.0, 0.0], &[1.0, 0.0, 0.0], &[1.0, 1.0, 0.0], &[0.0, 1.0, 0.0]]);
    put(&[&[0.0, 0.0, 1.0][..]; 4]);
    put(&[&[0.0, 0.0], &[1.0, 0.0], &[1.0, 1.0], &[0.0, 1.0]]);
    put(&[&[1.0, 1.0, 1.0][..]; 4]);
    [0u32, 1, 2, 0, 2, 3].iter().for_each(|i| mesh.extend(i.to_le_bytes()));
    let pack = move |bytes: Vec<u8>| {
        let mut zlib = ZlibEncoder::new(Vec::new(), Compression::fast());
        zlib.write_all(&bytes).unwrap();
        let head = [0x041Cu16, version].map(u16::to_le_bytes).concat();
        let table = if version == 4 { 0u64.to_le_bytes().to_vec() } else { 0u32.to_le_bytes().to_vec() };
        [head, zlib.finish().unwrap(), table, 1u32.to_le_bytes().to_vec()].concat()
    };
    Seed { extension: "serialized", bytes: mesh, pack: Box::new(pack) }
}

/// A model as text, as a file, and its text alone with the rest as it is.
fn gltf(model: Model) -> Vec<Seed> {
    let glb = model.glb();
    let mut json = model.json.clone();
    let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&model.binary));
    json["buffers"] = json!([{ "byteLength": model.binary.len(), "uri": uri }]);
    let text = serde_json::to_string_pretty(&json).unwrap();
    let own = serde_json::to_string_pretty(&model.json).unwrap();
    let binary = model.binary;
    let pack = move |text: Vec<u8>| match serde_json::from_slice(&text) {
        Ok(json) => Model { json, binary: binary.clone() }.glb(),
        Err(_) => text,
    };
    let inner = Seed { extension: "glb", bytes: own.into_bytes(), pack: Box::new(pack) };
    vec![Seed::plain("glb", glb), Seed::plain("gltf", text), inner]
}

fn layered_exr() -> Seed {
    let image = |seed: u32| {
        let mut image = Image::new(6, 5);
        let texel = |i: usize| Rgb::splat((seed * (1 + i as u32) % 7) as f32);
        image.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = texel(i));
        image
    };
    let mut film = Film::new(image(3));
    film.layers.push(Layer::color("variance", image(5)));
    film.metadata.set("spp", 4.0);
    film.metadata.set("settings", "{\"seed\":1}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_exr(&path, &film).unwrap();
    Seed::plain("exr", fs::read(path).unwrap())
}

fn pictures() -> Vec<Seed> {
    let mut image = image::Rgb32FImage::new(8, 8);
    image.pixels_mut().enumerate().for_each(|(i, pixel)| pixel.0 = [0.1, 0.2, i as f32 / 32.0]);
    let image = DynamicImage::from(image);
    let formats = [
        ("png", ImageFormat::Png, DynamicImage::from(image.to_rgb16())),
        ("png", ImageFormat::Png, DynamicImage::from(image.to_luma_alpha8())),
        ("jpg", ImageFormat::Jpeg, DynamicImage::from(image.to_rgb8())),
        ("bmp", ImageFormat::Bmp, DynamicImage::from(image.to_rgb8())),
        ("tga", ImageFormat::Tga, DynamicImage::from(image.to_rgba8())),
        ("hdr", ImageFormat::Hdr, image.clone()),
    ];
    let seed = |(extension, format, image): (&'static str, ImageFormat, DynamicImage)| {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        Seed::plain(extension, bytes.into_inner())
    };
    let mut with_profile = Vec::new();
    let mut encoder = PngEncoder::new(&mut with_profile);
    encoder.set_icc_profile(ColorProfile::new_display_p3().encode().unwrap()).unwrap();
    image.to_rgb8().write_with_encoder(encoder).unwrap();
    formats.into_iter().map(seed).chain([Seed::plain("png", with_profile)]).collect()
}

/// Records of a frame of a walk.
fn records() -> Vec<u8> {
    let path = corpus("valid").join("everything.toml");
    let session = Session::open(&path, &LoadOptions::default()).unwrap().session;
    let mut method = Method::named("cache").unwrap();
    for (key, value) in [("spp", "1"), ("vpls", "64"), ("least_cell", "16")] {
        method.set(key, value).unwrap();
    }
    let goal = Goal { method, denoise: Some(false), ..Goal::default() };
    let framing = Framing { frame: Some(1), resolution: Some([24, 16]), crop: None };
    let view = View::new(&session.cameras, &framing).unwrap();
    let mut walk = Walk::new(&session, goal, RetentionLimits::default());
    walk.frame(&view, &Control::new()).unwrap();
    walk.save()
}
