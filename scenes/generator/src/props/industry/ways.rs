//! Ways to walk: gratings of bearing bars and cross rods, railings, stairs and caged ladders.

use super::steel::{bar, channel_section, i_section};
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

/// Grating from `corner` over `across` and `along`, bearing bars across at `pitch`.
pub fn grating(part: &str, corner: Vec3, across: Vec3, along: Vec3, pitch: f32) -> Assembly {
    let mut grating = Assembly::new();
    let length = along.length();
    let direction = along / length;
    let count = (length / pitch).floor() as usize;
    let depth = 0.03;
    for k in 0..=count {
        let foot = corner + direction * (pitch * k as f32).min(length - 0.003);
        let half = direction * 0.0022;
        // Open at the bottom and the ends, which are never visible: three faces a bar.
        let ring = [foot - half - Vec3::Y * depth, foot - half, foot + half, foot + half - Vec3::Y * depth];
        let rows = [ring.to_vec(), ring.map(|p| p + across).to_vec()];
        grating.add(part, &grid(&rows, false, false, 20.0).facing(foot + 0.5 * across + Vec3::Y));
    }
    let rods = (across.length() / 0.12).round() as usize;
    for k in 0..=rods {
        let foot = corner + across * (k as f32 / rods as f32 * 0.996 + 0.002) - Vec3::Y * 0.006;
        grating.add(part, &rod(foot, foot + along, 0.004, 4));
    }
    grating
}

/// Railing along `path`, the level at which people stand: posts, handrail, knee rail and toe board.
pub fn railing(part: &str, path: &[Vec3]) -> Assembly {
    let mut railing = Assembly::new();
    for (height, radius, segments) in [(1.1, 0.024, 8), (0.58, 0.017, 6)] {
        let raised: Vec<Vec3> = path.iter().map(|p| *p + Vec3::Y * height).collect();
        railing.add(part, &pipe(&fillet(&raised, 0.12, 30.0), radius, segments));
    }
    let board = rectangle(Vec2::new(-0.003, -0.06), Vec2::new(0.003, 0.06));
    for ends in path.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        let count = (a.distance(b) / 1.4).ceil().max(1.0) as usize;
        for k in 0..=count {
            let foot = a.lerp(b, (k as f32 / count as f32).clamp(0.004, 0.996));
            railing.add(part, &rod(foot - Vec3::Y * 0.1, foot + Vec3::Y * 1.09, 0.02, 8));
        }
        let up = Vec3::Y * 0.075;
        if (b - a).normalize().y.abs() < 0.1 {
            railing.add(part, &bar(&board, a + up, b + up, Vec3::Y));
        }
    }
    railing
}

/// Flight down towards +z from `head`, the corner of the landing, on the side of +x: parts "walkway_steel",
/// "gratings", "railings".
pub fn stairs(head: Vec3) -> Assembly {
    let mut stairs = Assembly::new();
    let (width, rise, going) = (0.9, 0.21, 0.255);
    let steps = (head.y / rise).round() as usize;
    let foot = Vec3::new(head.x, 0.0, head.z + going * steps as f32);
    let stringer = channel_section(0.24, 0.07, 0.008);
    let v = Vec3::new;
    // The rail of the outer side goes on along the landing; a channel is open to the right of its direction.
    for outer in [false, true] {
        let x = if outer { head.x + width } else { head.x };
        let (low, high) = (v(x, 0.08, foot.z - 0.02), v(x, head.y - 0.06, head.z - 0.3));
        let (from, to) = if outer { (low, high) } else { (high, low) };
        stairs.add("walkway_steel", &bar(&stringer, from, to, Vec3::Y));
        let rail = [v(x, 0.0, foot.z), v(x, head.y, head.z - 0.05), v(x, head.y, head.z - 0.95)];
        stairs.merge(railing("railings", if outer { &rail[..] } else { &rail[..2] }));
    }
    for k in 0..steps {
        let (y, z) = (head.y - rise * k as f32, head.z + going * k as f32);
        let corner = v(head.x + 0.02, y - 0.01, z - 0.3);
        stairs.merge(grating("gratings", corner, Vec3::X * (width - 0.04), Vec3::Z * 0.28, 0.035));
        let low = [head.x + 0.02, y - 0.045, z - 0.022];
        stairs.add("walkway_steel", &block(low, [head.x + width - 0.02, y - 0.004, z + 0.012]));
    }
    // A landing from the flight to the catwalk.
    let corner = v(head.x - 0.05, head.y - 0.002, head.z - 0.28);
    stairs.merge(grating("gratings", corner, Vec3::X * (width + 0.05), Vec3::NEG_Z * 0.75, 0.045));
    let support = i_section(0.16, 0.1, 0.01, 0.007);
    for z in [head.z - 0.35, head.z - 1.0] {
        let y = head.y - 0.13;
        stairs.add("walkway_steel", &bar(&support, [head.x - 0.3, y, z], [head.x + width, y, z], Vec3::Y));
    }
    let (x, z) = (head.x + width - 0.06, head.z - 1.0);
    let post = bar(&i_section(0.12, 0.12, 0.01, 0.007), [x, -0.02, z], [x, head.y - 0.2, z], Vec3::X);
    stairs.add("walkway_steel", &post);
    stairs
}

/// Ladder in the plane z = 0 of `place`, climbing `height`, with a safety cage towards +z.
pub fn ladder(part: &str, place: Affine3A, height: f32) -> Assembly {
    let mut ladder = Assembly::framed(place);
    for x in [-0.22, 0.22] {
        ladder.add(part, &rod([x, -0.02, 0.0], [x, height + 0.9, 0.0], 0.02, 8));
    }
    let rungs = (height / 0.28) as usize;
    for k in 1..=rungs {
        let y = 0.28 * k as f32;
        ladder.add(part, &rod([-0.22, y, 0.0], [0.22, y, 0.0], 0.012, 6));
    }
    let hoop = ring(0.345, 0.352, -0.03, 0.03, 14);
    let mut y = 2.2;
    while y < height + 0.8 {
        ladder.add_at(part, &hoop, at(0.0, y, 0.3));
        y += 0.8;
    }
    if height > 2.4 {
        let strip = cylinder(0.012, height + 0.8 - 2.2, 5);
        for k in 0..5 {
            let mut side = Assembly::framed(place * turned(36.0 * k as f32 - 162.0, [0.0, 2.17, 0.3]));
            side.add_at(part, &strip, at(0.335, 0.0, 0.0));
            ladder.merge(side);
        }
    }
    ladder
}
