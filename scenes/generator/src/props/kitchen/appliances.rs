//! Refrigerator, cooker, extractor hood, kettle and toaster.

use super::{BASE_DEPTH, WORKTOP};
use crate::props::furniture::{bar_handle, downlight, on_end};
use crate::shapes::*;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Refrigerator with two doors, 0.68 m wide.
pub fn refrigerator() -> Assembly {
    let mut fridge = Assembly::new();
    fridge.add("fridge", &beveled_box([0.0, 0.06, 0.02], [0.68, 1.88, 0.6], 0.008));
    fridge.add("plinth", &block([0.02, 0.0, 0.04], [0.66, 0.06, 0.57]));
    for (low, high) in [(0.075, 0.63), (0.645, 1.88)] {
        fridge.add("fridge", &rounded_box([0.0, low, 0.605], [0.68, high, 0.665], 0.014, 4));
    }
    fridge.add_at("steel", &bar_handle(0.3, 0.045, 0.009), on_end([0.62, 0.44, 0.663]));
    fridge.add_at("steel", &bar_handle(0.5, 0.045, 0.009), on_end([0.62, 0.98, 0.663]));
    fridge
}

/// Built-in cooker, 0.6 m wide: oven below, gas hob on the worktop.
pub fn cooker() -> Assembly {
    let mut cooker = Assembly::new();
    let top = WORKTOP - 0.035;
    cooker.add("carcass", &block([0.0, 0.1, 0.0], [0.6, top, BASE_DEPTH]));
    cooker.add("plinth", &block(Vec3::ZERO, [0.6, 0.1, BASE_DEPTH - 0.06]));
    let front = BASE_DEPTH + 0.001;
    for (low, high, thick, bevel) in
        [(0.74, top - 0.004, 0.022, 0.003), (0.25, 0.735, 0.026, 0.004), (0.108, 0.245, 0.022, 0.003)]
    {
        cooker.add("steel", &beveled_box([0.003, low, front], [0.597, high, front + thick], bevel));
    }
    let window = rounded_box([0.07, 0.31, front + 0.02], [0.53, 0.62, front + 0.029], 0.006, 3);
    cooker.add("dark_glass", &window);
    cooker.add_at("handles", &bar_handle(0.5, 0.045, 0.009), at(0.3, 0.685, front + 0.024));
    let knob = lathe(&[[0.0, 0.0], [0.02, 0.0], [0.018, 0.022], [0.015, 0.025], [0.0, 0.025]], 18);
    for k in 0..5 {
        let turn = posed(Quat::from_rotation_x(FRAC_PI_2), [0.1 + 0.1 * k as f32, 0.795, front + 0.021]);
        cooker.add_at("hob", &knob, turn);
    }
    hob(&mut cooker);
    cooker
}

fn hob(cooker: &mut Assembly) {
    let plate = rounded_box([0.02, WORKTOP + 0.001, 0.06], [0.58, WORKTOP + 0.011, 0.57], 0.004, 3);
    cooker.add("dark_glass", &plate);
    let deck = WORKTOP + 0.011;
    let burners = [(0.16, 0.19, 0.042), (0.44, 0.19, 0.034), (0.16, 0.43, 0.034), (0.44, 0.43, 0.05)];
    for (x, z, size) in burners {
        cooker.add_at("steel", &ring(0.8 * size, 1.25 * size, 0.0, 0.008, 24), at(x, deck, z));
        let cap = [[0.9, 0.008], [0.95, 0.018], [0.8, 0.024], [0.0, 0.025]];
        let cap = lathe(&spline(&scaled(&cap, Vec2::new(size, 1.0)), 3), 24);
        cooker.add_at("hob", &cap, at(x, deck, z));
        // The grate: a square frame on feet, four fingers towards the flame.
        let (half, high) = (0.115, 0.04);
        let frame = rounded_rectangle(Vec2::splat(2.0 * half), 0.02, 3);
        let line: Vec<Vec3> = frame.iter().map(|p| Vec3::new(p.x, high, p.y)).collect();
        let mut grate = closed_wire(&line, 0.005);
        for (dx, dz) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
            let dir = Vec3::new(dx, 0.0, dz);
            let (tip, root) = (dir * 0.35 * half + Vec3::Y * high, dir * half + Vec3::Y * high);
            grate = grate.joined(&rod(root, tip, 0.005, 6));
            let corner = Vec3::new(dx + dz, 0.0, dz - dx) * (half - 0.012);
            grate = grate.joined(&rod(corner, corner + Vec3::Y * high, 0.005, 6));
        }
        cooker.add_at("hob", &grate, at(x, deck, z));
    }
}

/// Wire of square-ish section along a closed line in a horizontal plane.
fn closed_wire(line: &[Vec3], radius: f32) -> Shell {
    let section = Section { points: &circle(radius, 6), closed: true, crease_degrees: 65.0 };
    sweep_along(section, line, Vec3::Y, true, Faces::ALL)
}

/// Extractor hood, 0.6 m wide, its lower edge at y = 0, the chimney up to `height`; two lights.
pub fn hood(height: f32) -> Assembly {
    let mut hood = Assembly::new();
    let rectangle = |w: f32, d: f32, back: f32, y: f32| {
        [(-0.5, d), (0.5, d), (0.5, back), (-0.5, back)].map(|(x, z)| Vec3::new(0.3 + x * w, y, z)).to_vec()
    };
    let rings = [
        rectangle(0.54, 0.47, 0.03, 0.012),
        rectangle(0.56, 0.48, 0.02, 0.0),
        rectangle(0.6, 0.5, 0.0, 0.0),
        rectangle(0.6, 0.5, 0.0, 0.06),
        rectangle(0.27, 0.27, 0.0, 0.26),
        rectangle(0.27, 0.27, 0.0, height),
    ];
    hood.add("steel", &loft(&rings, true, true, 5.0));
    for x in [0.16, 0.44] {
        hood.place(&downlight("lamp_metal", "hood_light", 0.025), at(x, 0.012, 0.32));
    }
    let rail = [[0.02, 0.03, 0.5], [0.02, 0.03, 0.53], [0.58, 0.03, 0.53], [0.58, 0.03, 0.5]];
    hood.add("handles", &pipe(&fillet(&rail, 0.012, 30.0), 0.006, 8));
    hood
}

/// Kettle with spout, lid and handle.
pub fn kettle() -> Assembly {
    let mut kettle = Assembly::new();
    let body =
        spline(&[[0.07, 0.0], [0.095, 0.015], [0.098, 0.06], [0.08, 0.12], [0.05, 0.15], [0.045, 0.155]], 4);
    let lid = points(&[[0.03, 0.168], [0.01, 0.172], [0.0, 0.172]]);
    kettle.add("pots", &lathe(&[&[Vec2::ZERO], &body[..], &lid].concat(), 24));
    kettle.add_at("hob", &ellipsoid(Vec3::splat(0.012), 12, 8), at(0.0, 0.18, 0.0));
    let spout = [[0.07, 0.06, 0.022], [0.11, 0.09, 0.016], [0.135, 0.14, 0.012], [0.15, 0.15, 0.012]];
    kettle.add("pots", &tapering(&spout));
    let grip = [[-0.06, 0.13, 0.0], [-0.075, 0.21, 0.0], [0.03, 0.23, 0.0], [0.055, 0.145, 0.0]];
    kettle.add("hob", &pipe(&fillet(&grip, 0.05, 15.0), 0.008, 10));
    kettle
}

/// Tapering tube in the plane z = 0 through (x, y, radius).
fn tapering(stations: &[[f32; 3]]) -> Shell {
    let line = spline3(stations, 4);
    let rings: Vec<Vec<Vec3>> = (0..line.len())
        .map(|k| {
            let (a, b) = (line[k.saturating_sub(1)], line[(k + 1).min(line.len() - 1)]);
            let tangent = Vec3::new(b.x - a.x, b.y - a.y, 0.0).normalize();
            let up = Vec3::new(-tangent.y, tangent.x, 0.0);
            let circle = (0..14).map(|i| (std::f32::consts::TAU * i as f32 / 14.0).sin_cos());
            let centre = Vec3::new(line[k].x, line[k].y, 0.0);
            circle.map(|(sin, cos)| centre + line[k].z * (up * cos + Vec3::Z * sin)).collect()
        })
        .collect();
    loft(&rings, true, true, 60.0)
}

/// Toaster with two slots.
pub fn toaster() -> Assembly {
    let mut toaster = Assembly::new();
    let levels = [(0.006, 0.0), (0.0, 0.01), (0.0, 0.13), (0.004, 0.15), (0.014, 0.165), (0.03, 0.172)];
    toaster.add("steel", &stacked(Vec2::new(0.28, 0.16), 0.04, 5, &levels, true, true));
    for z in [-0.028, 0.028] {
        toaster.add("hob", &rounded_box([-0.09, 0.165, z - 0.011], [0.09, 0.1735, z + 0.011], 0.004, 2));
    }
    toaster.add("hob", &rounded_box([0.135, 0.09, -0.02], [0.165, 0.105, 0.02], 0.005, 3));
    toaster
}
