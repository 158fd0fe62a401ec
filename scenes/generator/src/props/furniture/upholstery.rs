//! Sofas and beds.

use super::framed_panel;
use crate::shapes::*;
use glam::{Quat, Vec2, Vec3};

/// Cushion of `size` about its middle: flat faces, full in the middle, drawn in at the corners.
fn cushion(size: Vec3, segments: usize, rings: usize) -> Shell {
    superellipsoid(0.5 * size, 0.42, 0.28, segments, rings).mapped(|p| {
        let (x, z) = (2.0 * p.x / size.x, 2.0 * p.z / size.z);
        Vec3::new(p.x, p.y * (1.12 - 0.3 * (x * x * z * z) - 0.1 * x.abs().max(z.abs()).powi(4)), p.z)
    })
}

/// Thrown pillow of `size` lying in the plane y = 0, thin at its edges.
fn pillow(size: Vec3) -> Shell {
    superellipsoid(0.5 * size, 0.75, 0.4, 22, 10)
}

/// Sofa with `seats` places, its back at z = 0 and its middle at x = 0: parts `cloth` and "pillows" and,
/// for the feet, "wood".
pub fn sofa(cloth: &str, seats: usize) -> Assembly {
    let mut sofa = Assembly::new();
    let (place, arm, depth) = (0.66, 0.2, 0.92);
    let half = 0.5 * place * seats as f32;
    let outer = half + arm;
    sofa.add_each("wood", &cone(0.018, 0.03, 0.12, 14), feet(outer - 0.08, [0.08, depth - 0.08]));
    sofa.add(cloth, &rounded_box([-half - 0.01, 0.12, 0.1], [half + 0.01, 0.3, depth - 0.03], 0.02, 3));
    let back = rounded_box([-outer, 0.12, 0.0], [outer, 0.8, 0.2], 0.06, 4);
    sofa.add(cloth, &back.mapped(|p| p - Vec3::Z * 0.05 * (p.y - 0.8)));
    for side in [-1.0, 1.0_f32] {
        let (a, b) = (side * half, side * outer);
        sofa.add(cloth, &rounded_box([a.min(b), 0.12, 0.02], [a.max(b), 0.6, depth], 0.065, 4));
    }
    for k in 0..seats {
        let x = (k as f32 + 0.5) * place - half;
        sofa.add_at(cloth, &cushion(Vec3::new(place - 0.01, 0.17, 0.68), 28, 10), at(x, 0.385, 0.57));
        let lean = posed(Quat::from_rotation_x(1.33), [x, 0.66, 0.3]);
        sofa.add_at(cloth, &cushion(Vec3::new(place - 0.02, 0.17, 0.46), 28, 10), lean);
    }
    let thrown = |x: f32, degrees: f32| {
        posed(Quat::from_rotation_y(degrees.to_radians()) * Quat::from_rotation_x(1.1), [x, 0.655, 0.47])
    };
    let places = [thrown(half - 0.26, -14.0), thrown(0.26 - half, 16.0)];
    let count = if seats > 1 { 2 } else { 1 };
    sofa.add_each("pillows", &pillow(Vec3::new(0.42, 0.14, 0.42)), places.into_iter().take(count));
    sofa
}

/// Double bed, 1.6 x 2 m, its head at the wall z = 0 and its middle at x = 0: parts "wood", "linen",
/// "duvet" and "pillows".
pub fn bed() -> Assembly {
    let mut bed = Assembly::new();
    let (half, length) = (0.8, 2.02);
    bed.add("wood", &beveled_box([-half - 0.04, 0.12, 0.03], [half + 0.04, 0.34, length + 0.06], 0.01));
    bed.add_each("wood", &cone(0.022, 0.035, 0.12, 14), feet(half, [0.1, length]));
    bed.add("wood", &beveled_box([-half - 0.08, 0.0, 0.0], [half + 0.08, 1.1, 0.03], 0.006));
    let panels = [0.0, 1.0, 2.0].map(|k| at(-half - 0.06 + 0.575 * k, 0.4, 0.028));
    bed.add_each("wood", &framed_panel(Vec2::new(0.565, 0.66), 0.03, 0.07), panels);
    bed.add("linen", &rounded_box([-half, 0.33, 0.06], [half, 0.56, length + 0.03], 0.05, 4));
    for (part, half, z, lean, small) in [("linen", 0.39, 0.24, 0.5, 1.0), ("pillows", 0.37, 0.4, 0.75, 0.8)] {
        let places = [-half, half].map(|x: f32| {
            let rotation = Quat::from_rotation_y(0.06 * x) * Quat::from_rotation_x(lean);
            posed(rotation, [x, 0.56 + 0.26 * lean * small, z])
        });
        bed.add_each(part, &pillow(Vec3::new(0.7 * small, 0.17, 0.46 * small)), places);
    }
    bed.add("duvet", &duvet(half));
    bed
}

/// Duvet: quilted waves over the mattress, falling over both sides and the foot.
fn duvet(half: f32) -> Shell {
    let (from, to, drop) = (0.62, 2.05, 0.2);
    let reach = half + 0.045 + drop;
    patch(36, 30, |u, v| {
        let across = (2.0 * u - 1.0) * reach;
        let along = from + v * (to + 0.05 + drop - from);
        // Distance past the mattress' edge, sideways and at the foot; the rest falls straight down.
        let side = (across.abs() - half - 0.03).max(0.0);
        let foot = (along - to - 0.03).max(0.0);
        let x = across.clamp(-half - 0.03, half + 0.03) + 0.16 * side * across.signum();
        let z = along.min(to + 0.03) + 0.16 * foot;
        let fall = side.max(foot);
        let soft = 0.012 * (11.0 * across + 1.5 * (3.0 * along).sin()).sin() * (7.0 * along + across).sin();
        let hem = 0.02 * fall / drop * (26.0 * (along + across)).sin();
        let edge = 0.05 * (1.0 - ((v - 0.02) / 0.04).clamp(0.0, 1.0)).powi(2);
        let (hem_x, hem_z) = (hem * f32::from(side > 0.0), hem * f32::from(foot > 0.0));
        Vec3::new(x + hem_x, 0.605 + soft - fall - edge, z + hem_z)
    })
    .flipped()
}
