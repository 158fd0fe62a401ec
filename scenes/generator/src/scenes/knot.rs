//! A torus knot on a plinth in a closed room: 2,936 triangles, many glossy. A spot throws the knot's sharp
//! shadow; the room's other light is a lamp that faces the wall from behind a folding screen, so that most of
//! the visible surfaces are lit indirectly.

use crate::shapes::*;
use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::TAU;

/// Half the width and depth of the room, and its height.
const ROOM: Vec3 = Vec3::new(2.4, 2.8, 2.2);
const PLINTH_HEIGHT: f32 = 0.32;
/// Mouth of the spot's can; the scene file puts the light here.
const SPOT: Vec3 = Vec3::new(-1.75, 2.25, 1.55);
const SPOT_TARGET: Vec3 = Vec3::new(0.15, 0.95, -0.1);

/// Parts of the scene.
pub fn parts() -> Vec<Part> {
    let mut scene = Assembly::new();
    room(&mut scene);
    plinth_and_knot(&mut scene);
    screen_and_lamp(&mut scene);
    spot(&mut scene);
    scene.add_at("ball", &ellipsoid(Vec3::splat(0.24), 16, 9), at(-0.84, 0.24, 0.42));
    scene.into_parts()
}

fn room(scene: &mut Assembly) {
    let Vec3 { x, y, z } = ROOM;
    let (across, up, along) = (Vec3::X * 2.0 * x, Vec3::Y * y, Vec3::Z * 2.0 * z);
    let wall = |origin: Vec3, u: Vec3, v: Vec3| sheet(origin, u, v);
    scene.add("floor", &wall(Vec3::new(-x, 0.0, z), across, -along));
    scene.add("ceiling", &wall(Vec3::new(-x, y, -z), across, along));
    scene.add("back_wall", &wall(Vec3::new(-x, 0.0, -z), across, up));
    scene.add("front_wall", &wall(Vec3::new(x, 0.0, z), -across, up));
    scene.add("left_wall", &wall(Vec3::new(-x, 0.0, z), -along, up));
    scene.add("right_wall", &wall(Vec3::new(x, 0.0, -z), along, up));
    // Three beams below the ceiling and a panel on the back wall, without the faces that touch the room.
    for k in [-1.0, 0.0, 1.0] {
        let low = Vec3::new(-x, y - 0.16, 1.3 * k - 0.07);
        scene.add("beams", &block(low, [x, y, 1.3 * k + 0.07]).without_faces(Vec3::Y));
    }
    let panel = block([-1.9, 0.75, -z], [-0.5, 2.05, -z + 0.05]);
    scene.add("panel", &panel.without_faces(-Vec3::Z));
}

fn plinth_and_knot(scene: &mut Assembly) {
    let profile = [[0.74, 0.0], [0.74, PLINTH_HEIGHT - 0.03], [0.71, PLINTH_HEIGHT], [0.0, PLINTH_HEIGHT]];
    scene.add_at("plinth", &lathe(&profile, 24), at(0.1, 0.0, -0.2));

    // Tipped up to stand on its rim, then lowered until it touches the plinth.
    let pose = Quat::from_rotation_y(0.5) * Quat::from_rotation_x(1.25) * Quat::from_rotation_y(0.35);
    let knot = trefoil(0.44, 0.19, 0.105, 100, 12).transformed(Affine3A::from_quat(pose));
    let lowest = knot.points.iter().fold(f32::INFINITY, |y, p| y.min(p.y));
    scene.add_at("knot", &knot, at(0.1, PLINTH_HEIGHT - lowest, -0.2));
}

/// Tube of radius `tube` along the trefoil that winds twice about the y axis and three times around the
/// core of the torus with radii `major` and `minor`.
fn trefoil(major: f32, minor: f32, tube: f32, steps: usize, sides: usize) -> Shell {
    // The direction from the torus' core to the curve turns with it and comes back to itself: a frame
    // without a seam.
    let outwards = |t: f32| {
        let (sin3, cos3) = (3.0 * t).sin_cos();
        let (sin2, cos2) = (2.0 * t).sin_cos();
        Vec3::new(cos3 * cos2, sin3, cos3 * sin2)
    };
    let curve = |t: f32| {
        let (sin2, cos2) = (2.0 * t).sin_cos();
        Vec3::new(major * cos2, 0.0, major * sin2) + minor * outwards(t)
    };
    let rows: Vec<Vec<Vec3>> = (0..steps)
        .map(|k| {
            let t = TAU * k as f32 / steps as f32;
            let tangent = (curve(t + 1e-2) - curve(t - 1e-2)).normalize();
            let normal = (outwards(t) - tangent * tangent.dot(outwards(t))).normalize();
            let binormal = tangent.cross(normal);
            (0..sides)
                .map(|i| {
                    let (sin, cos) = (TAU * i as f32 / sides as f32).sin_cos();
                    curve(t) + tube * (normal * cos + binormal * sin)
                })
                .collect()
        })
        .collect();
    grid(&rows, true, true, 75.0)
}

fn screen_and_lamp(scene: &mut Assembly) {
    // Four leaves, folded in a zigzag across the right rear corner.
    let mut foot = Vec3::new(0.72, 0.0, -1.9);
    for degrees in [-62.0, -18.0, -58.0, -14.0] {
        let leaf = block([0.008, 0.03, -0.012], [0.522, 1.7, 0.012]);
        let place = turned(degrees, foot);
        scene.add_at("screen", &leaf, place);
        foot = place.transform_point3(Vec3::new(0.53, 0.0, 0.0));
    }
    // The lamp: a trough whose open side, the emitter, looks at the wall.
    let trough = block([-0.3, -0.12, -0.2], [0.3, 0.12, 0.0]);
    let aim =
        posed(Quat::from_rotation_y(125.0_f32.to_radians()) * Quat::from_rotation_x(-0.7), [1.5, 0.6, -1.35]);
    scene.add_at("lamp_case", &trough.without_faces(Vec3::Z), aim);
    let face = sheet([-0.3, -0.12, 0.0], Vec3::X * 0.6, Vec3::Y * 0.24);
    scene.add_at("lamp", &face, aim);
}

fn spot(scene: &mut Assembly) {
    // An open can behind the light, hanging from the ceiling by a bar.
    let back = SPOT + (SPOT - SPOT_TARGET).normalize() * 0.22;
    let can = lathe(&[[0.075, 0.0], [0.075, 0.22], [0.0, 0.22]], 12);
    scene.add_at("spot_case", &can, standing_on(SPOT, back));
    let bar = block([-0.012, 0.0, -0.012], [0.012, 0.5, 0.012]);
    let length = ROOM.y - back.y + 0.02;
    let bar = bar.mapped(|p| Vec3::new(p.x, p.y * length / 0.5, p.z));
    scene.add_at("spot_case", &bar, Affine3A::from_translation(back - Vec3::Y * 0.02));
}
