//! Tests of the requirements of scene files.

use crate::{LoadOptions, load};
use scene::Requirements;
use scene::requirements::{MaterialKinds, Trees};

fn requirements(text: &str) -> Requirements {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.toml");
    let head = "resolution = [8, 8]\ncamera = { origin = [0, 0, 5], target = [0, 0, 0], fov = 60 }\n";
    std::fs::write(&path, format!("{head}{text}")).unwrap();
    Requirements::new(&load(&path, &LoadOptions::default()).unwrap().scene)
}

#[test]
fn an_empty_scene_requires_nothing() {
    let r = requirements("");
    assert_eq!(r, Requirements::default());
    assert!(r.to_string().contains("light trees      none"));
}

#[test]
fn each_stage_is_required_just_where_something_needs_it() {
    let diffuse = "material = [{ name = \"m\", kind = \"diffuse\", reflectance = 0.5, two_sided = false }]\n";
    let square = "mesh = [{ shape = \"rectangle\", material = \"m\", emission = [1, 1, 1] }]\n";
    let r = requirements(&format!("{diffuse}{square}"));
    assert!(!r.specular_chains && !r.glossy && !r.two_sided);
    assert_eq!(r.trees, Trees { oriented: true, indirect: true, ..Trees::default() });
    assert_eq!((r.triangles, r.emitting_triangles, r.lights), (2, 2, 1));
    assert!((r.area - 4.0).abs() < 1e-6 && (r.diagonal - 8f64.sqrt()).abs() < 1e-6);

    let direct_only = requirements(&format!("max_depth = 2\n{diffuse}{square}"));
    assert!(!direct_only.trees.indirect);

    let lights = "light = [{ kind = \"directional\", direction = [0, -1, 0], irradiance = [1, 1, 1] }]\n";
    let r = requirements(&format!("{diffuse}{lights}"));
    assert_eq!(r.trees, Trees { directional: true, ..Trees::default() });
}

#[test]
fn areas_are_shared_out_by_lobe_and_unused_materials_do_not_count() {
    let r = requirements(
        "material = [
            { name = \"d\", kind = \"diffuse\", reflectance = 0.5 },
            { name = \"g\", kind = \"roughplastic\", diffuse = 0.5, alpha = 0.2 },
            { name = \"s\", kind = \"glass\" },
            { name = \"unused\", kind = \"mirror\" },
        ]
        mesh = [
            { shape = \"rectangle\", material = \"d\" },
            { shape = \"rectangle\", material = \"g\" },
            { shape = \"cube\", material = \"s\", transform = [{ scale = 2.0 }] },
        ]
        environment = { radiance = [1, 1, 1] }",
    );
    assert!((r.glossy_area_share - 4.0 / 104.0).abs() < 1e-9);
    assert!((r.specular_area_share - 96.0 / 104.0).abs() < 1e-9);
    assert_eq!(r.materials, MaterialKinds { diffuse: 1, rough_plastic: 1, glass: 1, ..Default::default() });
    assert_eq!(r.smallest_alpha, Some(0.2));
    assert!(r.specular_chains && r.glossy && r.two_sided && r.trees.environment && r.trees.indirect);
    assert!(r.memory.total() > 0);
}
