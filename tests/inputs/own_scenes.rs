//! The rooms in `scenes/`: they load without warnings, are closed to light, show front faces to the camera,
//! and the walk-through keeps clear of the furniture.

use glam::Vec3;
use lightsplat::readers::{LoadOptions, load};
use lightsplat::scene::Camera;
use lightsplat::scene::Cameras;
use lightsplat::world::Ray;
use lightsplat::world::World;
use std::path::Path;

fn world(name: &str) -> (World, Cameras) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml");
    let loaded = load(&path, &LoadOptions { strict: true, ..LoadOptions::default() })
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
    (World::new(loaded.scene, 2).unwrap_or_else(|e| panic!("{e}")), loaded.cameras)
}

/// Returns `count` directions spread evenly over the sphere (a Fibonacci lattice).
fn directions(count: usize) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |k| {
        let y = 1.0 - (2.0 * k as f32 + 1.0) / count as f32;
        let around = 2.399_963_2 * k as f32;
        let radius = (1.0 - y * y).sqrt();
        Vec3::new(radius * around.cos(), y, radius * around.sin())
    })
}

/// Returns all cameras of the scene.
fn viewpoints(cameras: &Cameras) -> Vec<Camera> {
    [cameras.still].into_iter().chain(cameras.path.iter().step_by(20).copied()).collect()
}

#[test]
fn rooms_are_closed_and_face_the_viewer() {
    for name in ["apartment", "furnace", "kitchen", "knot"] {
        let (world, cameras) = world(name);
        let (mut hits, mut from_behind) = (0, 0);
        for camera in viewpoints(&cameras) {
            for direction in directions(20_000) {
                let ray = Ray { origin: camera.origin, t_near: 0.0, direction, t_far: f32::INFINITY };
                let hit = world.intersect(&ray);
                let hit = hit.unwrap_or_else(|| panic!("{name}: {direction} leaves from {}", camera.origin));
                hits += 1;
                // The furnace's room is a cube seen from inside; leaves and curtains are sheets.
                from_behind += usize::from(hit.normal.dot(direction) > 0.0);
            }
        }
        if name != "furnace" {
            let share = from_behind as f64 / hits as f64;
            assert!(share < 0.01, "{name}: {share} of what is seen is seen from behind");
        }
    }
}

#[test]
fn the_walk_through_the_apartment_never_touches_anything() {
    let (world, cameras) = world("apartment");
    let path = &cameras.path;
    assert_eq!(path.len(), 281);
    for (frame, camera) in path.iter().enumerate() {
        for direction in directions(500) {
            let ray = Ray { origin: camera.origin, t_near: 0.0, direction, t_far: 0.15 };
            let hit = world.intersect(&ray);
            assert!(hit.is_none(), "frame {frame} at {} is too near something", camera.origin);
        }
    }
    for (frame, pair) in path.windows(2).enumerate() {
        let step = pair[0].origin.distance(pair[1].origin);
        assert!(step > 1e-4 && step < 0.12, "from frame {frame} the camera moves {step} m");
        let turn = pair[0].forward.dot(pair[1].forward).clamp(-1.0, 1.0).acos().to_degrees();
        assert!(turn < 4.0, "from frame {frame} the camera turns {turn} degrees");
    }
}
