//! Doors, panelled fronts, handles, casings, skirting.

use crate::shapes::*;
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Frame-and-panel front of `size` with its lower left corner at the origin, its back at z = 0 and its
/// face towards +z, closed. `frame` is the width of the frame around the sunk panel.
pub fn framed_panel(size: Vec2, thickness: f32, frame: f32) -> Shell {
    let t = thickness;
    // Inset from the edge, height of the surface: bevelled edge, frame, moulding, sunk field, raised panel.
    let front = [[0.0, 0.0], [0.0, t - 0.003], [0.003, t], [frame, t]];
    let panel = [[frame + 0.006, t - 0.007], [frame + 0.016, t - 0.009], [frame + 0.034, t - 0.003]];
    let ring = |&[inset, z]: &[f32; 2]| {
        rectangle(Vec2::splat(inset), size - inset).iter().map(|p| p.extend(z)).collect::<Vec<Vec3>>()
    };
    let rows: Vec<Vec<Vec3>> = front.iter().chain(&panel).map(ring).collect();
    let mut shell = grid(&rows, true, false, 10.0);
    let last = 4 * (rows.len() as u32 - 1);
    let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|p| p * size);
    shell.quad([last, last + 1, last + 2, last + 3], corners);
    let [a, b, c, d] = corners;
    shell.quad([3, 2, 1, 0], [d, c, b, a]);
    shell
}

/// Bar handle of `length` along x about the origin, standing `reach` off the surface z = 0.
pub fn bar_handle(length: f32, reach: f32, radius: f32) -> Shell {
    let half = 0.5 * length;
    let corners = [[-half, 0.0, 0.0], [-half, 0.0, reach], [half, 0.0, reach], [half, 0.0, 0.0]];
    pipe(&fillet(&corners, 0.45 * reach, 30.0), radius, 6)
}

/// Place of a bar handle that stands on end.
pub fn on_end(position: impl Into<Vec3>) -> Affine3A {
    posed(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2), position)
}

/// Turned knob on the surface z = 0.
pub fn knob(radius: f32) -> Shell {
    let profile = [[0.45, 0.0], [0.35, 0.5], [0.4, 0.75], [0.95, 1.0], [1.0, 1.25], [0.7, 1.5], [0.0, 1.55]];
    lathe(&scaled(&profile, radius), 10)
        .creased(60.0)
        .transformed(Affine3A::from_quat(Quat::from_rotation_x(90.0_f32.to_radians())))
}

/// Moulding around an opening of `size` that stands on the floor (`sill` false) or all around it, with
/// the lower left corner of the opening at the origin, on the wall z = 0.
pub fn casing(size: Vec2, width: f32, sill: bool) -> Shell {
    // x runs away from the opening, y off the wall; the path has the opening on its left.
    let (slope, edge) = ([width - 0.02, 0.024], [[width, 0.0], [width, 0.014]]);
    let profile = points(&[edge[0], edge[1], slope, [0.02, 0.02], [0.0, 0.012], [0.0, 0.0]]);
    let section = Section { points: &profile, closed: true, crease_degrees: 20.0 };
    let Vec2 { x, y } = size;
    let path = [[x, 0.0], [x, y], [0.0, y], [0.0, 0.0]].map(|p| Vec2::from_array(p).extend(0.0));
    sweep_along(section, &path, Vec3::Z, sill, Faces::ALL)
}

/// Skirting board of `height` on the wall z = 0, from x = 0 to `length`.
pub fn skirting(length: f32, height: f32) -> Shell {
    let profile = [[0.0, 0.0], [0.016, 0.0], [0.016, height - 0.025], [0.01, height - 0.008], [0.0, height]];
    let path = [Vec3::ZERO, Vec3::X * length];
    let section = Section { points: &points(&profile), closed: true, crease_degrees: 25.0 };
    sweep_along(section, &path, Vec3::Y, false, Faces::ALL)
}

/// Six panels on one face of a door, `z` off its middle.
fn panels(door: &mut Assembly, face: Affine3A, z: f32, thickness: f32) {
    for (y, h) in [(0.16, 0.56), (0.84, 0.62), (1.58, 0.38)] {
        let panel = framed_panel(Vec2::new(0.345, h), thickness, 0.012);
        door.add_each("door", &panel, [-0.375, 0.03].map(|x| face * at(x, y, z)));
    }
}

/// Lever from `foot`, 65 mm off the door, to `end`.
fn lever(foot: Vec3, end: f32) -> Shell {
    let path = [foot, foot.with_z(0.065), Vec3::new(end, foot.y, 0.065)];
    pipe(&fillet(&path, 0.02, 22.5), 0.009, 10)
}

/// Leaf of an open door about its hinge, which is at x = 0; it runs along +x and shows panels and levers on both
/// faces: parts "door" and "door_furniture".
pub fn door_leaf() -> Assembly {
    let mut leaf = Assembly::new();
    leaf.add("door", &beveled_box([0.004, 0.008, -0.018], [0.892, 2.092, 0.018], 0.002));
    for (degrees, x) in [(0.0, 0.4), (180.0, -0.4)] {
        let face = at(0.448, 0.0, 0.0) * turned(degrees, Vec3::ZERO);
        panels(&mut leaf, face, 0.0165, 0.01);
        leaf.add_at("door_furniture", &lever(Vec3::new(x, 1.05, 0.012), 0.7 * x), face);
    }
    leaf
}

/// Door of six panels in its frame, 0.9 x 2.1 m, on the wall z = 0 with its middle at x = 0: parts "door", "trim" and
/// "door_furniture".
pub fn door() -> Assembly {
    let mut door = Assembly::new();
    let (width, height) = (0.9, 2.1);
    door.add_at("trim", &casing(Vec2::new(width, height), 0.09, false), at(-0.5 * width, 0.0, 0.0));
    door.add("door", &beveled_box([-0.448, 0.006, 0.0], [0.448, height - 0.003, 0.012], 0.002));
    panels(&mut door, Affine3A::IDENTITY, 0.0105, 0.012);
    door.add("door_furniture", &beveled_box([-0.425, 0.93, 0.012], [-0.385, 1.13, 0.018], 0.002));
    door.add("door_furniture", &lever(Vec3::new(-0.405, 1.05, 0.015), -0.285));
    door
}
