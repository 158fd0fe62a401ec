//! Walls with their openings, ceilings, windows, skirting and door casings.

use crate::props::furniture::{casing, skirting};
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

/// Height of all rooms.
pub(super) const HEIGHT: f32 = 2.7;
/// Width and height of door openings.
const DOOR: Vec2 = Vec2::new(0.9, 2.1);
/// Depth of the window reveals.
const REVEAL: f32 = 0.18;
const SKIRTING: f32 = 0.12;

/// Inner face of a wall as seen from its room: x runs to the right from the lower left corner.
struct Face {
    place: Affine3A,
    length: f32,
    /// Left edges of the door openings.
    doors: &'static [f32],
}

/// Face from `x`, `z` that runs to the right after a turn about y by `degrees` from +x.
fn face(degrees: f32, x: f32, z: f32, length: f32, doors: &'static [f32]) -> Face {
    Face { place: turned(degrees, [x, 0.0, z]), length, doors }
}

pub fn add(scene: &mut Assembly) {
    partitions(scene);
    outer_walls(scene);
    for (low, high) in [(Vec2::ZERO, Vec2::new(5.65, 4.6)), (Vec2::new(5.65, -2.4), Vec2::new(9.7, 5.6))] {
        let size = high - low;
        let (u, v) = (Vec3::X * size.x, Vec3::Z * size.y);
        scene.add("ceiling", &sheet([low.x, HEIGHT, low.y], u, v));
        scene.add("subfloor", &sheet([low.x, 0.0, high.y], u, -v));
    }
    for face in faces() {
        trim(scene, &face);
    }
}

/// All inner faces, for skirting and casings.
fn faces() -> Vec<Face> {
    vec![
        face(0.0, 0.0, 0.0, 5.6, &[]),
        face(90.0, 0.0, 4.6, 4.6, &[]),
        face(180.0, 5.6, 4.6, 5.6, &[]),
        face(-90.0, 5.6, 0.0, 4.6, &[1.9]),
        face(90.0, 5.7, 3.0, 1.3, &[0.2]),
        face(0.0, 5.7, 1.7, 4.0, &[2.7]),
        face(180.0, 9.7, 3.0, 4.0, &[2.2]),
        face(0.0, 5.7, -2.4, 4.0, &[]),
        face(90.0, 5.7, 1.6, 4.0, &[]),
        face(180.0, 9.7, 1.6, 4.0, &[0.4]),
        face(-90.0, 9.7, -2.4, 4.0, &[]),
        face(0.0, 5.7, 3.1, 4.0, &[0.9]),
        face(90.0, 5.7, 5.6, 2.5, &[]),
        face(180.0, 9.7, 5.6, 4.0, &[]),
        face(-90.0, 9.7, 3.1, 2.5, &[]),
    ]
}

/// Skirting between the doors and a casing around each.
fn trim(scene: &mut Assembly, face: &Face) {
    let casing_width = 0.085;
    let mut from = 0.0;
    for &door in face.doors {
        add_board(scene, face, from, door - casing_width);
        scene.add_at("trim", &casing(DOOR, casing_width, false), face.place * at(door, 0.0, 0.0));
        from = door + DOOR.x + casing_width;
    }
    add_board(scene, face, from, face.length);
}

fn add_board(scene: &mut Assembly, face: &Face, from: f32, to: f32) {
    scene.add_at("trim", &skirting(to - from, SKIRTING), face.place * at(from, 0.0, 0.0));
}

/// Three inner walls, 0.1 m thick, with their doorways.
fn partitions(scene: &mut Assembly) {
    let wall = |length: f32, door: f32| {
        let far = door + DOOR.x;
        let doorway = [[door, 0.0], [door, DOOR.y], [far, DOOR.y], [far, 0.0]];
        let outline =
            [&[[0.0, 0.0]], &doorway[..], &[[length, 0.0], [length, HEIGHT], [0.0, HEIGHT]]].concat();
        extrude(&outline, &[], 0.1)
    };
    scene.add_at("walls", &wall(8.0, 4.3), turned(-90.0, [5.7, 0.0, -2.4]));
    scene.add_at("walls", &wall(4.0, 2.7), at(5.7, 0.0, 1.6));
    scene.add_at("walls", &wall(4.0, 0.9), at(5.7, 0.0, 3.0));
}

fn outer_walls(scene: &mut Assembly) {
    let plain =
        [face(0.0, 0.0, 0.0, 5.6, &[]), face(180.0, 5.6, 4.6, 5.6, &[]), face(-90.0, 9.7, -2.4, 8.0, &[])];
    for Face { place, length, .. } in plain {
        scene.add_at("walls", &sheet(Vec3::ZERO, Vec3::X * length, Vec3::Y * HEIGHT), place);
    }
    let living = face(90.0, 0.0, 4.6, 4.6, &[]);
    pierced(scene, "walls", &living, Vec2::new(1.0, 0.45), Vec2::new(2.2, 1.9));
    let bedroom = face(0.0, 5.7, -2.4, 4.0, &[]);
    pierced(scene, "bedroom_wall", &bedroom, Vec2::new(1.2, 0.85), Vec2::new(1.8, 1.4));
    let study = face(180.0, 9.7, 5.6, 4.0, &[]);
    pierced(scene, "walls", &study, Vec2::new(1.1, 0.95), Vec2::new(1.3, 1.25));
}

/// Outer wall with a window: the opening's lower left corner and size.
fn pierced(scene: &mut Assembly, part: &str, face: &Face, corner: Vec2, size: Vec2) {
    let outline = rectangle(Vec2::ZERO, Vec2::new(face.length, HEIGHT));
    let wall = extrude_faces(&outline, &[rectangle(corner, corner + size)], REVEAL, Faces::FRONT);
    scene.add_at(part, &wall, face.place * at(0.0, 0.0, -REVEAL));
    scene.place(&window(size), face.place * at(corner.x, corner.y, 0.0));
}

/// Window of two sashes with a transom; the sky behind it is a sheet of light.
fn window(size: Vec2) -> Assembly {
    let mut window = Assembly::new();
    window.add("daylight", &sheet([0.0, 0.0, -0.15], Vec3::X * size.x, Vec3::Y * size.y));
    // Closes the gap between the sheet of light and the wall.
    let back = Vec3::new(-0.06, -0.06, -REVEAL);
    window.add("subfloor", &sheet(back, Vec3::X * (size.x + 0.12), Vec3::Y * (size.y + 0.12)));
    let (bar, transom) = (0.055, 0.3 * size.y);
    let width = 0.5 * (size.x - 3.0 * bar);
    let upper = size.y - transom;
    let mut panes = Vec::new();
    for (y, h) in [(bar, upper - 1.5 * bar), (upper + 0.5 * bar, transom - 1.5 * bar)] {
        for x in [bar, 2.0 * bar + width] {
            panes.push(rectangle(Vec2::new(x, y), Vec2::new(x + width, y + h)));
        }
    }
    window.add_at("trim", &extrude(&rectangle(Vec2::ZERO, size), &panes, 0.05), at(0.0, 0.0, -0.12));
    window.add("trim", &casing(size, 0.08, true));
    window.add("trim", &beveled_box([-0.12, -0.035, -0.1], [size.x + 0.12, 0.003, 0.09], 0.005));
    window
}
