mod errors;
mod films;
mod integrators;
mod projections;
mod statements;

use crate::{LoadOptions, Loaded, Severity, load};
use base::math::Rgb;
use glam::{DVec3, Vec3};
use scene::{
    DeltaLight, Distribution, Environment, Fresnel, Lobe, Material, PixelFilter, Projection, Reflectance,
    ReliefRules, Roughness, Share, TextureId,
};
use std::fs;

const SENSOR: &str = "<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/>\n\
    <film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"4\"/>\
    <rfilter type=\"box\"/></film></sensor>\n";

/// Light that avoids the warning of a dark scene.
const SKY: &str = "<emitter type=\"constant\"/>";

/// Loads a scene with the given files beside it. Line 4 of the scene is the first of `body`.
fn load_with(body: &str, files: &[(&str, &str)], strict: bool) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("s.xml");
    fs::write(&path, format!("<scene version=\"3.0.0\">{SENSOR}\n{body}\n</scene>")).unwrap();
    load(&path, &LoadOptions { strict, ..LoadOptions::default() }).map_err(|e| e.to_string())
}

fn load_body(body: &str) -> Result<Loaded, String> {
    load_with(body, &[], false)
}

fn bsdf(text: &str) -> (Material, usize) {
    let loaded = load_body(&format!("{SKY}<shape type=\"rectangle\">{text}</shape>")).unwrap();
    (loaded.scene.materials[0].clone(), loaded.warnings.len())
}

#[test]
fn defaults_are_mitsubas() {
    let (m, _) = bsdf("<bsdf type=\"roughplastic\"/>");
    assert!(matches!(m.coat, Some(c) if (c.eta - 1.49 / 1.000277).abs() < 1e-6 && !c.nonlinear));
    assert_eq!(m.diffuse, Reflectance::Constant(Rgb::splat(0.5)));
    assert!(matches!(
        m.lobes[..],
        [Lobe::Rough { distribution: Distribution::Beckmann, alpha: Roughness::Constant(0.1), .. }]
    ));
    assert!(!m.two_sided);
    let (m, _) = bsdf("<bsdf type=\"dielectric\"/>");
    let eta_of = |m: &Material, wanted| match m.lobes[..] {
        [Lobe::Dielectric { eta, thin, .. }] if thin == wanted => eta,
        _ => panic!("{m:?}"),
    };
    assert!((eta_of(&m, false) - 1.5046 / 1.000277).abs() < 1e-6);
    assert_eq!(eta_of(&bsdf("<bsdf type=\"thindielectric\"/>").0, true), eta_of(&m, false));
    assert_eq!(eta_of(&bsdf("<bsdf type=\"null\"/>").0, false), 1.0);
    let (m, _) = bsdf("<bsdf type=\"conductor\"/>");
    assert!(matches!(m.lobes[..], [Lobe::Mirror { fresnel: Fresnel::One, .. }]));
    let (m, _) = bsdf("<bsdf type=\"roughconductor\"><string name=\"material\" value=\"Cr\"/></bsdf>");
    let [Lobe::Rough { fresnel: Fresnel::Conductor { eta, k }, .. }] = m.lobes[..] else { panic!("{m:?}") };
    assert!((eta - Vec3::new(4.36967, 2.91651, 1.6549)).length() < 1e-4);
    assert!((k - Vec3::new(5.20655, 4.23131, 3.7547)).length() < 1e-4);
    let (m, _) = bsdf("");
    assert_eq!(m.diffuse, Reflectance::Constant(Rgb::splat(0.5)));
    let (m, _) = bsdf("<emitter type=\"area\"/>");
    assert_eq!(m.diffuse, Reflectance::Constant(Rgb::ZERO));
}

#[test]
fn the_old_spellings_mean_the_same() {
    let old = "<shape type=\"sphere\"><transform name=\"toWorld\"><lookAt origin=\"1,2,3\" target=\"1,2,9\" up=\"0,1,0\"/>\
        </transform><bsdf type=\"twosided\"><bsdf type=\"roughplastic\"><float name=\"intIOR\" value=\"1.7\"/>\
        <string name=\"extIOR\" value=\"vacuum\"/><srgb name=\"diffuseReflectance\" value=\"#808080\"/></bsdf></bsdf></shape>";
    let new = "<shape type=\"sphere\"><transform name=\"to_world\"><lookat origin=\"1,2,3\" target=\"1,2,9\" up=\"0,1,0\"/>\
        </transform><bsdf type=\"twosided\"><bsdf type=\"roughplastic\"><float name=\"int_ior\" value=\"1.7\"/>\
        <float name=\"ext_ior\" value=\"1\"/><rgb name=\"diffuse_reflectance\" value=\"0.215861\"/></bsdf></bsdf></shape>";
    let [old, new] = [old, new].map(|text| load_body(text).unwrap().scene);
    assert_eq!(old.meshes[0].positions, new.meshes[0].positions);
    assert_eq!(old.centre, new.centre);
    assert_eq!(
        (old.materials[0].coat, &old.materials[0].lobes),
        (new.materials[0].coat, &new.materials[0].lobes)
    );
    let [Reflectance::Constant(a), Reflectance::Constant(b)] =
        [old.materials[0].diffuse, new.materials[0].diffuse]
    else {
        panic!()
    };
    assert!((a - b).length() < 1e-5);
    assert!(old.materials[0].two_sided && new.materials[0].two_sided);
}

#[test]
fn fields_of_view_up_to_a_half_circle_are_read() {
    let sensor = SENSOR.replace("\"90\"", "\"179.99999\"");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    fs::write(&path, format!("<scene version=\"3.0.0\">{sensor}{SKY}</scene>")).unwrap();
    assert!(load(&path, &LoadOptions::default()).unwrap().cameras.still.tan_half_x > 1e7);
}

#[test]
fn defaults_includes_and_references_are_resolved() {
    let body = "<emitter type=\"constant\"/><default name=\"grey\" value=\"0.25\"/><include filename=\"mats.xml\"/>\
        <shape type=\"cube\"><ref id=\"m\"/></shape><shape type=\"rectangle\"><ref id=\"m\"/></shape>";
    let mats = "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"m\"><rgb name=\"reflectance\" value=\"$grey\"/></bsdf></scene>";
    let loaded = load_with(body, &[("mats.xml", mats)], true).unwrap();
    assert_eq!(loaded.scene.materials.len(), 1);
    assert_eq!(loaded.scene.materials[0].diffuse, Reflectance::Constant(Rgb::splat(0.25)));
    assert_eq!(loaded.scene.sources.len(), 2);
}

#[test]
fn lights_without_surface() {
    let body = "<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/><rgb name=\"intensity\" value=\"4\"/></emitter>\
        <emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"0,5,0\" target=\"0,0,0\" up=\"0,0,1\"/></transform>\
        <float name=\"cutoff_angle\" value=\"40\"/></emitter>\
        <emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-3\" z=\"0\"/></emitter>\
        <emitter type=\"constant\"><spectrum name=\"radiance\" value=\"2\"/></emitter>";
    let scene = load_body(body).unwrap().scene;
    let world = |p: Vec3| p.as_dvec3() + scene.centre;
    let DeltaLight::Point { position, intensity } = scene.lights[0] else { panic!() };
    assert_eq!((world(position), intensity), (DVec3::new(1.0, 2.0, 3.0), Rgb::splat(4.0)));
    let DeltaLight::Spot { position, direction, inner_angle, outer_angle, .. } = scene.lights[1] else {
        panic!()
    };
    assert_eq!((world(position), direction), (DVec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y));
    assert!(
        (inner_angle - 30f32.to_radians()).abs() < 1e-6 && (outer_angle - 40f32.to_radians()).abs() < 1e-6
    );
    assert!(matches!(scene.lights[2], DeltaLight::Directional { direction, .. } if direction == Vec3::NEG_Y));
    // A spectrum of equal energy is not white.
    let Some(Environment::Constant(radiance)) = scene.environment else { panic!() };
    assert!((radiance - Vec3::new(2.40959, 1.89658, 1.81783)).length() < 1e-4, "{radiance}");
}

#[test]
fn lights_of_one_number_are_grey_in_version_06() {
    let lights = "<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"2\"/></emitter>\
        <emitter type=\"point\"><spectrum name=\"intensity\" value=\"3\"/></emitter>\
        <shape type=\"rectangle\"><emitter type=\"area\"><spectrum name=\"radiance\" value=\"4\"/></emitter></shape>";
    let text = format!("<scene version=\"0.6.0\"><sensor type=\"perspective\"/>{lights}</scene>");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    std::fs::write(&path, text).unwrap();
    let scene = crate::load(&path, &crate::LoadOptions::default()).unwrap().scene;
    let Some(Environment::Constant(radiance)) = scene.environment else { panic!() };
    let DeltaLight::Point { intensity, .. } = scene.lights[0] else { panic!() };
    let area = scene.meshes[0].emission.unwrap().radiance;
    assert_eq!([radiance, intensity, area], [2.0, 3.0, 4.0].map(Rgb::splat));
}

#[test]
fn mirrored_and_flipped_shapes_face_along_their_normals() {
    let mirrored = "<transform name=\"to_world\"><scale x=\"-1\"/></transform>";
    let flipped = "<boolean name=\"flip_normals\" value=\"true\"/>";
    for (inside, front) in [(mirrored, Vec3::Z), (flipped, Vec3::NEG_Z), ("", Vec3::Z)] {
        let scene = load_body(&format!("<shape type=\"rectangle\">{inside}</shape>")).unwrap().scene;
        let [a, b, c] = scene.meshes[0].corners(0);
        assert_eq!((b - a).cross(c - a).normalize(), front, "{inside}");
        assert_eq!(scene.meshes[0].normals[0], front, "{inside}");
    }
}

#[test]
fn the_sensor_takes_every_axis_of_the_field_of_view() {
    for (width, height, axis, expected) in [
        (8, 4, "x", 1.0),
        (8, 4, "y", 2.0),
        (8, 4, "smaller", 2.0),
        (8, 4, "larger", 1.0),
        (4, 8, "smaller", 1.0),
        (4, 8, "larger", 0.5),
        (8, 4, "diagonal", 2.0 / 5f32.sqrt()),
    ] {
        let text = format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/>\
            <string name=\"fov_axis\" value=\"{axis}\"/><film type=\"hdrfilm\"><integer name=\"width\" value=\"{width}\"/>\
            <integer name=\"height\" value=\"{height}\"/></film></sensor></scene>"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.xml");
        fs::write(&path, text).unwrap();
        let camera = load(&path, &LoadOptions::default()).unwrap().cameras.still;
        assert!((camera.tan_half_x - expected).abs() < 1e-6, "{axis} {width} {}", camera.tan_half_x);
        assert_eq!((camera.forward, camera.right, camera.up), (Vec3::Z, Vec3::NEG_X, Vec3::Y));
    }
}

#[test]
fn a_sensor_that_shears_is_straightened_with_a_warning() {
    let sensor = |first_row: &str| {
        let text = format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"><transform name=\"to_world\"><matrix \
            value=\"{first_row} 0 1 0 0 0 0 1 0 0 0 0 1\"/></transform></sensor></scene>"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.xml");
        fs::write(&path, text).unwrap();
        load(&path, &LoadOptions::default())
    };
    let loaded = sensor("1 0.02 0 0").unwrap();
    let camera = loaded.cameras.still;
    assert!(camera.right.dot(camera.up).abs() < 1e-6 && camera.forward == Vec3::Z, "{camera:?}");
    assert!(
        loaded.warnings.iter().any(|warning| warning.to_string().contains("shears")),
        "{:?}",
        loaded.warnings
    );
}

#[test]
fn a_scale_of_0_changes_no_sensor_and_no_lamp() {
    let scene = |transform: &str| {
        let to_world = format!("<transform name=\"to_world\">{transform}</transform>");
        let text = format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\">{to_world}</sensor>\
            <sensor type=\"orthographic\" id=\"flat\">{to_world}</sensor>\
            <emitter type=\"spot\">{to_world}</emitter></scene>"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.xml");
        fs::write(&path, text).unwrap();
        ["", "flat"].map(|camera| {
            let camera = Some(camera.to_owned()).filter(|name| !name.is_empty());
            load(&path, &LoadOptions { camera, strict: true, ..LoadOptions::default() }).unwrap()
        })
    };
    let turned = "<rotate x=\"1\" angle=\"30\"/><translate x=\"2\"/>";
    let expected = scene(turned);
    for scale in ["value=\"0\"", "x=\"0\"", "y=\"0\"", "x=\"0\" z=\"0\""] {
        for (found, expected) in scene(&format!("<scale {scale}/>{turned}")).iter().zip(&expected) {
            assert_eq!(format!("{:?}", found.cameras), format!("{:?}", expected.cameras), "{scale}");
            assert_eq!(
                format!("{:?}", found.scene.lights),
                format!("{:?}", expected.scene.lights),
                "{scale}"
            );
            assert!(
                found.warnings.iter().any(|warning| warning.what.contains("has a scale of 0")),
                "{scale}"
            );
        }
    }
}

#[test]
fn parameters_and_sensors_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    let sensor = |id: &str, fov: &str| {
        format!("<sensor type=\"perspective\" id=\"{id}\"><float name=\"fov\" value=\"{fov}\"/></sensor>")
    };
    let text = format!(
        "<scene version=\"3.0.0\"><default name=\"fov\" value=\"90\"/>{SKY}{}{}{}</scene>",
        sensor("a", "$fov"),
        sensor("b", "60"),
        "<sensor type=\"perspective\"/>"
    );
    fs::write(&path, text).unwrap();
    let read = |camera: Option<&str>, parameters: &[(&str, &str)]| {
        let parameters = parameters.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect();
        load(&path, &LoadOptions { camera: camera.map(str::to_owned), parameters, ..LoadOptions::default() })
    };
    let fov = |loaded: Loaded| 2.0 * loaded.cameras.still.tan_half_x.atan().to_degrees();
    let near = |a: f32, b: f32| (a - b).abs() < 1e-3;
    let first = read(None, &[]).unwrap();
    let hash = first.hash;
    assert!(first.warnings.len() == 1 && first.warnings[0].what.contains("1 (a), 2 (b), 3"));
    assert!(near(fov(first), 90.0));
    let turned = read(None, &[("fov", "30")]).unwrap();
    assert!(turned.hash != hash && near(fov(turned), 30.0));
    assert!(near(fov(read(Some("b"), &[]).unwrap()), 60.0) && near(fov(read(Some("2"), &[]).unwrap()), 60.0));
    for (camera, parameters, what) in
        [(Some("4"), &[][..], "among 1 (a)"), (Some("0"), &[], "\"0\""), (None, &[("fow", "1")], "$fow")]
    {
        let message = read(camera, parameters).unwrap_err().to_string();
        assert!(message.contains(what), "{message}");
    }
}

#[test]
fn reflectances_above_one_are_clamped() {
    let body = "<shape type=\"cube\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"2 .5 .5\"/></bsdf></shape>";
    let loaded = load_body(&format!("{SKY}{body}")).unwrap();
    assert_eq!(loaded.scene.materials[0].diffuse, Reflectance::Constant(Rgb::new(1.0, 0.5, 0.5)));
    assert!(loaded.warnings[0].to_string().contains("exceeds 1"), "{:?}", loaded.warnings);
}

#[test]
fn sampled_spectra_become_colours_inline_and_from_files() {
    let body = |spectrum: &str| {
        format!(
            "{SKY}<shape type=\"cube\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" {spectrum}/></bsdf></shape>"
        )
    };
    let colour = |spectrum: &str, files: &[(&str, &str)]| {
        let loaded = load_with(&body(spectrum), files, true).unwrap();
        let Reflectance::Constant(colour) = loaded.scene.materials[0].diffuse else { panic!() };
        (colour, loaded.scene.sources.len())
    };
    let (inline, _) = colour("value=\"400:.2, 500:.3, 600:.8, 700:.6\"", &[]);
    assert!((inline - Vec3::new(0.871727, 0.510388, 0.212802)).length() < 2e-3, "{inline}");
    let file = "# a spectrum\n400 .2\n500 .3\n600 .8\n700 .6\n";
    assert_eq!(colour("filename=\"a.spd\"", &[("a.spd", file)]), (inline, 2));
    assert_eq!(colour("value=\".2, .4, .6\"", &[]).0, Vec3::new(0.2, 0.4, 0.6));
    let message = load_with(&body("filename=\"a.spd\""), &[("a.spd", "400 1\nx\n")], false).unwrap_err();
    assert!(message.contains("a.spd:2"), "{message}");
    assert!(load_body(&body("filename=\"none.spd\"")).unwrap_err().contains("none.spd"));
}

#[test]
fn instances_are_placed_copies_of_their_group() {
    let group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"><transform name=\"to_world\">\
        <translate x=\"1\"/></transform></shape><shape type=\"rectangle\"/></shape>";
    let instance = |transform: &str| {
        format!(
            "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">{transform}</transform></shape>"
        )
    };
    let body =
        format!("{SKY}{group}{}{}", instance("<scale value=\"2\"/>"), instance("<translate z=\"9\"/>"));
    let loaded = load_with(&body, &[], true).unwrap();
    let middle = |mesh: usize| {
        let positions = &loaded.scene.meshes[mesh].positions;
        positions.iter().map(|p| p.as_dvec3() + loaded.scene.centre).sum::<DVec3>() / positions.len() as f64
    };
    assert_eq!(loaded.scene.meshes.len(), 4);
    assert!((middle(0) - DVec3::new(2.0, 0.0, 0.0)).length() < 1e-5, "{}", middle(0));
    assert!((middle(2) - DVec3::new(1.0, 0.0, 9.0)).length() < 1e-5, "{}", middle(2));
    assert_eq!(loaded.scene.materials.len(), 1);
    assert!(loaded.warnings.is_empty() && loaded.scene.groups.is_empty(), "{:?}", loaded.warnings);
    let nested = "<shape type=\"shapegroup\" id=\"h\"><ref id=\"h\"/></shape>\
        <shape type=\"instance\"><ref id=\"h\"/></shape><shape type=\"merge\" id=\"m\"><ref id=\"m\"/></shape>";
    let message = load_body(nested).unwrap_err();
    assert!(message.contains("a group in a group"), "{message}");
    assert!(load_body("<shape type=\"instance\"/>").unwrap_err().contains("refer to one shapegroup"));
}

#[test]
fn lenses_parallel_projections_and_filters_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    let camera = |plugin: &str, inside: &str, film: &str| {
        let text = format!(
            "<scene version=\"3.0.0\">{SKY}<sensor type=\"{plugin}\">{inside}<film type=\"hdrfilm\">{film}</film></sensor></scene>"
        );
        fs::write(&path, text).unwrap();
        let loaded = load(&path, &LoadOptions::default()).unwrap();
        (loaded.cameras.still, loaded.warnings)
    };
    let lens = "<float name=\"aperture_radius\" value=\"0.1\"/><float name=\"focus_distance\" value=\"3\"/>";
    let (still, warnings) = camera("thinlens", lens, "<rfilter type=\"box\"/>");
    assert_eq!(still.projection, Projection::Lens { radius: 0.1, distance: 3.0 });
    assert!(still.filter == PixelFilter::Box && warnings.is_empty(), "{warnings:?}");
    let scaled = "<transform name=\"to_world\"><scale x=\"5\" y=\"5\"/></transform>";
    let (still, warnings) = camera("orthographic", scaled, "");
    assert_eq!((still.projection, still.tan_half_x), (Projection::Parallel, 5.0));
    assert!(still.filter == PixelFilter::GAUSSIAN && warnings.is_empty(), "{warnings:?}");
    let tent = "<rfilter type=\"tent\"><float name=\"radius\" value=\"1.5\"/></rfilter>";
    let (still, _) = camera("perspective", "", tent);
    assert_eq!((still.projection, still.filter), (Projection::Pinhole, PixelFilter::Tent { radius: 1.5 }));
    let (still, warnings) = camera("perspective", scaled, "<rfilter type=\"lanczos\"/>");
    assert_eq!(still.filter, PixelFilter::Lanczos);
    let what: Vec<&str> = warnings.iter().map(|w| w.what.as_str()).collect();
    assert!(matches!(what[..], [a] if a.contains("scales")), "{what:?}");
}

#[test]
fn checkerboards_of_numbers_have_their_squares_exchanged_in_version_3() {
    let board = |name: &str| {
        format!(
            "<texture type=\"checkerboard\" name=\"{name}\"><float name=\"color0\" value=\".7\"/>\
             <float name=\"color1\" value=\".1\"/></texture>"
        )
    };
    let (mask, colour) = (board("opacity"), board("reflectance"));
    let body = format!(
        "<shape type=\"rectangle\"><bsdf type=\"mask\">{mask}<bsdf type=\"diffuse\">{colour}</bsdf></bsdf></shape>"
    );
    let scene = load_body(&body).unwrap().scene;
    let material = scene.materials.iter().find(|material| material.opacity.is_some()).unwrap();
    let at_origin = |id: TextureId| scene.textures.by_id(id).unwrap().lookup(glam::Vec2::new(0.2, 0.8)).x;
    let found = [material.opacity.unwrap().texture(), material.diffuse.texture()];
    assert_eq!(found.map(|id| at_origin(id.unwrap())), [0.1, 0.7]);
}

#[test]
fn reliefs_mirror_and_shadow_unless_told_otherwise_in_version_3() {
    let off = |name: &str| format!("<boolean name=\"{name}\" value=\"false\"/>");
    for (parameters, mirrors, shadows) in [
        (String::new(), true, true),
        (off("flip_invalid_normals"), false, true),
        (off("use_shadowing_function"), true, false),
    ] {
        let map = "<texture type=\"checkerboard\" name=\"normalmap\"/><bsdf type=\"diffuse\"/>";
        let bsdf = format!("<bsdf type=\"normalmap\">{parameters}{map}</bsdf>");
        let loaded = load_body(&format!("<shape type=\"rectangle\">{bsdf}</shape>")).unwrap();
        let material = loaded.scene.materials.iter().find(|material| material.relief.is_some()).unwrap();
        assert_eq!(material.relief_rules, ReliefRules { mirrors, shadows }, "{parameters}");
    }
}
