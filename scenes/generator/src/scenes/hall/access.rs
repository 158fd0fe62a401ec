//! Ways to walk: gratings of bearing bars and cross rods, railings, stairs and caged ladders.

use super::plan::{CATWALK, END};
use super::steel::{bar, channel_section, i_section};
use crate::shapes::Part;
use crate::shapes::{at, block, cylinder, fillet, pipe, profile_lathe, rod, turned};
use glam::{Affine3A, Vec2, Vec3};

/// The catwalk's edges across the hall and along it.
pub const EDGES: [f32; 2] = [-11.0, -9.0];
const SPAN: [f32; 2] = [-8.4, END + 3.0];

/// What the ways are made of.
#[derive(Default)]
pub struct Parts {
    /// Beams, stringers, brackets.
    pub steel: Part,
    /// Gratings and treads.
    pub grating: Part,
    /// Railings.
    pub railing: Part,
}

/// Appends the catwalk along the west side, its stairs, and the bridge at its end.
pub fn build(parts: &mut Parts) {
    let [x0, x1] = EDGES;
    let [near, far] = SPAN;
    grating(
        &mut parts.grating,
        Vec3::new(x0, CATWALK, near),
        Vec3::X * (x1 - x0),
        Vec3::Z * (far - near),
        0.045,
    );
    let edge = channel_section(0.2, 0.07, 0.008);
    for (x, from, to) in [(x1, near, far), (x0, far, near)] {
        // Travelling west to east along -z the section's +x is +x; the other way round on the other edge.
        let y = CATWALK - 0.101;
        parts.steel.add(&bar(&edge, Vec3::new(x, y, from), Vec3::new(x, y, to), Vec3::Y));
    }
    let beam = i_section(0.16, 0.1, 0.01, 0.007);
    let mut z = near - 0.1;
    while z > far {
        let y = CATWALK - 0.13;
        parts.steel.add(&bar(&beam, Vec3::new(x0 - 0.3, y, z), Vec3::new(x1, y, z), Vec3::Y));
        parts.steel.add(&rod(Vec3::new(x1 - 0.1, y - 0.05, z), Vec3::new(x0 - 0.2, y - 1.2, z), 0.03, 6));
        z -= 2.5;
    }
    railing(
        &mut parts.railing,
        &[
            Vec3::new(x1 - 0.03, CATWALK, near - 1.1),
            Vec3::new(x1 - 0.03, CATWALK, far),
            Vec3::new(x0, CATWALK, far),
        ],
    );
    railing(
        &mut parts.railing,
        &[
            Vec3::new(x0 + 0.05, CATWALK, far),
            Vec3::new(x0 + 0.05, CATWALK, near),
            Vec3::new(x1, CATWALK, near),
        ],
    );
    stairs(parts, Vec3::new(x1 + 0.04, CATWALK, near - 0.05));
    ladder(&mut parts.railing, &at(-10.2, CATWALK, END + 0.35), 4.6);
}

/// A grating from `corner` over `across` and `along`, bearing bars across at `pitch`.
pub fn grating(part: &mut Part, corner: Vec3, across: Vec3, along: Vec3, pitch: f32) {
    let length = along.length();
    let direction = along / length;
    let count = (length / pitch).floor() as usize;
    let depth = 0.03;
    for k in 0..=count {
        let foot = corner + direction * (pitch * k as f32).min(length - 0.003);
        let half = direction * 0.0022;
        // Open at the bottom and the ends, which nobody sees: three faces a bar.
        let ring = [foot - half - Vec3::Y * depth, foot - half, foot + half, foot + half - Vec3::Y * depth];
        let rows = [ring.to_vec(), ring.map(|p| p + across).to_vec()];
        let sheet = crate::shapes::grid(&rows, false, false, 20.0);
        let up = sheet.facing(foot + 0.5 * across + Vec3::Y);
        part.add(&up);
    }
    let rods = (across.length() / 0.12).round() as usize;
    for k in 0..=rods {
        let foot = corner + across * (k as f32 / rods as f32 * 0.996 + 0.002) - Vec3::Y * 0.006;
        part.add(&rod(foot, foot + along, 0.004, 4));
    }
}

/// A railing along `path`, the level at which people stand: posts, handrail, knee rail and toe board.
pub fn railing(part: &mut Part, path: &[Vec3]) {
    for (height, radius, segments) in [(1.1, 0.024, 8), (0.58, 0.017, 6)] {
        let raised: Vec<Vec3> = path.iter().map(|p| *p + Vec3::Y * height).collect();
        part.add(&pipe(&fillet(&raised, 0.12, 30.0), radius, segments));
    }
    for ends in path.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        let count = (a.distance(b) / 1.4).ceil().max(1.0) as usize;
        for k in 0..=count {
            let foot = a.lerp(b, (k as f32 / count as f32).clamp(0.004, 0.996));
            part.add(&rod(foot - Vec3::Y * 0.1, foot + Vec3::Y * 1.09, 0.02, 8));
        }
        let up = Vec3::Y * 0.075;
        let board = crate::shapes::rectangle(Vec2::new(-0.003, -0.06), Vec2::new(0.003, 0.06));
        if (b - a).normalize().y.abs() < 0.1 {
            part.add(&bar(&board, a + up, b + up, Vec3::Y));
        }
    }
}

/// A flight down towards +z from `head`, the corner of the landing, on the side of +x.
fn stairs(parts: &mut Parts, head: Vec3) {
    let (width, rise, going) = (0.9, 0.21, 0.255);
    let steps = (head.y / rise).round() as usize;
    let foot = Vec3::new(head.x, 0.0, head.z + going * steps as f32);
    let stringer = channel_section(0.24, 0.07, 0.008);
    for (x, flip) in [(head.x, true), (head.x + width, false)] {
        let (a, b) = (Vec3::new(x, 0.08, foot.z - 0.02), Vec3::new(x, head.y - 0.06, head.z - 0.3));
        let (a, b) = if flip { (b, a) } else { (a, b) };
        parts.steel.add(&bar(&stringer, a, b, Vec3::Y));
        let rail = [
            Vec3::new(x, 0.0, foot.z),
            Vec3::new(x, head.y, head.z - 0.05),
            Vec3::new(x, head.y, head.z - 0.95),
        ];
        let rail = if flip { rail[..2].to_vec() } else { rail.to_vec() };
        railing(&mut parts.railing, &rail);
    }
    for k in 0..steps {
        let y = head.y - rise * k as f32;
        let z = head.z + going * k as f32;
        grating(
            &mut parts.grating,
            Vec3::new(head.x + 0.02, y - 0.01, z - 0.3),
            Vec3::X * (width - 0.04),
            Vec3::Z * 0.28,
            0.035,
        );
        let nosing = block(
            Vec3::new(head.x + 0.02, y - 0.045, z - 0.022),
            Vec3::new(head.x + width - 0.02, y - 0.004, z + 0.012),
        );
        parts.steel.add(&nosing);
    }
    // A landing from the flight to the catwalk.
    grating(
        &mut parts.grating,
        Vec3::new(head.x - 0.05, head.y - 0.002, head.z - 0.28),
        Vec3::X * (width + 0.05),
        Vec3::NEG_Z * 0.75,
        0.045,
    );
    let support = i_section(0.16, 0.1, 0.01, 0.007);
    for z in [head.z - 0.35, head.z - 1.0] {
        parts.steel.add(&bar(
            &support,
            Vec3::new(head.x - 0.3, head.y - 0.13, z),
            Vec3::new(head.x + width, head.y - 0.13, z),
            Vec3::Y,
        ));
    }
    let x = head.x + width - 0.06;
    let (foot, top) = (Vec3::new(x, -0.02, head.z - 1.0), Vec3::new(x, head.y - 0.2, head.z - 1.0));
    parts.steel.add(&bar(&i_section(0.12, 0.12, 0.01, 0.007), foot, top, Vec3::X));
}

/// A ladder in the plane z = 0 of `place`, climbing `height`, with a safety cage towards +z.
pub fn ladder(part: &mut Part, place: &Affine3A, height: f32) {
    for x in [-0.22, 0.22] {
        part.add_at(&rod(Vec3::new(x, -0.02, 0.0), Vec3::new(x, height + 0.9, 0.0), 0.02, 8), place);
    }
    let rungs = (height / 0.28) as usize;
    for k in 1..=rungs {
        let y = 0.28 * k as f32;
        part.add_at(&rod(Vec3::new(-0.22, y, 0.0), Vec3::new(0.22, y, 0.0), 0.012, 6), place);
    }
    let hoop = [(0.345, -0.03), (0.352, -0.03), (0.352, 0.03), (0.345, 0.03)].map(|(x, y)| Vec2::new(x, y));
    let mut y = 2.2;
    while y < height + 0.8 {
        part.add_at(&profile_lathe(&hoop, 14), &(*place * at(0.0, y, 0.3)));
        y += 0.8;
    }
    if height > 2.4 {
        for k in 0..5 {
            let turn = turned(36.0 * k as f32 - 162.0, Vec3::new(0.0, 2.17, 0.3));
            let strip = cylinder(0.012, height + 0.8 - 2.2, 5);
            part.add_at(&strip, &(*place * turn * at(0.335, 0.0, 0.0)));
        }
    }
}
