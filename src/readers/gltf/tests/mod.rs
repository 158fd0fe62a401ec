mod as_written;
mod colours;
mod compressed;
mod container;
mod faults;
mod model;
mod packed;
mod samples;
mod skin;
mod slow_damage;
mod tangents;

use super::super::{LoadOptions, Loaded, SceneError, Severity, load};
use base::math::luminance;
use glam::{Vec2, Vec3};
use model::Model;
use scene::{
    DeltaLight, Filter, Lobe, Material, Parameter, Principled, Projection, Reflectance, Relief, Share,
};
use serde_json::json;
use std::fs;

fn load_bytes(name: &str, bytes: &[u8]) -> Result<Loaded, SceneError> {
    load_beside(name, &[(name, bytes)])
}

fn load_beside(name: &str, files: &[(&str, &[u8])]) -> Result<Loaded, SceneError> {
    load_with(name, files, &LoadOptions::default())
}

fn load_with(name: &str, files: &[(&str, &[u8])], options: &LoadOptions) -> Result<Loaded, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    load(&folder.path().join(name), options)
}

fn sample(name: &str) -> Loaded {
    let (_, model, _) = samples::all().into_iter().find(|(own, ..)| *own == name).unwrap();
    load_bytes("m.glb", &model.glb()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn material<'a>(loaded: &'a Loaded, name: &str) -> &'a Material {
    loaded.scene.materials.iter().find(|material| material.name == name).unwrap()
}

fn principled<'a>(loaded: &'a Loaded, name: &str) -> &'a Principled {
    material(loaded, name).principled.as_ref().unwrap()
}

/// Returns the bounds of a mesh in the file's coordinates.
fn bounds(loaded: &Loaded, mesh: usize) -> [Vec3; 2] {
    let centre = loaded.scene.centre.as_vec3();
    let positions = loaded.scene.meshes[mesh].positions.iter().map(|p| p + centre);
    positions.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

fn near(a: Vec3, b: [f32; 3]) -> bool {
    a.distance(Vec3::from(b)) < 1e-5
}

#[test]
fn every_sample_loads_and_names_what_it_does_not_get() {
    for (name, model, lacks) in samples::all() {
        let loaded = load_bytes("m.glb", &model.glb()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let warnings: Vec<&str> = loaded
            .warnings
            .iter()
            .filter(|w| w.severity == Severity::Warning && !w.what.contains("no light"))
            .map(|w| w.what.as_str())
            .collect();
        assert_eq!(warnings.len(), lacks.len(), "{name}: {warnings:?}");
        for lack in lacks {
            assert!(warnings.iter().any(|warning| warning.contains(lack)), "{name}: {lack}: {warnings:?}");
        }
    }
}

#[test]
fn nodes_place_instances_of_meshes() {
    let loaded = sample("instances");
    let names: Vec<&str> = loaded.scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!(names, ["left", "right", "big"]);
    // A rotation by 90° about y maps x to -z.
    let expected = [
        [Vec3::new(0.0, -1.0, 2.0), Vec3::new(0.0, 1.0, 4.0)],
        [Vec3::new(0.0, -2.0, -4.0), Vec3::new(0.0, 2.0, -2.0)],
        [Vec3::new(-2.0, 8.0, 0.0), Vec3::new(2.0, 12.0, 0.0)],
    ];
    for (mesh, expected) in expected.into_iter().enumerate() {
        let found = bounds(&loaded, mesh);
        assert!(found.iter().zip(expected).all(|(a, b)| a.distance(b) < 1e-5), "{mesh}: {found:?}");
    }
    assert!(loaded.scene.meshes[0].normals[0].distance(Vec3::X) < 1e-6);
    let brass = principled(&loaded, "brass");
    assert_eq!(brass.diffuse, scene::Diffuse::Lambertian);
    assert_eq!(brass.base_color, Reflectance::Constant(Vec3::new(0.9, 0.7, 0.3)));
    assert_eq!((brass.metallic, brass.roughness), (Share::Constant(1.0), Share::Constant(0.4)));
    // The model has no camera; the default camera sees all of it.
    assert!(loaded.cameras.still.origin.length() > 5.0);
}

#[test]
fn textures_keep_their_channels_and_transforms() {
    let loaded = sample("textures");
    let tiles = principled(&loaded, "tiles");
    let Reflectance::Textured { texture, .. } = tiles.base_color else { panic!() };
    let colour = &loaded.scene.textures[texture.0 as usize];
    // The specification's transform, v downwards: offset + rotation * scale * uv, turned counter-clockwise as seen.
    let (sin, cos) = 0.5f32.sin_cos();
    for uv in [Vec2::new(0.1, 0.2), Vec2::new(0.7, 0.4)] {
        let s = uv * Vec2::new(2.0, 3.0);
        let expected = Vec2::new(0.25 + cos * s.x + sin * s.y, 0.5 + cos * s.y - sin * s.x);
        let found = colour.to_uv.transform_point2(Vec2::new(uv.x, 1.0 - uv.y));
        assert!(found.distance(Vec2::new(expected.x, 1.0 - expected.y)) < 1e-5, "{found} {expected}");
    }
    let value = |share: Share| match share {
        Parameter::Textured { texture, scale } => {
            luminance(loaded.scene.textures[texture.0 as usize].lookup(Vec2::splat(0.5))) * scale
        }
        Parameter::Constant(_) => panic!(),
    };
    assert!((value(tiles.roughness) - 0.8 * 128.0 / 255.0).abs() < 1e-6);
    assert!((value(tiles.metallic) - 0.5).abs() < 1e-6);
    assert_eq!(loaded.scene.textures.len(), 4);
    let relief = material(&loaded, "tiles").relief;
    assert!(matches!(relief, Some(Relief::Normals { strength: 0.5, y_along_v: true, .. })));
    // The upper left texel is red, where u and v, counted downwards, are small.
    let corner = loaded.scene.meshes[0].uvs[3];
    assert_eq!(corner, Vec2::new(0.0, 1.0));
}

#[test]
fn emission_has_its_strength_and_unlit_surfaces_shine() {
    let loaded = sample("emission");
    let emission = loaded.scene.meshes[0].emission.unwrap();
    assert_eq!((emission.radiance, emission.two_sided), (Vec3::new(12.0, 6.0, 3.0), false));
    assert!(emission.texture.is_some());
    let loaded = sample("unlit");
    let emission = loaded.scene.meshes[0].emission.unwrap();
    assert_eq!((emission.radiance, emission.two_sided), (Vec3::new(0.2, 0.4, 0.8), true));
    assert_eq!(material(&loaded, "sign").diffuse, Reflectance::BLACK);
    let label = loaded.scene.meshes[1].emission.unwrap();
    assert_eq!(label.radiance, Vec3::new(0.5, 0.5, 0.25));
    assert_eq!(material(&loaded, "label").opacity, Some(Share::Constant(0.25)));
}

#[test]
fn lights_have_positions_directions_and_units() {
    let loaded = sample("lights");
    let power = Vec3::new(1.0, 0.5, 0.25);
    let centre = loaded.scene.centre.as_vec3();
    let [point, directional, spot] = loaded.scene.lights[..] else { panic!() };
    assert!(matches!(point, DeltaLight::Point { position, intensity }
        if (position + centre).distance(Vec3::Y * 4.0) < 1e-6 && intensity == power));
    assert_eq!(directional, DeltaLight::Directional { direction: Vec3::NEG_Z, irradiance: power });
    assert!(
        matches!(
            spot,
            DeltaLight::Spot { direction: Vec3::NEG_Z, inner_angle: 0.3284..0.3285, outer_angle: 0.5, .. }
        ),
        "{spot:?}"
    );

    // A scene file overrides the lights, rotates the model, and selects the lights only.
    let (_, model, _) = samples::all().into_iter().find(|(name, ..)| *name == "lights").unwrap();
    let scene = "[[mesh]]\nfile = \"m.glb\"\nlumens_per_watt = 1\ntransform = [{ translate = [0, 0, 7] }]\n";
    let loaded = load_beside("s.toml", &[("m.glb", &model.glb()), ("s.toml", scene.as_bytes())]).unwrap();
    let centre = loaded.scene.centre.as_vec3();
    assert!(matches!(loaded.scene.lights[0], DeltaLight::Point { position, intensity }
        if (position + centre).distance(Vec3::new(0.0, 4.0, 7.0)) < 1e-5 && intensity == 683.0 * power));
    assert_eq!(loaded.scene.sources.len(), 2);
}

#[test]
fn cameras_and_their_animation_are_the_walk() {
    let loaded = sample("camera");
    let centre = loaded.scene.centre.as_vec3();
    let cameras = &loaded.cameras;
    assert_eq!(cameras.resolution, [1018, 509]);
    assert!((cameras.still.tan_half_x - 2.0 * 0.5f32.tan()).abs() < 1e-4 && cameras.still.near == 0.1);
    assert!((cameras.still.origin + centre).distance(Vec3::Z * 5.0) < 1e-5);
    // The clock starts at 0, and the keys are at 0.5, 1.5 and 2.5 s, at 24 frames per second.
    assert_eq!(cameras.path.len(), 61);
    let at = |frame: usize| cameras.path[frame - 1].origin + centre;
    // The camera's own spline is Hermite, from 5 to 6, with a tangent of 2 at the start.
    let t = 0.5f32;
    let z = (2.0 * t.powi(3) - 3.0 * t * t + 1.0) * 5.0
        + (t.powi(3) - 2.0 * t * t + t) * 2.0
        + (3.0 * t * t - 2.0 * t.powi(3)) * 6.0;
    assert!([1, 13].map(at).iter().all(|at| at.distance(Vec3::new(0.0, 0.0, 5.0)) < 1e-5));
    assert!(at(25).distance(Vec3::new(2.0, 0.0, z)) < 1e-5, "{}", at(25));
    // The rotation is 90° from the second key on, so the camera's z points to x.
    assert!(at(37).distance(Vec3::new(4.0 + 6.0, 0.0, 0.0)) < 1e-5, "{}", at(37));
    assert!(cameras.path[36].forward.distance(Vec3::NEG_X) < 1e-5);
    assert!(at(61).distance(Vec3::new(4.0, 8.0, -6.0)) < 1e-5, "{}", at(61));

    let (_, model, _) = samples::all().into_iter().find(|(name, ..)| *name == "camera").unwrap();
    let scene = "resolution = [64, 64]\n[[mesh]]\nfile = \"m.glb\"\nfps = 5\n[environment]\nradiance = 1\n";
    let loaded = load_beside("s.toml", &[("m.glb", &model.glb()), ("s.toml", scene.as_bytes())]).unwrap();
    assert_eq!((loaded.cameras.path.len(), loaded.cameras.resolution), (14, [64, 64]));
}

#[test]
fn a_camera_is_chosen_by_name_or_number() {
    let (_, mut model, _) = samples::all().into_iter().find(|(name, ..)| *name == "camera").unwrap();
    model.node(json!({ "camera": 0, "name": "top", "translation": [0, 9, 0] }));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    fs::write(&path, model.glb()).unwrap();
    let choose =
        |camera: &str| load(&path, &LoadOptions { camera: Some(camera.into()), ..LoadOptions::default() });
    let plan =
        json!({ "type": "orthographic", "orthographic": { "xmag": 6, "ymag": 3, "znear": 0, "zfar": 50 } });
    let plan = model.push("cameras", plan);
    model.node(json!({ "camera": plan, "name": "plan" }));
    fs::write(&path, model.glb()).unwrap();
    let camera = choose("plan").unwrap().cameras.still;
    assert_eq!((camera.projection, camera.far), (Projection::Parallel, 50.0));
    assert!((camera.tan_half_x - 6.0).abs() < 0.01);
    for name in ["2", "top"] {
        let loaded = choose(name).unwrap();
        assert!((loaded.cameras.still.origin + loaded.scene.centre.as_vec3()).distance(Vec3::Y * 9.0) < 1e-5);
    }
    let error = choose("4").unwrap_err().to_string();
    assert!(error.contains("no camera \"4\"") && error.contains("2 (top), 3 (plan)"), "{error}");
    let loaded = load(&path, &LoadOptions::default()).unwrap();
    assert!(loaded.warnings.iter().any(|note| note.what.contains("3 cameras: 1")), "{:?}", loaded.warnings);
}

#[test]
fn alpha_modes_are_opacity() {
    let loaded = sample("alpha");
    let opacity: Vec<Option<Share>> =
        loaded.scene.materials.iter().map(|material| material.opacity).collect();
    let filter = |opacity: Option<Share>| match opacity {
        Some(Share::Textured { texture, .. }) => loaded.scene.textures[texture.0 as usize].filter,
        _ => panic!(),
    };
    let texels = |opacity: Option<Share>| match opacity {
        Some(Share::Textured { texture, scale }) => {
            let texels = &loaded.scene.textures[texture.0 as usize].texels;
            (texels.iter().map(|texel| (255.0 * texel.x).round()).collect::<Vec<f32>>(), scale)
        }
        _ => panic!(),
    };
    // Alpha times a factor of 0.5 is compared with a cutoff of 0.45, after interpolation.
    assert_eq!(texels(opacity[0]), (vec![255.0, 0.0, 100.0, 255.0], 1.0));
    assert_eq!(filter(opacity[0]), Filter::Cut(0.45 / 0.5));
    assert_eq!(filter(opacity[2]), Filter::Bilinear);
    assert_eq!(
        (texels(opacity[5]), filter(opacity[5])),
        ((vec![255.0, 0.0, 0.0, 255.0], 1.0), Filter::Nearest)
    );
    assert_eq!(opacity[1], Some(Share::Constant(0.25)));
    assert_eq!(texels(opacity[2]), (vec![255.0, 0.0, 100.0, 255.0], 0.5));
    assert_eq!((opacity[3], opacity[4]), (None, Some(Share::Constant(0.0))));
}

#[test]
fn glass_is_thin_solid_or_rough() {
    let loaded = sample("glass");
    let [Lobe::Dielectric { thin: true, eta, .. }] = material(&loaded, "pane").lobes[..] else { panic!() };
    assert!((eta - 1.5).abs() < 1e-5);
    let [Lobe::Dielectric { thin: false, eta, transmittance, .. }] = material(&loaded, "solid").lobes[..]
    else {
        panic!()
    };
    assert!((eta - 1.8).abs() < 1e-5);
    assert_eq!(transmittance, Reflectance::Constant(Vec3::ONE));
    // The thickness of 2 does not matter, nor does a volume without a distance.
    let sigma = -0.5f32.ln();
    let absorption = |loaded: &Loaded, name: &str| material(loaded, name).absorption;
    assert_eq!(absorption(&loaded, "solid"), Some(Vec3::new(sigma, 0.0, sigma)));
    assert_eq!(absorption(&loaded, "frosted"), None);
    let (_, model, _) = samples::all().into_iter().find(|(name, ..)| *name == "glass").unwrap();
    let scene = "mesh = [{ file = \"m.glb\", transform = [{ scale = 4 }, { translate = [0, 3, 0] }] }]";
    let scaled = load_beside("s.toml", &[("s.toml", scene.as_bytes()), ("m.glb", &model.glb())]).unwrap();
    let found = absorption(&scaled, "solid").unwrap();
    assert!((found * 4.0 - Vec3::new(sigma, 0.0, sigma)).abs().max_element() < 1e-5, "{found}");
    let frosted = principled(&loaded, "frosted");
    assert!(frosted.tints_each_passage);
    assert_eq!((frosted.spec_trans, frosted.roughness), (Share::Constant(1.0), Share::Constant(0.5)));
    assert_eq!(principled(&loaded, "veil").spec_trans, Share::Constant(0.0));
}

#[test]
fn layers_lie_over_the_base() {
    let loaded = sample("layers");
    let car = principled(&loaded, "car");
    assert!(matches!(car.clearcoat, Share::Textured { scale: 0.75, .. }));
    assert!((car.clearcoat_gloss - 0.09 / 0.099).abs() < 1e-5);
    assert_eq!(principled(&loaded, "velvet").sheen, Share::Constant(0.5));
    let eta = principled(&loaded, "dull").eta;
    assert!((((eta - 1.0) / (eta + 1.0)).powi(2) - 0.01).abs() < 1e-6);
    // Formula of the extension: α is 0.25 across, and 0.25 + 0.75 · 0.36 along.
    for (name, [along, across]) in [("brushed 0.5", [0.52, 0.25]), ("brushed 0.1", [1.0, 0.01])] {
        let brushed = principled(&loaded, name);
        let (Share::Constant(roughness), Share::Constant(strength)) =
            (brushed.roughness, brushed.anisotropic)
        else {
            panic!("{brushed:?}")
        };
        let [found_along, found_across] = brushed.stretch.alphas(roughness * roughness, strength);
        assert!((found_along - along).abs() < 1e-5 && (found_across - across).abs() < 1e-5, "{brushed:?}");
        assert_eq!(brushed.anisotropic_rotation, 0.5);
    }
}

#[test]
fn textures_give_the_strength_and_direction_of_anisotropy() {
    let mut model = Model::new();
    let directions = model.texture([[204, 230, 51, 255]; 4], json!({}));
    let rough = model.texture([[0, 128, 255, 255]; 4], json!({}));
    model.shown(json!({
        "name": "brushed",
        "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": rough } },
        "extensions": { "KHR_materials_anisotropy": {
            "anisotropyStrength": 0.5, "anisotropyRotation": 0.25, "anisotropyTexture": { "index": directions },
        } },
    }));
    model.uses("KHR_materials_anisotropy");
    let loaded = load_bytes("m.glb", &model.glb()).unwrap();
    assert!(loaded.warnings.iter().all(|w| !w.what.contains("nisotrop")), "{:?}", loaded.warnings);
    let brushed = principled(&loaded, "brushed");
    let Share::Textured { texture, scale: 0.5 } = brushed.anisotropic else { panic!("{brushed:?}") };
    let texel = |id: scene::TextureId| loaded.scene.textures.by_id(id).unwrap().texels.get(0, 0);
    assert!((luminance(texel(texture)) - 0.2).abs() < 1e-6 && brushed.roughness.is_textured());
    let direction = brushed.anisotropic_direction.expect("a texture");
    assert!((texel(direction) - Vec3::new(204.0, 230.0, 51.0) / 255.0).length() < 1e-6);
    assert_eq!((brushed.anisotropic_rotation, brushed.stretch), (0.25, scene::Stretch::AlongU));
}

#[test]
fn strips_fans_quantised_and_sparse_positions_are_read() {
    let loaded = sample("topology");
    let meshes = &loaded.scene.meshes;
    let counts: Vec<usize> = meshes.iter().map(|mesh| mesh.triangles.len()).collect();
    assert_eq!(counts, [3, 3, 1, 1]);
    for triangle in 0..3 {
        let [a, b, c] = meshes[0].corners(triangle);
        assert!((b - a).cross(c - a).z > 0.0, "strips keep their side");
    }
    assert!(bounds(&loaded, 2)[1].distance(Vec3::new(1.0, 1.0, 0.0)) < 1e-5);
    assert!(bounds(&loaded, 3)[1].distance(Vec3::new(1.0, 1.0, 7.0)) < 1e-5);
}

#[test]
fn text_files_have_buffers_and_images_beside_them_or_inside() {
    let mut model = Model::new();
    let mesh = model.square(None);
    model.node(json!({ "mesh": mesh }));
    let length = model.binary.len();
    let mut json = model.json.clone();
    json["buffers"] = json!([{ "byteLength": length, "uri": "my%20data.bin" }]);
    let loaded =
        load_beside("m.gltf", &[("m.gltf", json.to_string().as_bytes()), ("my data.bin", &model.binary)])
            .unwrap();
    assert_eq!((loaded.scene.meshes[0].triangles.len(), loaded.scene.sources.len()), (2, 2));
    use base64::Engine;
    let encoded = base64::engine::general_purpose::STANDARD.encode(&model.binary);
    json["buffers"] =
        json!([{ "byteLength": length, "uri": format!("data:application/octet-stream;base64,{encoded}") }]);
    let loaded = load_beside("m.gltf", &[("m.gltf", json.to_string().as_bytes())]).unwrap();
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 2);
}

#[test]
fn a_scene_file_takes_a_part_of_a_model_and_changes_it() {
    let (_, model, _) = samples::all().into_iter().find(|(name, ..)| *name == "instances").unwrap();
    let scene = "[[material]]\nname = \"red\"\nkind = \"diffuse\"\nreflectance = \"#ff0000\"\n\
        [[mesh]]\nfile = \"m.glb\"\ngroup = \"pair\"\nexcept = \"left\"\nmaterial = \"red\"\nemission = 3\n\
        [[mesh]]\nfile = \"m.glb\"\nexcept = [\"pair\"]\n[environment]\nradiance = 1\n";
    let load = |scene: &str| load_beside("s.toml", &[("m.glb", &model.glb()), ("s.toml", scene.as_bytes())]);
    let loaded = load(scene).unwrap();
    let meshes = &loaded.scene.meshes;
    let names: Vec<&str> = meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!(names, ["right", "big"]);
    assert_eq!(loaded.scene.materials[meshes[0].material.0 as usize].name, "red");
    assert_eq!((meshes[0].emission.unwrap().radiance, meshes[1].emission), (Vec3::splat(3.0), None));
    let unknown = load(&scene.replace("group = \"pair\"", "group = \"pears\"")).unwrap_err().to_string();
    assert!(unknown.contains("s.toml:5") && unknown.contains("no node called \"pears\""), "{unknown}");
}
