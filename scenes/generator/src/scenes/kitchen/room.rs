//! Walls, ceiling, tiled floor and tiled wall, the window and the door.

use crate::props::furniture::{casing, door, skirting};
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Extent of the room from the origin.
pub(super) const ROOM: Vec3 = Vec3::new(4.6, 2.6, 4.2);
/// Window opening in the right wall: low and high corner in (z, y).
const WINDOW: (Vec2, Vec2) = (Vec2::new(1.15, 1.12), Vec2::new(2.45, 2.2));
/// Depth of the window's reveal.
const REVEAL: f32 = 0.16;

pub fn add(scene: &mut Assembly) {
    shell(scene);
    floor(scene);
    window(scene);
    scene.place(&door(), turned(90.0, [0.0, 0.0, 1.55]));
    let board = |length: f32| skirting(length, 0.1);
    scene.add_at("trim", &board(0.29), turned(90.0, [0.0, 0.0, 1.01]));
    scene.add_at("trim", &board(2.11), turned(90.0, [0.0, 0.0, ROOM.z]));
    scene.add_at("trim", &board(ROOM.x), turned(180.0, [ROOM.x, 0.0, ROOM.z]));
    scene.add_at("trim", &board(ROOM.z - 2.87), turned(-90.0, [ROOM.x, 0.0, 2.87]));
    // Splashbacks: behind the worktop of the back wall, and of the right wall up to the sill.
    scene.place(&tiled_wall(Vec2::new(3.88, 0.55)), at(0.72, 0.9, 0.0));
    scene.place(&tiled_wall(Vec2::new(2.87, 0.14)), turned(-90.0, [ROOM.x, 0.9, 0.0]));
}

fn shell(scene: &mut Assembly) {
    let Vec3 { x, y, z } = ROOM;
    scene.add("floor", &sheet([0.0, 0.0, z], Vec3::X * x, -Vec3::Z * z));
    scene.add("ceiling", &sheet([0.0, y, 0.0], Vec3::X * x, Vec3::Z * z));
    scene.add("walls", &sheet(Vec3::ZERO, Vec3::X * x, Vec3::Y * y));
    scene.add("walls", &sheet([x, 0.0, z], -Vec3::X * x, Vec3::Y * y));
    scene.add("walls", &sheet([0.0, 0.0, z], -Vec3::Z * z, Vec3::Y * y));
    // The right wall, pierced: a prism whose front is the wall and whose reveals go back from it.
    let hole = rectangle(WINDOW.0, WINDOW.1);
    let wall = extrude_faces(&rectangle(Vec2::ZERO, Vec2::new(z, y)), &[hole], REVEAL, Faces::FRONT);
    scene.add_at("walls", &wall, turned(-90.0, [x, 0.0, 0.0]) * at(0.0, 0.0, -REVEAL));
}

/// Square tiles with bevelled edges over a bed of grout.
fn floor(scene: &mut Assembly) {
    let (columns, rows) = (14, 13);
    let pitch = Vec2::new(ROOM.x / columns as f32, ROOM.z / rows as f32);
    for j in 0..rows {
        for i in 0..columns {
            let centre = pitch * Vec2::new(i as f32 + 0.5, j as f32 + 0.5);
            let lying = upright([centre.x, 0.0, centre.y], Vec3::X, -Vec3::Z);
            scene.add_at("floor_tiles", &tile(pitch - 0.004, 0.004, 0.0025, Vec2::extend), lying);
        }
    }
}

/// Brick-bonded tiles of 20 x 10 cm on the wall z = 0, cut to `size`, from the origin to the right and up.
fn tiled_wall(size: Vec2) -> Assembly {
    let mut wall = Assembly::new();
    let (pitch, gap) = (Vec2::new(0.2, 0.1), 0.003);
    let rows = (size.y / pitch.y).ceil() as usize;
    for j in 0..rows {
        let (bottom, top) = (j as f32 * pitch.y, ((j + 1) as f32 * pitch.y).min(size.y));
        let mut left = if j % 2 == 0 { 0.0 } else { -0.5 * pitch.x };
        while left < size.x - 0.01 {
            let (from, to) = (left.max(0.0), (left + pitch.x).min(size.x));
            let extent = Vec2::new(to - from, top - bottom) - gap;
            let centre = Vec3::new(0.5 * (from + to), 0.5 * (bottom + top), 0.001);
            if extent.min_element() > 0.01 {
                wall.add_at(
                    "wall_tiles",
                    &tile(extent, 0.007, 0.002, Vec2::extend),
                    at(centre.x, centre.y, centre.z),
                );
            }
            left += pitch.x;
        }
    }
    wall.add("grout", &sheet(Vec3::Z * 0.002, Vec3::X * size.x, Vec3::Y * size.y));
    wall
}

/// Frame with glazing bars before dark panes (it is night), casing, sill and a half-drawn blind.
fn window(scene: &mut Assembly) {
    let (low, high) = WINDOW;
    let size = high - low;
    // Local frame: x to the right seen from inside, z into the room, origin at the lower left corner.
    let place = turned(-90.0, [ROOM.x, low.y, low.x]);
    let mut window = Assembly::new();
    let pane = sheet([-0.05, -0.05, -0.12], Vec3::X * (size.x + 0.1), Vec3::Y * (size.y + 0.1));
    window.add("panes", &pane);
    let light = 0.5 * (size - Vec2::new(0.15, 0.15));
    let holes: Vec<Vec<Vec2>> = (0..4)
        .map(|k| {
            let corner = Vec2::splat(0.05) + Vec2::new((k % 2) as f32, (k / 2) as f32) * (light + 0.05);
            rectangle(corner, corner + light)
        })
        .collect();
    let frame = extrude(&rectangle(Vec2::ZERO, size), &holes, 0.05);
    window.add_at("trim", &frame, at(0.0, 0.0, -0.118));
    window.add("trim", &casing(size, 0.07, true));
    window.add("trim", &beveled_box([-0.1, -0.03, -0.1], [size.x + 0.1, 0.004, 0.05], 0.004));
    // The blind hangs from a roller in the reveal, in soft folds below.
    let blind = patch(6, 24, |u, v| {
        let z = -0.035 + 0.006 * (40.0 * v).sin() * v;
        Vec3::new(0.02 + u * (size.x - 0.04), size.y - 0.03 - 0.4 * v, z)
    });
    window.add("blind", &blind.flipped());
    for (x, y, radius, segments) in [(0.01, size.y - 0.03, 0.018, 14), (0.02, size.y - 0.43, 0.008, 8)] {
        window.add("blind", &rod([x, y, -0.035], [size.x - x, y, -0.035], radius, segments));
    }
    scene.place(&window, place);
}
