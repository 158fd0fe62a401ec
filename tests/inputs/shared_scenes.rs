//! Public scenes load completely: counts as in Mitsuba 3.9.1, and no unexplained warnings.
//!
//! The scenes are no part of this repository. They are looked for in `$LIGHTSPLAT_SHARED` and beside the checkout.
//! Without them the tests are skipped with a message.

use lightsplat::readers::{LoadOptions, Loaded, Severity, load};
use std::path::PathBuf;

/// Returns the folder of the public scenes; `None`, with a message, if there is none.
fn shared_scenes() -> Option<PathBuf> {
    let beside = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared"));
    let folder = std::env::var_os("LIGHTSPLAT_SHARED").map_or(beside, PathBuf::from).join("scenes");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no shared scenes at {}", folder.display());
    None
}

struct Expected {
    file: &'static str,
    /// Number in the files, before triangles without area are dropped.
    triangles: usize,
    degenerate: usize,
    meshes: usize,
    materials: usize,
    textures: usize,
    emitters: usize,
    environment: bool,
    resolution: [u32; 2],
    notes: usize,
}

#[rustfmt::skip]
const EXPECTED: [Expected; 7] = [
    Expected { file: "cbox/scene.xml", triangles: 38, degenerate: 0, meshes: 8, materials: 5, textures: 0, emitters: 1, environment: false, resolution: [512, 512], notes: 0 },
    Expected { file: "knot/scene.xml", triangles: 2896, degenerate: 0, meshes: 9, materials: 4, textures: 0, emitters: 2, environment: false, resolution: [512, 512], notes: 0 },
    // Notes: two disks of 128 triangles each, of which Mitsuba has one primitive each.
    Expected { file: "sibenik/scene.xml", triangles: 75546, degenerate: 10, meshes: 20, materials: 16, textures: 3, emitters: 5, environment: false, resolution: [512, 512], notes: 2 },
    Expected { file: "living-room/scene.xml", triangles: 143163, degenerate: 190, meshes: 65, materials: 19, textures: 4, emitters: 0, environment: true, resolution: [512, 288], notes: 0 },
    Expected { file: "staircase/scene.xml", triangles: 262663, degenerate: 155, meshes: 755, materials: 25, textures: 9, emitters: 1, environment: false, resolution: [512, 910], notes: 0 },
    Expected { file: "kitchenette/scene.xml", triangles: 253433, degenerate: 100, meshes: 87, materials: 23, textures: 1, emitters: 0, environment: true, resolution: [512, 384], notes: 0 },
    Expected { file: "kitchenette/scene_authored.xml", triangles: 253833, degenerate: 100, meshes: 88, materials: 24, textures: 1, emitters: 0, environment: true, resolution: [512, 384], notes: 0 },
];

#[test]
fn every_shared_scene_loads_whole() {
    let Some(folder) = shared_scenes() else { return };
    for e in EXPECTED {
        let loaded = load(&folder.join(e.file), &LoadOptions { strict: true, ..LoadOptions::default() });
        let Loaded { scene, cameras, warnings, repairs, .. } =
            loaded.unwrap_or_else(|error| panic!("{error}"));
        let triangles: usize = scene.meshes.iter().map(|m| m.triangles.len()).sum();
        let emitters = scene.meshes.iter().filter(|m| m.emission.is_some()).count();
        assert_eq!(triangles + repairs.degenerate, e.triangles, "{}", e.file);
        assert_eq!(repairs.degenerate, e.degenerate, "{}", e.file);
        let counts = (scene.meshes.len(), scene.materials.len(), scene.textures.len(), emitters);
        assert_eq!(counts, (e.meshes, e.materials, e.textures, e.emitters), "{}", e.file);
        assert_eq!((scene.environment.is_some(), cameras.resolution), (e.environment, e.resolution));
        assert_eq!(scene.max_depth, Some(17));
        assert!(warnings.iter().all(|w| w.severity == Severity::Note), "{warnings:?}");
        assert_eq!(warnings.len(), e.notes, "{warnings:?}");
        assert_eq!(repairs.out_of_range + repairs.not_finite + repairs.bad_uvs + repairs.bad_texels, 0);
    }
}

#[test]
fn loading_twice_gives_the_same_bits() {
    let Some(folder) = shared_scenes() else { return };
    let path = folder.join("kitchenette/scene.xml");
    let [a, b] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| load(&path, &LoadOptions::default()).unwrap())
    });
    assert_eq!(a.hash, b.hash);
    assert_eq!(a.scene.sources, b.scene.sources);
    for (a, b) in a.scene.meshes.iter().zip(&b.scene.meshes) {
        assert!(a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles);
    }
}
