use crate::{LoadOptions, Loaded, Severity, load};
use glam::{DVec3, Vec3};
use scene::{DeltaLight, Environment, Fresnel, Lobe, Reflectance, Roughness, Share, TextureId};
use std::fs;

const HEAD: &str = "resolution = [8, 4]\n[camera]\norigin = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 90\n";
const GREY: &str = "[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n";

/// Light that avoids the warning of a dark scene.
const SKY: &str = "[environment]\nradiance = [1.0, 1.0, 1.0]\n";

/// Loads the description, with the given files beside it.
fn load_with(text: &str, files: &[(&str, &[u8])]) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join("s.toml");
    fs::write(&path, text).unwrap();
    load(&path, &LoadOptions::default()).map_err(|e| e.to_string())
}

fn load_text(text: &str) -> Result<Loaded, String> {
    load_with(text, &[])
}

#[test]
fn materials_are_made_of_others() {
    let layered = "[[material]]\nname = \"both\"\nkind = \"blend\"\nfirst = \"wet\"\nsecond = \"steel\"\nweight = 0.3\n\
        [[material]]\nname = \"wet\"\nkind = \"coated\"\nbase = \"m\"\nior = 1.3\nspecular = 0.9\n\
        [[material]]\nname = \"steel\"\nkind = \"conductor\"\npreset = \"Cr\"\ntwo_sided = false\n\
        [[material]]\nname = \"hole\"\nkind = \"coated\"\nbase = \"steel\"\nalpha = 0.2\nopacity = 0.5\n";
    let loaded = load_text(&format!("{HEAD}{GREY}{layered}{SKY}")).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let [grey, both, wet, steel, hole] = &loaded.scene.materials[..] else { panic!() };
    assert_eq!((wet.diffuse, wet.coat.map(|coat| coat.eta)), (grey.diffuse, Some(1.3)));
    assert!(matches!(wet.lobes[..], [Lobe::Mirror { fresnel: Fresnel::Dielectric(1.3), .. }]));
    let blend = both.blend.as_ref().unwrap();
    assert_eq!((&both.lobes, both.coat, blend.weight), (&wet.lobes, wet.coat, 0.3.into()));
    assert_eq!(blend.other, *steel);
    assert_eq!((hole.two_sided, hole.opacity, hole.lobes.len()), (false, Some(0.5.into()), 2));
    for (wrong, message) in [
        ("kind = \"coated\"\nbase = \"x\"", "made of each other"),
        ("kind = \"blend\"\nfirst = \"m\"\nsecond = \"y\"", "\"y\""),
        ("kind = \"blend\"\nfirst = \"m\"", "name them"),
    ] {
        let error =
            load_text(&format!("{HEAD}{GREY}[[material]]\nname = \"x\"\n{wrong}\n{SKY}")).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn glass_absorbs_by_colour_and_distance() {
    let glass = |more: &str| {
        let text = format!(
            "material = [{{ name = \"g\", {more} }}]\n{HEAD}[[mesh]]\nshape = \"sphere\"\nmaterial = \"g\"\n{SKY}"
        );
        load_text(&text).map(|loaded| loaded.scene.materials[0].absorption)
    };
    let wine = "attenuation_colour = [0.5, 0.25, 1], attenuation_distance = 2";
    let sigma = Vec3::new(0.5f32.ln(), 0.25f32.ln(), 0.0) * -0.5;
    for kind in ["kind = \"glass\"", "kind = \"glass\", alpha = 0.2", "kind = \"principled\", spec_trans = 1"]
    {
        let found = glass(&format!("{kind}, {wine}")).unwrap().unwrap();
        assert!((found - sigma).abs().max_element() < 1e-6, "{found}");
        for nothing in ["attenuation_distance = 3", "attenuation_colour = 1"] {
            assert_eq!(glass(&format!("{kind}, {nothing}")), Ok(None));
        }
        assert!(glass(&format!("{kind}, attenuation_colour = 0")).unwrap().unwrap().is_finite());
    }
    for (wrong, message) in [
        ("kind = \"glass\", thin = true, attenuation_colour = 0.5", "leave out thin"),
        ("kind = \"glass\", attenuation_colour = 1.5", "from 0 to 1"),
        ("kind = \"glass\", attenuation_colour = 0.5, attenuation_distance = 0", "distance above 0"),
    ] {
        let error = glass(wrong).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn every_kind_of_material_light_and_step_is_read() {
    let text = r#"
        name = "all"
        max_depth = 5
        resolution = [8, 4]
        camera = { origin = [0, 0, 5], target = [0, 0, 0], fov = 90, fov_axis = "y" }
        material = [
            { name = "a", kind = "diffuse", reflectance = [0.1, 0.2, 0.3], two_sided = false },
            { name = "b", kind = "glossy", diffuse = 0.5, specular = 0.2, alpha = 0.3 },
            { name = "c", kind = "plastic", diffuse = 0.5 },
            { name = "d", kind = "roughplastic", diffuse = 0.5, alpha = 0.2, ior = 1.3, nonlinear = true },
            { name = "e", kind = "conductor", preset = "Au" },
            { name = "f", kind = "conductor", eta = [1, 1, 1], k = [2, 2, 2], alpha = 0.2, distribution = "beckmann" },
            { name = "g", kind = "mirror", reflectance = 0.9 },
            { name = "h", kind = "glass", ior = 1.6 },
        ]
        mesh = [
            { shape = "rectangle", material = "a", emission = [1, 2, 3], emission_two_sided = true, transform = [
                { scale = 2.0 }, { rotate = { axis = [1, 0, 0], angle = 90 } }, { translate = [0, 0, 1] },
                { matrix = [1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] },
            ] },
            { shape = "cube", material = "h" },
        ]
        light = [
            { kind = "point", position = [1, 2, 3], intensity = [4, 5, 6] },
            { kind = "spot", position = [0, 2, 0], target = [0, 0, 0], intensity = [1, 1, 1], inner_angle = 10, outer_angle = 30 },
            { kind = "directional", direction = [0, -2, 0], irradiance = [1, 1, 1] },
        ]
        environment = { radiance = [0.1, 0.2, 0.3] }
    "#;
    let loaded = load_text(text).unwrap();
    let (scene, camera) = (&loaded.scene, &loaded.cameras.still);
    assert_eq!((scene.name.as_str(), scene.max_depth, loaded.cameras.resolution), ("all", Some(5), [8, 4]));
    assert!((camera.tan_half_x - 2.0).abs() < 1e-6);
    assert_eq!(camera.right, Vec3::X);
    assert_eq!((camera.near, camera.far), (0.0, f32::INFINITY));
    assert_eq!(scene.materials.len(), 8);
    assert!(!scene.materials[0].two_sided && scene.materials[1].two_sided);
    assert!(matches!(scene.materials[3].coat, Some(c) if c.eta == 1.3 && c.nonlinear));
    assert!(matches!(
        scene.materials[4].lobes[..],
        [Lobe::Mirror { fresnel: Fresnel::Conductor { .. }, .. }]
    ));
    assert!(matches!(scene.materials[5].lobes[..], [Lobe::Rough { alpha: Roughness::Constant(0.2), .. }]));
    assert!(matches!(scene.materials[7].lobes[..], [Lobe::Dielectric { eta: 1.6, .. }]));
    // Scaled, then laid down facing -y, then moved by 1 along z and 10 along x.
    let corner = scene.meshes[0].positions[0].as_dvec3() + scene.centre;
    assert!((corner - DVec3::new(8.0, 0.0, -1.0)).length() < 1e-5, "{corner}");
    assert!((scene.meshes[0].normals[0] - Vec3::NEG_Y).length() < 1e-6);
    assert!(scene.meshes[0].emission.unwrap().two_sided);
    let DeltaLight::Point { position, .. } = scene.lights[0] else { panic!() };
    assert!((position.as_dvec3() + scene.centre - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-5);
    assert!(matches!(scene.lights[1], DeltaLight::Spot { direction, .. } if direction == Vec3::NEG_Y));
    assert!(matches!(scene.lights[2], DeltaLight::Directional { direction, .. } if direction == Vec3::NEG_Y));
    assert!(matches!(scene.environment, Some(Environment::Constant(r)) if r == Vec3::new(0.1, 0.2, 0.3)));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert!(scene.focuses_lights());
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let cases = [
        ("colour = 3\n".to_string(), 1, "correct the key"),
        ("name = 3\n".to_string(), 1, "name: invalid type"),
        ("[[material]]\nname = \"m\"\n".to_string(), 1, "missing field `kind`; add it"),
        (HEAD.replace("fov = 90", "fov = 190"), 2, "fov"),
        (HEAD.replace("target = [0, 0, 0]", "target = [0, 0, 5]"), 2, "looks nowhere"),
        (HEAD.replace("resolution = [8, 4]", "resolution = [8, 0]"), 1, "resolution"),
        (format!("{HEAD}[[material]]\nname = \"m\"\nkind = \"felt\"\n"), 6, "\"felt\""),
        (format!("{HEAD}[[material]]\nname = \"m\"\nkind = \"mirror\"\nalpha = 0.1\n"), 6, "alpha"),
        (
            format!("{HEAD}[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = [0, -1, 0]\n"),
            6,
            "negative",
        ),
        (
            format!("{HEAD}[[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = nan\n"),
            9,
            "expected a number",
        ),
        (format!("{HEAD}[[material]]\nname = \"m\"\nkind = \"conductor\"\npreset = \"Xx\"\n"), 6, "\"Xx\""),
        (format!("{HEAD}{GREY}{GREY}"), 10, "two materials"),
        (format!("{HEAD}[[mesh]]\nshape = \"cube\"\nmaterial = \"n\"\n"), 8, "\"n\""),
        (format!("{HEAD}{GREY}[[mesh]]\nshape = \"cone\"\nmaterial = \"m\"\n"), 10, "\"cone\""),
        (format!("{HEAD}{GREY}[[mesh]]\nmaterial = \"m\"\n"), 10, "part, file or shape"),
        (format!("{HEAD}{GREY}[[mesh]]\nfile = \"no.obj\"\nmaterial = \"m\"\n"), 10, "no.obj"),
        (format!("{HEAD}[[light]]\nkind = \"point\"\n"), 6, "lacks intensity"),
        (format!("generator = \"castle\"\n{HEAD}"), 1, "\"castle\""),
        (format!("{HEAD}[environment]\nscale = 2\n"), 6, "environment"),
        (format!("{HEAD}nonsense"), 6, "correct the file's syntax"),
    ];
    for (text, line, what) in cases {
        let message = load_text(&text).unwrap_err();
        assert!(message.contains(&format!("s.toml:{line}:")) && message.contains(what), "{message}\n{text}");
    }
}

#[test]
fn numbers_without_a_sense_are_refused_with_their_line() {
    let material = |line: &str| format!("{HEAD}[[material]]\nname = \"m\"\n{line}\n");
    let step = |step: &str| {
        format!("{HEAD}{GREY}[[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\ntransform = [{step}]\n")
    };
    let sky = |line: &str| format!("{HEAD}[environment]\nfile = \"tile.png\"\n{line}\n");
    let cases = [
        // These have too many numbers.
        (HEAD.replace("[8, 4]", "[8, 4, 2]"), 1, "resolution: expected an array of length 2"),
        (HEAD.replace("origin = [0, 0, 5]", "origin = [0, 0, 5, 1]"), 3, "length 3"),
        (step("{ translate = [1, 2, 3, 4] }"), 13, "length 3"),
        (step("{ matrix = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1, 7] }"), 13, "length 16"),
        (step("{ scale = [1, 2, 3, 4] }"), 13, "[x, y, z]"),
        (format!("{HEAD}[sky]\ndate = 2024-06-21T12:00:00Z\nplace = [50, 10, 3]\n"), 8, "length 2"),
        // These are not finite, or not in the range of f32.
        (HEAD.replace("origin = [0, 0, 5]", "origin = [0, 0, 1e39]"), 3, "3.4e38"),
        (format!("{HEAD}[[light]]\nkind = \"point\"\nposition = [0, inf, 0]\n"), 8, "3.4e38"),
        (step("{ rotate = { axis = [1, 0, 0], angle = nan } }"), 13, "3.4e38"),
        (sky("rotate_y = nan"), 8, "3.4e38"),
        (sky("rotate_y = inf"), 8, "3.4e38"),
        (sky("scale = nan"), 8, "3.4e38"),
        (sky("scale = 1e39"), 8, "3.4e38"),
        (sky("scale = -1"), 6, "scale is -1"),
        (
            material("kind = \"diffuse\"\nreflectance = { file = \"tile.png\", tiles = [nan, 1] }"),
            9,
            "expected",
        ),
        (
            material("kind = \"diffuse\"\nreflectance = { file = \"tile.png\", tiles = [inf, 1] }"),
            9,
            "expected",
        ),
        (material("kind = \"conductor\"\neta = 1\nk = [nan, 1, 1]"), 10, "expected"),
        // No material has these numbers.
        (material("kind = \"conductor\"\neta = 1\nk = -1"), 6, "out of range"),
        (material("kind = \"conductor\"\neta = 1e30\nk = 1"), 6, "out of range"),
        (format!("max_depth = 0\n{HEAD}"), 1, "max_depth is 0"),
    ];
    let tile = fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/scenes/valid/tile.png")).unwrap();
    for (text, line, what) in cases {
        let message = load_with(&text, &[("tile.png", &tile)]).unwrap_err();
        assert!(message.contains(&format!("s.toml:{line}:")) && message.contains(what), "{message}\n{text}");
    }
}

#[test]
fn an_image_that_its_factor_makes_infinite_is_an_error() {
    let sky = fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/scenes/valid/sky.exr")).unwrap();
    let text = format!("{HEAD}[environment]\nfile = \"sky.exr\"\nscale = 3e38\n");
    let message = load_with(&text, &[("sky.exr", &sky)]).unwrap_err();
    assert!(message.contains("s.toml:6:") && message.contains("finite"), "{message}");
}

#[test]
fn a_mesh_file_in_which_nothing_is_found_is_warned_of_and_an_error_under_strict() {
    let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let points = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let files = [
        ("a.stl", b"solid nothing\nendsolid nothing\n".to_vec()),
        ("b.obj", b"v 0 0 0\n".to_vec()),
        ("c.obj", (0..=255).collect()),
        ("d.ply", format!("ply\nformat ascii 1.0\n{vertices}{points}").into_bytes()),
        ("e.ply", format!("ply\nformat ascii 1.0\n{vertices}{strips}{points}3 0 1 2\n").into_bytes()),
    ];
    for (name, bytes) in &files {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        fs::write(folder.path().join(name), bytes).unwrap();
        let mesh = format!("[[mesh]]\nfile = \"{name}\"\nmaterial = \"m\"\n");
        fs::write(&path, format!("{HEAD}{GREY}{mesh}{SKY}")).unwrap();
        let loaded = load(&path, &LoadOptions::default()).unwrap();
        let [warning, more @ ..] = &loaded.warnings[..] else { panic!("{name}: no warning") };
        // Strips are named besides.
        assert_eq!(more.len(), usize::from(*name == "e.ply"), "{more:?}");
        assert!(more.iter().all(|more| more.what.contains("tristrips")), "{more:?}");
        assert!(warning.severity == Severity::Warning && warning.what.contains(name), "{warning}");
        let strict = load(&path, &LoadOptions { strict: true, ..LoadOptions::default() });
        assert!(strict.unwrap_err().to_string().contains("s.toml:10:"));
    }
}

#[test]
fn an_obj_brings_its_mtl_materials() {
    let obj =
        b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl shiny\nf 1 2 4\n\
        usemtl lost\nf 2 3 4\nusemtl brass\nf 3 4 1\nusemtl lamp\nf 4 1 2\n";
    let mtl = b"newmtl red\nKd 0.8 0.1 0.1\nKs 0 0 0\nillum 2\nnewmtl shiny\nKd 0.4 0.4 0.4\nKs 0.5 0.5 0.5\nNs 98\n\
        newmtl brass\nKs 0.9 0.7 0.4\nNs 98\nnewmtl lamp\nKe 9 8 7\nd 0.25\nnewmtl unused\nKd 1 1 1\nmap_bump x.png\n";
    let text = format!("{HEAD}[[mesh]]\nfile = \"a.obj\"\n");
    let loaded = load_with(&text, &[("a.obj", obj), ("a.mtl", mtl)]).unwrap();
    let scene = &loaded.scene;
    let names: Vec<&str> =
        scene.meshes.iter().map(|m| scene.materials[m.material.0 as usize].name.as_str()).collect();
    assert_eq!(names, ["red", "shiny", "default", "brass", "lamp"]);
    let material = |mesh: usize| &scene.materials[scene.meshes[mesh].material.0 as usize];
    let [Lobe::Rough { alpha: Roughness::Constant(alpha), fresnel: Fresnel::Dielectric(eta), .. }] =
        material(1).lobes[..]
    else {
        panic!()
    };
    assert!((alpha - (2.0f32 / 100.0).sqrt()).abs() < 1e-6);
    assert!((((eta - 1.0) / (eta + 1.0)).powi(2) - 0.08).abs() < 1e-6, "the most of dielectrics: {eta}");
    assert!(material(1).coat.is_some_and(|coat| coat.eta == eta));
    let [Lobe::Rough { fresnel: Fresnel::One, scale: Reflectance::Constant(scale), .. }] =
        material(3).lobes[..]
    else {
        panic!()
    };
    assert_eq!(scale, Vec3::new(0.9, 0.7, 0.4));
    let emission: Vec<Option<Vec3>> = scene.meshes.iter().map(|m| m.emission.map(|e| e.radiance)).collect();
    assert_eq!(emission, [None, None, None, None, Some(Vec3::new(9.0, 8.0, 7.0))]);
    assert_eq!((material(3).opacity, material(4).opacity), (None, Some(Share::Constant(0.25))));
    let [lost] = &loaded.warnings[..] else { panic!("{:?}", loaded.warnings) };
    assert!(
        lost.to_string().contains("not in its libraries: \"lost\"; a grey of 0.5 is used instead"),
        "{lost}"
    );
    assert_eq!(scene.sources.len(), 3);

    let lamp = format!(
        "{HEAD}[[mesh]]\nfile = \"b.obj\"\ngroup = \"lamp\"\nemission = 5\n\
        [[mesh]]\nfile = \"b.obj\"\nexcept = [\"lamp\", \"cat\"]\n"
    );
    let grouped =
        b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\no floor\nf 1 2 3\no lamp\nf 1 2 4\n";
    let scene = load_with(&lamp, &[("b.obj", grouped), ("a.mtl", mtl)]).unwrap().scene;
    let lit: Vec<bool> = scene.meshes.iter().map(|m| m.emission.is_some()).collect();
    assert_eq!((lit, scene.meshes[1].triangles.len()), (vec![true, false], 1));
    let message =
        load_with(&lamp.replace("\"lamp\"\ne", "\"lam\"\ne"), &[("b.obj", grouped), ("a.mtl", mtl)]);
    assert!(message.unwrap_err().contains("no object or group called \"lam\""));
}

#[test]
fn a_generator_yields_named_parts_and_unused_ones_are_reported() {
    let text =
        format!("generator = \"knot\"\n{HEAD}{GREY}{SKY}[[mesh]]\npart = \"knot\"\nmaterial = \"m\"\n");
    let loaded = load_text(&text).unwrap();
    assert_eq!(loaded.scene.meshes[0].name, "knot");
    assert_eq!(loaded.warnings.len(), 1);
    assert_eq!(loaded.warnings[0].severity, Severity::Warning);
    assert!(loaded.warnings[0].what.contains("floor"), "{}", loaded.warnings[0]);
}

#[test]
fn a_path_has_a_camera_for_every_frame() {
    let path = "[camera.path]\nframes = 5\nkeys = [{ origin = [0, 0, 5], target = [0, 0, 0] }, \
        { origin = [4, 0, 5], target = [4, 0, 0] }]\n";
    let loaded = load_text(&format!("{HEAD}{path}")).unwrap();
    let xs: Vec<f32> =
        loaded.cameras.path.iter().map(|c| c.origin.x + loaded.scene.centre.x as f32).collect();
    assert_eq!(xs.len(), 5);
    for (x, expected) in xs.iter().zip([0.0, 1.0, 2.0, 3.0, 4.0]) {
        assert!((x - expected).abs() < 1e-5, "{xs:?}");
    }
}

#[test]
fn keys_may_have_frames_fields_of_view_and_up_vectors() {
    let path = "[camera.path]\nkeys = [\n{ frame = 1, origin = [0, 0, 5], target = [0, 0, 0] },\n\
        { frame = 3, origin = [4, 0, 5], target = [4, 0, 0], fov = 30, up = [1, 0, 0] },\n\
        { frame = 9, origin = [5, 0, 5], target = [5, 0, 0] }]\n";
    let loaded = load_text(&format!("{HEAD}{path}")).unwrap();
    let cameras = &loaded.cameras.path;
    let x = |frame: usize| cameras[frame - 1].origin.x + loaded.scene.centre.x as f32;
    assert_eq!(cameras.len(), 9);
    for (frame, expected) in [(1, 0.0), (3, 4.0), (9, 5.0)] {
        assert!((x(frame) - expected).abs() < 1e-5, "{frame}");
    }
    assert!((cameras[2].tan_half_x - 15f32.to_radians().tan()).abs() < 1e-6);
    assert!((cameras[8].tan_half_x - 1.0).abs() < 1e-6 && cameras[1].tan_half_x < 1.0);
    assert!(cameras[2].up.distance(Vec3::X) < 1e-6 && cameras[8].up.distance(Vec3::Y) < 1e-6);
}

#[test]
fn wrong_paths_are_errors_with_line_and_remedy() {
    // The keys stand in lines 7 and 8.
    let error = |head: &str, first: &str, second: &str| {
        let key = |more: &str| format!("{{ origin = [0, 0, 5], target = [0, 0, 0]{more} }}");
        let path = format!("{HEAD}[camera.path]\n{head}keys = [{},\n{}]\n", key(first), key(second));
        load_text(&path).unwrap_err()
    };
    let assert_says = |error: String, parts: [&str; 3]| {
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    };
    assert_says(error("", "", ""), ["s.toml:6", "no number of frames", "`frame`"]);
    assert_says(error("", ", frame = 1", ""), ["s.toml:8", "no frame", "all a frame"]);
    assert_says(error("", ", frame = 0", ", frame = 2"), ["s.toml:7", "frame 0", "count from 1"]);
    assert_says(error("", ", frame = 5", ", frame = 5"), ["s.toml:8", "frame 5", "order"]);
    assert_says(error("", ", frame = 1, fov = 180", ", frame = 2"), ["s.toml:7", "fov", "0 to 180"]);
    assert_says(
        error("", ", frame = 1, up = [0, 0, 1]", ", frame = 2"),
        ["s.toml:7", "up vector", "turn up"],
    );
    assert_says(error("frames = 4\n", ", frame = 1", ", frame = 5"), ["s.toml:6", "frame 5", "more frames"]);
    assert_says(error("frames = 0\n", "", ""), ["s.toml:6", "0 frames", "at least one"]);
    assert_says(error("frames = 4\n", ", fram = 1", ""), ["s.toml:8", "fram", "expected"]);
}

#[test]
fn images_stand_upright_on_a_rectangle() {
    let mut png = std::io::Cursor::new(Vec::new());
    // White above, black below.
    let image = image::RgbImage::from_fn(2, 2, |_, y| image::Rgb([if y == 0 { 255 } else { 0 }; 3]));
    image.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let material = "[[material]]\nname = \"p\"\nkind = \"diffuse\"\nreflectance = { file = \"p.png\", wrap = \"clamp\" }\n";
    let rough = "[[material]]\nname = \"q\"\nkind = \"conductor\"\npreset = \"Au\"\nalpha = { file = \"p.png\", scale = 0.5 }\n";
    let text = format!("{HEAD}{material}{rough}[[mesh]]\nshape = \"rectangle\"\nmaterial = \"p\"\n");
    let loaded = load_with(&text, &[("p.png", png.get_ref())]).unwrap();
    let mesh = &loaded.scene.meshes[0];
    for (position, uv) in mesh.positions.iter().zip(&mesh.uvs) {
        let expected = if position.y > 0.0 { 1.0 } else { 0.0 };
        assert_eq!(loaded.scene.textures[0].lookup(*uv).x, expected, "{position}");
    }
    let [Lobe::Rough { alpha, .. }] = loaded.scene.materials[1].lobes[..] else { panic!() };
    assert_eq!(alpha, Roughness::Textured { texture: TextureId(1), scale: 0.5 });
}
