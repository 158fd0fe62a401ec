//! Lamps. The emitting surface is a part of its own, so that the scene file says how bright it is.

use crate::shapes::*;
use glam::{Affine3A, Quat, Vec2};

#[rustfmt::skip]
const VASE: [[f32; 2]; 7] = [[0.06, 0.0], [0.062, 0.012], [0.04, 0.03], [0.075, 0.11], [0.07, 0.17], [0.022, 0.22],
    [0.018, 0.26]];

/// Round light in or under a ceiling, its top at y = 0: a ring, part `case`, around a disc, part `light`.
pub fn downlight(case: &str, light: &str, radius: f32) -> Assembly {
    let mut lamp = Assembly::new();
    lamp.add(case, &ring(radius, 1.3 * radius, -0.018, 0.0, 24));
    let downwards = Affine3A::from_quat(Quat::from_rotation_x(std::f32::consts::PI));
    lamp.add_at(light, &disc(radius + 1e-3, 24), at(0.0, -0.006, 0.0) * downwards);
    lamp
}

/// Lamp that hangs by `cord` metres from y = 0, its glowing bulb (part `light`) in an open metal shade.
pub fn pendant(light: &str, cord: f32) -> Assembly {
    let mut lamp = Assembly::new();
    lamp.add("lamp_metal", &lathe(&[[0.0, -0.02], [0.05, -0.02], [0.05, 0.0]], 20));
    lamp.add("cord", &rod([0.0, -0.015, 0.0], [0.0, -cord, 0.0], 0.004, 8));
    let outer = spline(&[[0.16, 0.0], [0.15, 0.06], [0.11, 0.125], [0.045, 0.165], [0.03, 0.2]], 2);
    let inner: Vec<Vec2> = outer.iter().rev().map(|p| *p - Vec2::new(0.004, 0.0)).collect();
    let profile = [&[Vec2::new(0.0, 0.195)], &inner[..], &outer, &[Vec2::new(0.0, 0.2)]].concat();
    lamp.add_at("shade", &lathe(&profile, 24), at(0.0, -cord - 0.2, 0.0));
    lamp.add_at(light, &ellipsoid([0.042, 0.05, 0.042], 16, 10), at(0.0, -cord - 0.11, 0.0));
    lamp
}

/// Floor lamp of `height` that throws all its light up: the glowing disc, part `light`, lies in a bowl.
pub fn uplighter(light: &str, height: f32) -> Assembly {
    let mut lamp = Assembly::new();
    let foot = spline(&[[0.15, 0.0], [0.15, 0.012], [0.06, 0.03], [0.014, 0.05]], 2);
    lamp.add("lamp_metal", &lathe(&foot, 28));
    lamp.add_at("lamp_metal", &cylinder(0.014, height - 0.14, 14), at(0.0, 0.045, 0.0));
    let outside = spline(&[[0.02, -0.11], [0.08, -0.09], [0.14, -0.045], [0.17, 0.0]], 4);
    let mut profile = vec![Vec2::new(0.0, -0.11)];
    profile.extend(&outside);
    profile.extend(outside.iter().rev().map(|p| Vec2::new(p.x - 0.004, p.y)).filter(|p| p.y > -0.04));
    profile.push(Vec2::new(0.0, -0.045));
    lamp.add_at("lamp_metal", &lathe(&profile, 22), at(0.0, height, 0.0));
    lamp.add_at(light, &disc(0.1, 24), at(0.0, height - 0.03, 0.0));
    lamp
}

/// Lamp with a cloth shade (part "lamp_shade") open above and below around its bulb (part `light`): on a
/// turned vase of about 0.3 m, or, with a `pole`, on a foot and that much higher.
pub fn shaded(light: &str, pole: f32) -> Assembly {
    let mut lamp = Assembly::new();
    let base = if pole > 0.0 {
        lamp.add("lamp_metal", &lathe(&[[0.14, 0.0], [0.14, 0.012], [0.013, 0.03]], 28));
        lamp.add_at("lamp_metal", &cylinder(0.012, pole, 14), at(0.0, 0.02, 0.0));
        pole
    } else {
        lamp.add("vases", &spindle(&VASE, 2, 20));
        0.25
    };
    let scale = if pole > 0.0 { 1.35 } else { 1.0 };
    let shade = [[0.095, 0.245], [0.145, 0.0], [0.148, 0.0], [0.098, 0.245]];
    lamp.add_at("lamp_shade", &profile_lathe(&scaled(&shade, scale), 24), at(0.0, base + 0.01, 0.0));
    lamp.add_at("lamp_metal", &cylinder(0.006, 0.06, 8), at(0.0, base - 0.005, 0.0));
    lamp.add_at(light, &ellipsoid([0.035, 0.045, 0.035], 14, 8), at(0.0, base + 0.095, 0.0));
    lamp
}
