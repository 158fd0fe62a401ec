use super::*;
use crate::{LoadOptions, load};
use glam::{DVec3, Vec3};
use scene::Projection;
use std::fs;

/// Reads a list from a file of that name.
fn list(name: &str, text: &str) -> Result<ViewList, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    ViewList::read(&path, &LoadOptions::default())
}

fn nerf(text: &str) -> ViewList {
    list("transforms.json", text).unwrap()
}

fn cameras(list: &ViewList) -> Vec<SceneView> {
    list.in_scene(&Scene::default()).unwrap()
}

/// A camera at (1, 2, 3) that looks along -x, its up axis z.
const MATRIX: &str = "[[0, 0, 1, 1], [1, 0, 0, 2], [0, 1, 0, 3], [0, 0, 0, 1]]";

fn frames(intrinsics: &str, frame: &str) -> String {
    format!("{{ {intrinsics} \"frames\": [{{ {frame} \"transform_matrix\": {MATRIX} }}] }}")
}

#[test]
fn cameras_of_synthetic_data_sets_look_along_their_negative_z() {
    let found = nerf(&frames(
        "\"camera_angle_x\": 0.6911112070083618,",
        "\"file_path\": \"./train/r_0\", \"rotation\": 0.01,",
    ));
    let SceneView { camera, resolution } = cameras(&found)[0];
    assert_eq!((camera.origin, camera.forward), (Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_X));
    assert_eq!((camera.right, camera.up), (Vec3::Y, Vec3::Z));
    assert!((camera.tan_half_x - (0.5 * 0.691_111_2f32).tan()).abs() < 1e-6 && resolution.is_none());
    assert_eq!((camera.shift, camera.pixel_height, camera.projection), ([0.0; 2], 1.0, Projection::Pinhole));
    assert_eq!(found.file_names(), [Path::new("train/r_0")]);
    assert!(found.warnings().is_empty(), "{:?}", found.warnings());
}

#[test]
fn intrinsics_in_pixels_give_each_pixel_its_ray() {
    let shared = "\"fl_x\": 50, \"fl_y\": 40, \"cx\": 30.5, \"cy\": 20.25, \"w\": 64, \"h\": 48, \"camera_angle_x\": 2,";
    let own = "\"w\": 32, \"h\": 32, \"cx\": 16, \"cy\": 16, \"camera_angle_x\": 1.5707963267948966,";
    let text = format!(
        "{{ {shared} \"frames\": [{{ \"transform_matrix\": {MATRIX} }}, {{ {own} \"transform_matrix\": {MATRIX} }}] }}"
    );
    let found = cameras(&nerf(&text));
    let SceneView { camera, resolution } = found[0];
    assert_eq!(resolution, Some([64, 48]));
    for pixel in [[0.0, 0.0], [30.5, 20.25], [63.0, 11.0]] {
        let [x, y] = [(pixel[0] - 30.5) / 50.0, -(pixel[1] - 20.25) / 40.0];
        let expected = (Vec3::NEG_X + Vec3::Y * x + Vec3::Z * y).normalize();
        assert!((camera.direction(pixel, [64, 48]) - expected).length() < 1e-6, "{pixel:?}");
    }
    // A field of view of the frame replaces the focal lengths of the file.
    let SceneView { camera, resolution } = found[1];
    assert!((camera.tan_half_x - 1.0).abs() < 1e-6 && (camera.pixel_height - 1.0).abs() < 1e-6);
    assert_eq!((resolution, camera.shift), (Some([32, 32]), [0.0; 2]));
    let angles = frames("\"camera_angle_x\": 1.2, \"camera_angle_y\": 0.8, \"w\": 64, \"h\": 48,", "");
    let camera = cameras(&nerf(&angles))[0].camera;
    let top = camera.direction([32.0, 0.0], [64, 48]);
    assert!((top.dot(Vec3::Z) / top.dot(Vec3::NEG_X) - 0.4f32.tan()).abs() < 1e-5);
}

#[test]
fn what_is_not_supported_is_named_once_and_zeros_are_not() {
    let text = "\"camera_angle_x\": 1, \"k1\": 0.1, \"k2\": 0, \"p1\": 0.0, \"camera_model\": \"OPENCV_FISHEYE\", \"aabb_scale\": 4,\
        \"zoom\": 2, \"is_fisheye\": false,";
    let found = nerf(&frames(text, "\"k1\": 0.2, \"sharpness\": 30, \"time\": 0.5,"));
    let said: Vec<String> = found.warnings().iter().map(|warning| warning.what.clone()).collect();
    let expected =
        ["`k1` is not supported", "`zoom` is not supported", "\"OPENCV_FISHEYE\"", "`time` is not supported"];
    assert!(said.len() == 4 && expected.iter().all(|text| said.iter().any(|s| s.contains(text))), "{said:?}");
    assert!(found.warnings()[0].fallback.contains("no distortion"));
    let skewed = MATRIX.replace("[0, 1, 0, 3]", "[0, 2, 0, 3]");
    let found = nerf(&frames("\"camera_angle_x\": 1,", "").replace(MATRIX, &skewed));
    assert!(
        found.warnings()[0].what.contains("frame 1 shears, mirrors or scales unevenly"),
        "{:?}",
        found.warnings()
    );
    assert_eq!(cameras(&found)[0].camera.up, Vec3::Z);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    fs::write(&path, frames("\"camera_angle_x\": 1, \"k1\": 1,", "")).unwrap();
    assert!(
        ViewList::read(&path, &LoadOptions { strict: true, ..LoadOptions::default() })
            .unwrap_err()
            .to_string()
            .contains("k1")
    );
}

#[test]
fn wrong_lists_are_errors_with_the_file_the_entry_and_a_remedy() {
    let angle = "\"camera_angle_x\": 1,";
    let placed = |matrix: &str| frames(angle, "\"file_path\": \"r_0\",").replace(MATRIX, matrix);
    for (text, expected) in [
        ("{".to_owned(), "transforms.json:1: EOF"),
        ("{\n\"frames\": [}".to_owned(), "transforms.json:2: "),
        ("[]".to_owned(), "no list `frames`"),
        ("{ \"frames\": 3 }".to_owned(), "no list `frames`"),
        ("{ \"frames\": [] }".to_owned(), "no camera; add one"),
        ("{ \"frames\": [7] }".to_owned(), "frame 1 is no table"),
        (frames("\"w\": 8,\n\"w\": 9,", ""), "the key \"w\" is twice in one object; remove one"),
        (frames("", ""), "frame 1: without w and h"),
        (frames("\"fl_x\": 50,", ""), "add w and h"),
        (frames("\"w\": 8, \"h\": 8,", ""), "no focal length"),
        (frames("\"w\": 8,", ""), "only one of w and h"),
        (frames("\"w\": 8.5, \"h\": 8,", ""), "w is 8.5; write a whole number"),
        (frames("\"w\": 8, \"h\": 1e9,", ""), "h is 1000000000"),
        (frames("\"camera_angle_x\": 4,", ""), "camera_angle_x is 4; write an angle in radians"),
        (frames("\"camera_angle_x\": \"wide\",", ""), "camera_angle_x is wide; write a number"),
        (frames("\"camera_angle_x\": -1,", ""), "camera_angle_x is -1"),
        (frames("\"fl_x\": 0, \"w\": 8, \"h\": 8,", ""), "fl_x is 0; write a number above 0"),
        (frames(angle, "\"cx\": 3,"), "add w and h"),
        (frames(angle, "\"file_path\": 3,"), "file_path is no text"),
        (placed("[[1, 0, 0, 0]]"), "frame 1 (\"r_0\"): there is no valid transform_matrix; write four rows"),
        (placed("[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"), "no valid transform_matrix"),
        (placed("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]"), "translation in the last row"),
        (placed("[[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]"), "looks nowhere"),
        (placed("\"here\""), "no valid transform_matrix"),
    ] {
        let error = list("transforms.json", &text).unwrap_err().to_string();
        assert!(error.contains("transforms.json") && error.contains(expected), "{text}: {error}");
    }
    assert!(
        list("views.txt", "")
            .unwrap_err()
            .to_string()
            .contains("no list of cameras; name the transforms.json")
    );
    let far = frames(angle, "").replace("[1, 0, 0, 2]", "[1, 0, 0, 1e300]");
    assert!(nerf(&far).in_scene(&Scene::default()).unwrap_err().to_string().contains("a camera stands at"));
}

#[test]
fn a_camera_that_is_wrong_is_left_out_and_named_and_the_others_keep_their_numbers() {
    let good = "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]]";
    let of =
        |matrix: &str, name: &str| format!("{{ \"file_path\": \"{name}\", \"transform_matrix\": {matrix} }}");
    let text = |bad: &str| {
        let frames = [of(good, "a"), bad.to_owned(), of(good, "")].join(",\n");
        format!("{{ \"camera_angle_x\": 1, \"frames\": [{frames}] }}")
    };
    let row = |row: &str| of(&good.replace("[0, 1, 0, 0]", row), "Na\\\"N");
    for (bad, expected) in [
        (row("[-Infinity, Infinity, NaN, 0]"), "frame 2 (\"Na\"N\"): the transform_matrix holds -Infinity"),
        (row("[0, NaN, 0, 0]"), "the transform_matrix holds NaN"),
        (row("[0, null, 0, 0]"), "the transform_matrix holds null"),
        (row("[0, \"1e999\", 0, 0]"), "the transform_matrix holds 1e999"),
        (row("[0, 1, 0]"), "no valid transform_matrix"),
        (of(&good.replace('1', "0"), "b"), "no valid transform_matrix"),
        (
            of("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 5, 1]]", "b"),
            "has its translation in the last row",
        ),
        ("{ \"file_path\": \"b\" }".to_owned(), "frame 2 (\"b\"): there is no valid transform_matrix"),
        ("7".to_owned(), "frame 2 is no table"),
        (of(good, "b").replace("{ ", "{ \"w\": NaN, \"h\": 3, "), "w is NaN"),
    ] {
        let found = list("t.json", &text(&bad)).unwrap_or_else(|error| panic!("{bad}: {error}"));
        assert_eq!(found.numbers(), [1, 3]);
        assert_eq!(found.file_names(), ["a", "view_0003"].map(Path::new));
        let [warning] = found.warnings() else { panic!("{bad}: {:?}", found.warnings()) };
        assert!(warning.what.contains(expected) && warning.fallback.contains("left out"), "{bad}: {warning}");
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("t.json"), text(&bad)).unwrap();
        let strict = LoadOptions { strict: true, ..LoadOptions::default() };
        let error = ViewList::read(&folder.path().join("t.json"), &strict).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let many = list("t.json", &text(&["7"; 30].join(","))).unwrap();
    let said: Vec<String> = many.warnings().iter().map(ToString::to_string).collect();
    assert!(said.len() == 11 && said[10].contains("20 more cameras"), "{said:?}");
    // Lists of other formats.
    let camera = "[[camera]]\norigin = [0, 0, 5]\ntarget = [0, 0, 0]\n";
    let found = list("v.toml", &[camera, "[[camera]]\norigin = [0, 0, 5]\n", camera].concat()).unwrap();
    assert_eq!(found.numbers(), [1, 3]);
    let said = found.warnings()[0].to_string();
    assert!(said.contains("v.toml:4: camera 2: a camera of a list"), "{said}");
    let sensors = "<sensor type=\"fisheye\"/><sensor type=\"perspective\"/>";
    let found = list("s.xml", &format!("<scene version=\"3.0.0\">{sensors}</scene>")).unwrap();
    assert!(found.numbers() == [2] && found.warnings()[0].what.contains("camera 1: the sensor"), "{found:?}");
}

#[test]
fn lists_are_read_in_the_encodings_of_windows_and_with_numbers_as_texts() {
    let plain = frames("\"camera_angle_x\": 1, \"w\": 32, \"h\": 24,", "");
    let hash = nerf(&plain).hash();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    let mark = "\u{feff}".to_owned() + &plain;
    let utf_16 = |bytes: fn(u16) -> [u8; 2]| mark.encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
    for bytes in [mark.clone().into_bytes(), utf_16(u16::to_le_bytes), utf_16(u16::to_be_bytes)] {
        fs::write(&path, bytes).unwrap();
        assert_eq!(ViewList::read(&path, &LoadOptions::default()).unwrap().hash(), hash);
    }
    let texts = plain.replace(": 32", ": \"32\"").replace("[0, 1, 0, 3]", "[0, \"1\", 0, 3]");
    assert_eq!(nerf(&texts).hash(), hash);
    // A scale of the matrix is no shear.
    let scaled = "[[0, 0, 0.25, 1], [0.25, 0, 0, 2], [0, 0.25, 0, 3], [0, 0, 0, 1]]";
    let found = nerf(&plain.replace(MATRIX, scaled));
    assert!(found.warnings().is_empty() && found.hash() == hash, "{:?}", found.warnings());
}

#[test]
fn lists_in_toml_have_the_cameras_of_scenes() {
    let found = list(
        "views.toml",
        "resolution = [64, 48]\n[[camera]]\nname = \"front\"\norigin = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 90\n\
         [[camera]]\norigin = [3, 0, 0]\ntarget = [0, 0, 0]\nresolution = [30, 60]\nfov_axis = \"y\"\nfov = 90\n\
         aperture_radius = 0.5\n",
    )
    .unwrap();
    assert_eq!(found.file_names(), [Path::new("front"), Path::new("view_0002")]);
    let [front, side] = cameras(&found)[..] else { panic!("{found:?}") };
    assert_eq!((front.resolution, front.camera.forward), (Some([64, 48]), Vec3::NEG_Z));
    assert!((front.camera.tan_half_x - 1.0).abs() < 1e-6);
    assert!((side.camera.tan_half_x - 0.5).abs() < 1e-6 && side.resolution == Some([30, 60]));
    assert_eq!(side.camera.projection, Projection::Lens { radius: 0.5, distance: 3.0 });
    let camera = "[[camera]]\norigin = [0, 0, 5]\ntarget = [0, 0, 0]\n";
    for (text, expected) in [
        ("camera = []", "no camera; add one"),
        ("# none", "missing field `camera`; add it"),
        (&format!("{camera}fow = 3"), "views.toml:4: unknown field `fow`"),
        (&format!("{camera}path = {{ keys = [] }}"), "unknown field `path`"),
        (&format!("{camera}fov = 200"), "fov is 200"),
        (&format!("{camera}fov_axis = \"y\""), "views.toml:1: fov_axis is y"),
        (&format!("{camera}fov_axis = \"z\""), "views.toml:4: unknown fov_axis"),
        (&format!("resolution = [0, 1]\n{camera}"), "views.toml:1: the resolution is 0 x 1"),
        ("[[camera]]\norigin = [0, 0, 5]", "views.toml:1: a camera of a list has no origin or no target"),
        ("[[camera]]\norigin = [0, 0, 5]\ntarget = [0, 0, 5]", "looks nowhere"),
        ("[camera]\nfov = 3", "views.toml: `camera` is a single table"),
        ("mesh = 3", "unknown field `mesh`"),
    ] {
        let error = list("views.toml", text).unwrap_err().to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
    let numbers = camera.replace("[0, 0, 5]", "[0, nan, 5]");
    let found =
        list("views.toml", &[camera, &numbers, camera, &camera.replace('5', "inf")].concat()).unwrap();
    assert_eq!(found.numbers(), [1, 3]);
    let said: Vec<String> = found.warnings().iter().map(ToString::to_string).collect();
    assert!(said[0].contains("views.toml:5: ") && said[0].contains("expected a number from"), "{said:?}");
    assert!(said[1].contains("views.toml:10: "), "{said:?}");
}

#[test]
fn all_cameras_of_a_model_are_views() {
    let text = r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1, 2] }],
        "nodes": [
            { "name": "left", "camera": 0, "translation": [-1, 0, 5] },
            { "name": "cart", "translation": [0, 2, 0], "children": [3] },
            { "camera": 1 },
            { "name": "left", "camera": 0, "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476] }
        ],
        "cameras": [
            { "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1, "aspectRatio": 1.0 } },
            { "name": "plan", "type": "orthographic", "orthographic": { "xmag": 3, "ymag": 1.5, "znear": 0, "zfar": 9 } }
        ],
        "buffers": [{ "byteLength": 4, "uri": "absent.bin" }] }"#;
    let found = list("model.gltf", text).unwrap();
    assert_eq!(found.file_names(), ["left", "left_2", "plan"].map(Path::new));
    let [left, cart, plan] = cameras(&found)[..] else { panic!("{found:?}") };
    assert_eq!((left.camera.origin, left.resolution), (Vec3::new(-1.0, 0.0, 5.0), Some([720, 720])));
    assert!((cart.camera.forward - Vec3::NEG_X).length() < 1e-6 && cart.camera.origin == Vec3::Y * 2.0);
    assert_eq!((plan.camera.projection, plan.camera.tan_half_x), (Projection::Parallel, 3.0));
    let none = r#"{ "asset": { "version": "2.0" } }"#;
    assert!(list("model.gltf", none).unwrap_err().to_string().contains("no camera; add one"));
}

#[test]
fn cameras_stand_where_a_camera_of_the_scene_would() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.toml");
    let text = "camera = { origin = [101, 52, 5e6], target = [100, 50, 0], fov = 40 }\n\
        [[material]]\nname = \"m\"\nkind = \"diffuse\"\nreflectance = 0.5\n\
        [[mesh]]\nshape = \"cube\"\nmaterial = \"m\"\ntransform = [{ scale = 1e8 }, { translate = [100, 50, 0] }]\n";
    fs::write(&path, text).unwrap();
    let loaded = load(&path, &LoadOptions::default()).unwrap();
    assert!(loaded.scene.exponent != 0 && loaded.scene.centre != DVec3::ZERO);
    let found =
        list("v.toml", "[[camera]]\norigin = [101, 52, 5e6]\ntarget = [100, 50, 0]\nfov = 40\n").unwrap();
    assert_eq!(found.in_scene(&loaded.scene).unwrap()[0].camera, loaded.cameras.still);
}

#[test]
fn the_hash_follows_cameras_and_names_and_not_the_text() {
    let [a, b] =
        [0.5, 0.6].map(|angle| frames(&format!("\"camera_angle_x\": {angle},"), "\"file_path\": \"a\","));
    let hash = |text: &str| nerf(text).hash();
    assert_eq!(hash(&a), hash(&a.replace(' ', "\n")));
    assert!(hash(&a) != hash(&b) && hash(&a) != hash(&a.replace("\"a\"", "\"c\"")));
}

#[test]
fn sensors_of_a_mitsuba_scene_are_views() {
    let film = |width: u32, more: &str| {
        format!(
            "<film type=\"hdrfilm\"><integer name=\"width\" value=\"{width}\"/>\
             <integer name=\"height\" value=\"6\"/>{more}</film>"
        )
    };
    let sensor = |id: &str, x: f32, film: &str| {
        format!(
            "<sensor type=\"perspective\" {id}><float name=\"fov\" value=\"90\"/><transform name=\"to_world\">\
             <lookat origin=\"{x}, 2, 3\" target=\"0, 2, 3\" up=\"0, 1, 0\"/></transform>{film}</sensor>"
        )
    };
    let cropped = film(8, "<integer name=\"crop_width\" value=\"4\"/>");
    let sensors = [sensor("id=\"front\"", 1.0, &film(12, "")), sensor("", -5.0, &cropped)].concat();
    let read = |sensors: &str| list("s.xml", &format!("<scene version=\"3.0.0\">{sensors}</scene>"));
    let found = read(&sensors).unwrap();
    assert_eq!(found.file_names(), [Path::new("front"), Path::new("view_0002")]);
    let views = cameras(&found);
    assert_eq!(views.iter().map(|view| view.resolution).collect::<Vec<_>>(), [Some([12, 6]), Some([8, 6])]);
    assert_eq!(views[0].camera.origin, Vec3::new(1.0, 2.0, 3.0));
    assert!((views[0].camera.forward - Vec3::NEG_X).length() < 1e-6);
    assert!((views[1].camera.forward - Vec3::X).length() < 1e-6);
    assert!((views[0].camera.tan_half_x - 1.0).abs() < 1e-6);
    let [warning] = found.warnings() else { panic!("{:?}", found.warnings()) };
    assert!(warning.what.contains("crop"), "{warning:?}");
    assert!(read("").unwrap_err().to_string().contains("no camera"));
}

#[test]
fn parameters_of_a_mitsuba_scene_count_in_its_views() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    let sensor = "<sensor type=\"perspective\"><float name=\"fov\" value=\"$fov\"/></sensor>";
    let text = format!("<scene version=\"3.0.0\"><default name=\"fov\" value=\"90\"/>{sensor}</scene>");
    fs::write(&path, text).unwrap();
    let tan = |parameters: &[(&str, &str)]| {
        let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
        let options = LoadOptions { parameters: parameters.collect(), ..LoadOptions::default() };
        cameras(&ViewList::read(&path, &options).unwrap())[0].camera.tan_half_x
    };
    let given = tan(&[("fov", "60")]);
    assert!((tan(&[]) - 1.0).abs() < 1e-6 && (given - 30f32.to_radians().tan()).abs() < 1e-6);
}
