//! Compound piers: a notched core with attached shafts that have moulded bases and bell capitals, after the
//! Early English manner. The shafts towards the nave run on up to the high vault.

use super::plan::{ARCADE_SPRING, BAYS, NAVE, PIER, VAULT_SPRING, pier_z};
use crate::shapes::*;
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Half the core across the nave and along it.
const CORE: Vec2 = Vec2::new(0.5, 0.56);
/// Height of the plinth under the shafts' bases.
pub const PLINTH: f32 = 0.42;

/// All free piers of both sides, and half piers against the west wall and the chancel arch.
pub fn add(scene: &mut Assembly) {
    let pier = pier();
    for line in 0..=BAYS {
        for side in both_sides() {
            scene.place(&pier, side * at(PIER, 0.0, pier_z(line)));
        }
    }
}

/// Half of a turned shaft that shows towards -x.
pub fn half_shaft(profile: &[Vec2], segments: usize) -> Shell {
    lathe_sector(profile, 80.0, 280.0, segments)
}

/// One pier about the origin; the nave lies towards -x.
fn pier() -> Assembly {
    let mut pier = Assembly::new();
    pier.add("piers", &beveled_box([-0.95, -0.05, -1.08], [0.95, 0.2, 1.08], 0.04));
    pier.add("piers", &beveled_box([-0.84, 0.15, -0.97], [0.84, PLINTH, 0.97], 0.06));
    pier.add("piers", &core(ARCADE_SPRING));
    // Shafts look towards -x; they are turned to the other sides.
    let face = |degrees: f32, distance: f32, aside: f32| {
        Affine3A::from_quat(Quat::from_rotation_y(degrees.to_radians())) * at(-distance, 0.0, aside)
    };
    let shaft = |radius: f32, top: f32| half_shaft(&shaft_profile(radius, PLINTH, top), 6);
    let arcade = shaft(0.26, ARCADE_SPRING);
    pier.add_each("piers", &arcade, [90.0, 270.0].map(|degrees| face(degrees, CORE.y, 0.0)));
    pier.add_at("piers", &shaft(0.2, ARCADE_SPRING), face(180.0, CORE.x, 0.0));
    let thin = half_shaft(&thin_shaft_profile(0.085, PLINTH, ARCADE_SPRING), 4);
    for degrees in [90.0, 270.0] {
        pier.add_each("piers", &thin, [0.38, -0.38].map(|aside| face(degrees, CORE.y, aside)));
    }
    // The vaulting shafts, three together.
    pier.add_at("piers", &shaft(0.2, VAULT_SPRING), face(0.0, PIER - NAVE, 0.0));
    let tall = half_shaft(&thin_shaft_profile(0.1, PLINTH, VAULT_SPRING), 5);
    pier.add_each("piers", &tall, [-0.31, 0.31].map(|aside| face(0.0, PIER - NAVE, aside)));
    // Shaft rings bind the three at the string course.
    let ring = points(&[[0.12, -0.1], [0.19, -0.07], [0.21, 0.0], [0.19, 0.07], [0.12, 0.1]]);
    for (scale, aside) in [(1.35, 0.0), (0.8, -0.31), (0.8, 0.31)] {
        let size = Affine3A::from_scale(Vec3::new(scale, 1.0, scale));
        let place = face(0.0, PIER - NAVE, aside) * at(0.0, 8.7, 0.0) * size;
        pier.add_at("piers", &half_shaft(&ring, 6), place);
    }
    pier
}

/// Core: a rectangle with notched corners, without ends.
fn core(top: f32) -> Shell {
    let notch = 0.12;
    let quadrant = [[CORE.x, CORE.y - notch], [CORE.x - notch, CORE.y - notch], [CORE.x - notch, CORE.y]];
    let mirror = |sx: f32, sy: f32| scaled(&quadrant, Vec2::new(sx, sy));
    let mut outline = mirror(1.0, 1.0);
    outline.extend(mirror(-1.0, 1.0).iter().rev());
    outline.extend(mirror(-1.0, -1.0));
    outline.extend(mirror(1.0, -1.0).iter().rev());
    // Laid down in x and y, then stood up: y becomes -z.
    extrude_faces(&outline, &[], top + 0.02 - 0.15, Faces::NO_ENDS)
        .mapped(|p| Vec3::new(p.x, p.z + 0.15, -p.y))
}

/// Profile of a shaft too thin for mouldings: a sloped base and a plain bell.
pub fn thin_shaft_profile(radius: f32, bottom: f32, top: f32) -> Vec<Vec2> {
    let base = [(1.9, bottom), (1.9, bottom + 0.1), (1.0, bottom + 0.2)];
    let neck = [(1.0, top - 0.34), (1.3, top - 0.3), (1.05, top - 0.26)];
    let bell = [(1.2, top - 0.14), (1.9, top - 0.06), (1.9, top + 0.01)];
    scaled(&[base, neck, bell].concat(), Vec2::new(radius, 1.0))
}

/// Base, shaft, astragal, bell and abacus as one profile from `bottom` to `top`.
pub fn shaft_profile(radius: f32, bottom: f32, top: f32) -> Vec<Vec2> {
    let r = radius;
    let unit = 0.5 * (r + 0.22);
    let mut profile = vec![Vec2::new(1.5 * r + 0.03, bottom)];
    let y = bottom + 0.12 * unit;
    profile.extend(arc(Vec2::new(1.5 * r, y + 0.14 * unit), 0.14 * unit, -40.0, 80.0, 2));
    profile.push(Vec2::new(1.25 * r, y + 0.62 * unit));
    profile.push(Vec2::new(r, y + 0.78 * unit));
    let bell = top - 1.5 * unit;
    profile.push(Vec2::new(r, bell - 0.12 * unit));
    profile.push(Vec2::new(r + 0.13 * unit, bell - 0.05 * unit));
    // The bell flares with increasing slope, then the abacus in two rolls.
    for k in 0..=2 {
        let t = 0.2 + 0.4 * k as f32;
        profile.push(Vec2::new(r * (1.0 + 0.5 * t * t * t) + 0.02 * t, bell + (0.1 + 0.85 * t) * unit));
    }
    profile.push(Vec2::new(1.8 * r, top - 0.42 * unit));
    profile.push(Vec2::new(1.85 * r, top + 0.01));
    profile.push(Vec2::new(0.3 * r, top + 0.01));
    profile
}
