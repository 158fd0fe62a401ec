//! Tests of materials of MTL files.

use super::options::options;
use super::source::statements;
use crate::statements::Fate;
use crate::{LoadOptions, Loaded, Severity, load};
use base::math::Rgb;
use glam::{Mat3, Vec2};
use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb as Pixel, RgbImage, Rgba, RgbaImage};
use scene::{
    Filter, Fresnel, Lobe, Material, Principled, Reflectance, Relief, Share, Texture, TextureId, Wrap,
};
use std::fs;
use std::io::Cursor;

const QUAD: &str = "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
    usemtl m\nf 1/1 2/2 3/3 4/4\n";

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Loads a square of the material `m`, whose statements are `mtl`. Images lie beside it.
fn load_material(mtl: &str, strict: bool, transform: &str) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("a.obj", QUAD.as_bytes());
    write("m.mtl", format!("newmtl m\n{mtl}\n").as_bytes());
    write("tile.png", &png(RgbImage::from_fn(2, 2, |x, y| Pixel([200, 40 * x as u8, 90 * y as u8]))));
    write("my tile.png", &png(GrayImage::from_fn(2, 1, |x, _| Luma([255 * x as u8]))));
    write("holes.png", &png(RgbaImage::from_fn(2, 1, |x, _| Rgba([10, 20, 30, 255 * x as u8]))));
    write("normals.png", &png(RgbImage::from_pixel(2, 2, Pixel([128, 128, 255]))));
    let text = format!(
        "resolution = [8, 4]\ncamera = {{ origin = [0, 0, 5], target = [0, 0, 0] }}\n\
         environment = {{ radiance = 1 }}\nmesh = [{{ file = \"a.obj\"{transform} }}]\n"
    );
    write("s.toml", text.as_bytes());
    load(&folder.path().join("s.toml"), &LoadOptions { strict, ..LoadOptions::default() })
        .map_err(|e| e.to_string())
}

fn loaded(mtl: &str) -> Loaded {
    load_material(mtl, false, "").unwrap_or_else(|e| panic!("{mtl}: {e}"))
}

fn warnings(loaded: &Loaded) -> Vec<String> {
    let of_weight = loaded.warnings.iter().filter(|warning| warning.severity == Severity::Warning);
    of_weight.map(|warning| warning.to_string()).collect()
}

/// Returns the material, which must need no warning.
fn material(mtl: &str) -> Material {
    let loaded = load_material(mtl, true, "").unwrap_or_else(|e| panic!("{mtl}: {e}"));
    loaded.scene.materials[loaded.scene.meshes[0].material.0 as usize].clone()
}

/// Adds `text` to statements. Those of its keywords are left out.
fn with(statements: &str, text: &str) -> String {
    let keyword = |line: &str| line.split(' ').next().unwrap_or_default().to_owned();
    let given: Vec<String> = text.lines().map(keyword).collect();
    let others = statements.lines().filter(|line| !given.contains(&keyword(line)));
    others.chain([text]).collect::<Vec<&str>>().join("\n")
}

#[test]
fn colours_of_0_to_255_are_coded_and_others_above_1_are_named() {
    let coded = |mtl: &str| {
        let loaded = loaded(mtl);
        let notes = loaded.warnings.iter().filter(|warning| warning.severity == Severity::Note);
        let notes: Vec<String> = notes.map(ToString::to_string).collect();
        (loaded.scene.materials[loaded.scene.meshes[0].material.0 as usize].diffuse, notes, warnings(&loaded))
    };
    let (colour, notes, said) = coded("Kd 255 0 188\nillum 1\nnewmtl other\nKd 1 2 3");
    let Reflectance::Constant(colour) = colour else { panic!() };
    assert!(colour.abs_diff_eq(Rgb::new(1.0, 0.0, 0.503), 1e-3) && said.is_empty(), "{colour} {said:?}");
    assert!(notes[0].contains("m.mtl:1: Kd: the colours are whole numbers up to 255"), "{notes:?}");
    for bright in ["Kd 2 0 0.5", "Kd 255 0.5 0", "Kd 2 0 0", "Kd 300 0 0"] {
        let (colour, notes, said) = coded(&format!("{bright}\nillum 1"));
        let Reflectance::Constant(colour) = colour else { panic!() };
        assert!(colour.x == 1.0 && colour.z < 1.0 && notes.is_empty(), "{bright}: {colour} {notes:?}");
        assert!(said[0].contains("exceeds 1; it is clamped to 1"), "{said:?}");
    }
    let (.., said) = coded("Kd 0 0 0\nKs 1.5 0 0\nNs 10");
    assert!(said[0].contains("exceeds 1; it is clamped to 1"), "{said:?}");
    assert_eq!(loaded("Ke 255 0 0").scene.meshes[0].emission.unwrap().radiance, Rgb::new(255.0, 0.0, 0.0));
}

fn principled(mtl: &str) -> Principled {
    *material(mtl).principled.unwrap_or_else(|| panic!("{mtl}"))
}

fn texture(mtl: &str) -> Texture {
    let scene = load_material(mtl, true, "").unwrap_or_else(|e| panic!("{mtl}: {e}")).scene;
    scene.textures.by_id(TextureId(0)).unwrap().clone()
}

#[test]
fn every_statement_and_option_is_read_or_named() {
    let value = |name: &str| match name {
        name if name.starts_with("map_") || matches!(name, "norm" | "bump" | "refl" | "disp" | "decal") => {
            "tile.png"
        }
        "illum" => "2",
        "Tf" => "1 1 1",
        "-clamp" | "-blendu" | "-blendv" | "-cc" => "on",
        "-imfchan" => "r",
        "-type" => "sphere",
        _ => "0.5",
    };
    let of_statements = statements().iter().map(|s| (s, format!("{} {}", s.name, value(s.name))));
    let of_options = options().iter().map(|s| {
        let map = if matches!(s.name, "-bm" | "-imfchan") { "bump" } else { "map_Kd" };
        (s, format!("{map} {} {} tile.png", s.name, value(s.name)))
    });
    for (statement, text) in of_statements.chain(of_options).filter(|(s, _)| s.name != "newmtl") {
        let mtl = with("Kd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nNs 50", &text);
        let (said, strict) = (warnings(&loaded(&mtl)), load_material(&mtl, true, ""));
        let is_named = statement.fate == Fate::Named;
        assert_eq!((said.len(), strict.is_err()), (usize::from(is_named), is_named), "{text}: {said:?}");
        if is_named {
            assert!(said[0].contains(&format!(
                "m.mtl:5: {}",
                if text.starts_with("map_Kd") { "the option " } else { "" }
            )));
            assert!(said[0].contains(statement.name) && said[0].ends_with(statement.note), "{said:?}");
        }
    }
    let said = warnings(&loaded("Kd 0.5\nKm 0.3\nrefl -type sphere tile.png\nillum 12"));
    let named = ["unknown statement \"Km\"", "refl is not supported: \"m\"", "illum 12"];
    assert!(said.len() == 3 && named.iter().zip(&said).all(|(named, said)| said.contains(named)), "{said:?}");
}

/// Returns a few words about a material.
fn kind(mtl: &str) -> String {
    let material = material(mtl);
    let has_base = material.diffuse != Reflectance::BLACK;
    let lobe = match material.lobes[..] {
        _ if material.principled.is_some() => "principled",
        [] if has_base => "matte",
        [Lobe::Rough { fresnel: Fresnel::Dielectric(_), .. }] if material.coat.is_some() => "coat",
        [Lobe::Rough { fresnel: Fresnel::One, .. }] if !has_base => "metal",
        [Lobe::Mirror { .. }] if has_base => "mirror over base",
        [Lobe::Mirror { .. }] => "mirror",
        [Lobe::Dielectric { eta, thin: false, .. }] => return format!("glass {eta} {:?}", material.opacity),
        _ => panic!("{material:?}"),
    };
    match material.opacity {
        None => lobe.to_owned(),
        Some(Share::Constant(share)) => format!("{lobe} {share}"),
        Some(Share::Textured { .. }) => format!("{lobe} with holes"),
    }
}

#[test]
fn illumination_models_make_matte_glossy_mirroring_and_transparent_surfaces() {
    let coloured = "Kd 0.5 0.4 0.3\nKs 0.5 0.5 0.5\nNs 50";
    for (text, expected) in [
        ("illum 1", "matte"),
        ("illum 2", "coat"),
        ("illum 8", "coat"),
        ("illum 2\nd 0.4", "coat 0.4"),
        ("illum 3", "mirror over base"),
        ("illum 3\nKa 1 1 1", "principled"),
        ("illum 3\nKd 0.9 0.6 0.2", "metal"),
        ("illum 3\nKs 0", "matte"),
        ("illum 3\nKd 0", "mirror"),
        ("illum 5\nKa 1 1 1", "mirror over base"),
        // Blender writes 9 for transparent surfaces, and 6 for transparent metals.
        ("illum 9\nNi 1.45\nd 0.4", "coat 0.4"),
        ("illum 6\nNi 1.45\nd 0.4\nKa 1 1 1", "principled 0.4"),
        ("illum 4\nNi 1.45\nd 0.4", "coat 0.4"),
        ("illum 7\nNi 1.45\nd 0.4", "coat 0.4"),
        ("illum 9\nmap_d holes.png", "coat with holes"),
        // Maya writes 4, and its opacity as Tf.
        ("illum 4\nTf 1 1 1\nNi 1.00", "coat"),
        ("illum 4\nTf 0.25 0.25 0.25\nNi 1.00", "coat 0.25"),
        ("illum 4", "coat"),
        ("illum 4\nKd 0", "glass 1.5 None"),
        ("illum 9\nKd 0\nNi 1.3", "glass 1.3 None"),
        ("illum 7\nKd 0", "glass 1.5 None"),
        ("illum 7\nKd 0\nNi 1.3\nd 1", "glass 1.3 None"),
        ("illum 6\nKd 0\nNi 1.3\nTf 0.5 0.6 0.7", "glass 1.3 None"),
        ("illum 6\nKd 0\nNi 1\nTf 0.5 0.6 0.7", "glass 1 None"),
        ("illum 7\nNi 1", "coat"),
        ("Tr 0.25", "coat 0.75"),
        ("Tr 1\nd 1", "coat"),
        ("map_Kd\nmap_d # none", "coat"),
    ] {
        assert_eq!(kind(&with(coloured, text)), expected, "{text}");
    }
}

#[test]
fn glass_passes_tf_and_names_what_glass_cannot_have() {
    let clear = material("illum 7\nTf 0.5 0.6 0.7\nNi 1.4");
    let Lobe::Dielectric { eta, reflectance, transmittance, .. } = clear.lobes[0] else { panic!() };
    let white = Reflectance::Constant(Rgb::ONE);
    assert_eq!(
        (eta, reflectance, transmittance),
        (1.4, white, Reflectance::Constant(Rgb::new(0.5, 0.6, 0.7)))
    );
    for (text, named) in [
        ("illum 7\nKd 0.8", "Kd of glass"),
        ("illum 7\nNi 1.4\nTf 1 1 1\nd 0.1", "d of glass"),
        ("illum 2\nKd 0.5\nTf 0.2 0.9 0.2", "Tf of a surface that is not glass"),
        ("illum 1\nKd 0.5\nmap_Ks tile.png", "map_Ks"),
        ("Kd 0.5\nd 1.5", "d of 1.5"),
        ("Kd 0.5\nPc 4", "Pc of 4"),
        ("Kd 0.5\nPr 0.5\nTf 0.2 0.9 0.2", "a coloured Tf"),
        ("Kd 0.5\nmap_d -imfchan z my tile.png", "-imfchan z"),
        ("Kd 0.5\nmap_Kd -imfchan r tile.png", "-imfchan"),
        ("Kd 0.5\nmap_Kd -bm 2 tile.png", "-bm"),
        ("Kd 0.5\nmap_Kd -blendu off tile.png", "-blendu"),
        ("Kd 0.5\nnorm normals.png\nbump tile.png", "bump beside norm"),
    ] {
        let said = warnings(&loaded(text));
        assert!(said.len() == 1 && said[0].contains(named), "{text}: {said:?}");
        assert!(load_material(text, true, "").is_err());
    }
    let invisible = loaded("Kd 0.5\nTr 1\nillum 1\nmap_Kd tile.png\nmap_Ka tile.png");
    let notes: Vec<&str> = invisible.warnings.iter().map(|warning| warning.what.as_str()).collect();
    assert!(notes.len() == 1 && notes[0].starts_with("Tr leaves nothing"), "{notes:?}");
    assert!(warnings(&invisible).is_empty());
}

#[test]
fn the_extension_makes_principled_materials_as_blender_writes_them() {
    let brass = principled(
        "Ns 250\nKa 1 1 1\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.5\nd 1\nillum 3\nKd 0.9 0.6 0.2\nPr 0.25\nPm 1\n\
         Ps 0\nPc 0.8\nPcr 0.03\naniso 0.5\nanisor 0.25",
    );
    assert_eq!(brass.base_color, Reflectance::Constant(Rgb::new(0.9, 0.6, 0.2)));
    assert_eq!((brass.metallic, brass.roughness), (Share::Constant(1.0), Share::Constant(0.25)));
    assert_eq!((brass.clearcoat, brass.sheen), (Share::Constant(0.8), Share::Constant(0.0)));
    assert!(brass.clearcoat_gloss == 1.0 && (brass.eta - 1.5).abs() < 1e-5, "{brass:?}");
    let satin = principled(
        "Kd 0.5
Pr 0.5
Pc 1
Pcr 0.2",
    );
    assert!((satin.clearcoat_gloss - (0.1 - 0.04) / 0.099).abs() < 1e-6, "{satin:?}");
    assert_eq!(brass.anisotropic, 0.5.into());
    assert!((brass.anisotropic_rotation - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    // Without the extension, Ka is the share of metal and Ns the roughness.
    let plain =
        principled("Ns 562.5\nKa 0.75 0.75 0.75\nKs 0.5 0.5 0.5\nNi 1.5\nd 1\nillum 3\nKd 0.9 0.6 0.2");
    assert_eq!((plain.base_color, plain.metallic), (brass.base_color, Share::Constant(0.75)));
    assert!(matches!(plain.roughness, Share::Constant(r) if (r - 0.25).abs() < 1e-6), "{plain:?}");
    let glass = principled("Kd 0\nPr 0.2\nNi 1.4\nillum 7");
    assert_eq!((glass.spec_trans, glass.eta), (Share::Constant(1.0), 1.4));
    assert_eq!(glass.base_color, Reflectance::Constant(Rgb::ONE));
    let half = principled(
        "Kd 0.5\nPr 0.2\nNi 1.4\nTf 0.5 0.5 0.5\nmap_Pm my tile.png\nPm 0\nmap_Pr -imfchan g tile.png",
    );
    assert_eq!(half.spec_trans, Share::Constant(0.5));
    assert!(matches!(half.metallic, Share::Textured { scale: 1.0, .. }));
    assert!(matches!(half.roughness, Share::Textured { scale: 0.2, .. }));
}

#[test]
fn options_place_and_change_textures() {
    let at = |mtl: &str, uv: [f32; 2]| texture(mtl).lookup(Vec2::from(uv));
    let plain = |u: f32, v: f32| at("map_Kd tile.png", [u, v]);
    assert_eq!(at("map_Kd -s 4 2 1 tile.png", [0.3, 0.2]), plain(1.2, 0.4));
    assert_eq!(at("map_Kd tile.png -o 0.5 0.25 0 # moved", [0.3, 0.2]), plain(0.8, 0.45));
    let both = texture("map_Kd -o 0.5 -s 4 2 -clamp on -blendu off -blendv off tile.png");
    let expected = Mat3::from_translation(Vec2::new(0.5, 0.0)) * Mat3::from_scale(Vec2::new(4.0, 2.0));
    assert_eq!((both.to_uv, both.wrap, both.filter), (expected, Wrap::Clamp, Filter::Nearest));
    let levels = at("map_Kd -mm 0.25 0.5 my tile.png", [0.75, 0.5]);
    assert!((levels - Rgb::splat(0.75)).abs().max_element() < 1e-6, "{levels}");
    let dark = at("map_Kd -mm 0.25 0.5 my tile.png", [0.25, 0.5]);
    assert!((dark - Rgb::splat(0.25)).abs().max_element() < 1e-6, "{dark}");
}

#[test]
fn opacity_is_the_alpha_of_an_image_or_else_its_luminance() {
    for (map, expected) in [
        ("holes.png", [0.0, 1.0]),
        ("my tile.png", [0.0, 1.0]),
        ("-imfchan l holes.png", [20.0 / 255.0; 2]),
        ("-imfchan b holes.png", [30.0 / 255.0; 2]),
        ("-imfchan m holes.png", [0.0, 1.0]),
    ] {
        let texture = texture(&format!("d 0.5\nmap_d {map}"));
        let found = [0, 1].map(|x| base::math::luminance(texture.texels.get(x, 0)));
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.02), "{map}: {found:?}");
        let opacity = material(&format!("Kd 0.5\nd 0.5\nmap_d {map}")).opacity;
        assert!(matches!(opacity, Some(Share::Textured { scale: 0.5, .. })), "{opacity:?}");
    }
}

#[test]
fn reliefs_are_heights_in_the_files_unit_or_normals() {
    let relief = |mtl: &str, transform: &str| {
        let scene = load_material(&format!("Kd 0.5\n{mtl}"), true, transform).unwrap().scene;
        scene.materials[scene.meshes[0].material.0 as usize].relief.unwrap()
    };
    let heights = |scale| Relief::Heights { texture: TextureId(0), scale };
    let normals = |strength| Relief::Normals { texture: TextureId(0), strength, y_along_v: true };
    assert_eq!(relief("bump my tile.png", ""), heights(1.0));
    assert_eq!(relief("map_Bump -bm 0.5 my tile.png", ", transform = [{ scale = 2.0 }]"), heights(1.0));
    assert_eq!(relief("map_Bump -bm 0.5 normals.png", ", transform = [{ scale = 2.0 }]"), normals(0.5));
    assert_eq!(relief("norm -bm 2 normals.png", ""), normals(2.0));
}
