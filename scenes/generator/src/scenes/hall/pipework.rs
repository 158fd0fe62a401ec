//! Pipes with welded bends, bolted flanges, valves with handwheels, and hangers.

use super::steel::bolt;
use crate::shapes::Part;
use crate::shapes::{at, cylinder, fillet, lathe, pipe, profile_lathe, rod, standing_on, torus, turned};
use glam::{Affine3A, Vec2, Vec3};

/// A pipe along `path` with bends of 1.5 diameters and a flange at either end.
pub fn run(part: &mut Part, path: &[Vec3], radius: f32, segments: usize) {
    let bent = fillet(path, 3.0 * radius, 18.0);
    part.add(&pipe(&bent, radius, segments));
    let last = path.len() - 1;
    for (end, next) in [(path[0], path[1]), (path[last], path[last - 1])] {
        // Where the pipe goes through the floor there is none to be seen.
        if end.y > 0.0 {
            flange(part, end, next - end, radius);
        }
    }
}

/// A flange at `foot`, looking back from the pipe that leaves along `direction`; a ring of bolts holds it.
pub fn flange(part: &mut Part, foot: Vec3, direction: Vec3, radius: f32) {
    let direction = direction.normalize();
    let (outer, thick) = (1.65 * radius + 0.02, 0.22 * radius + 0.012);
    let place = standing_on(foot, foot + direction);
    let profile: Vec<Vec2> = [(0.6 * radius, 0.0), (outer, 0.0), (outer, thick), (1.25 * radius, thick)]
        .map(|(x, y)| Vec2::new(x, y))
        .to_vec();
    part.add_at(&lathe(&profile, 12), &place);
    let bolts = 6;
    for k in 0..bolts {
        let turn = turned(360.0 / bolts as f32 * k as f32, Vec3::ZERO);
        let head = bolt(Vec3::new(0.5 * (outer + 1.25 * radius), thick, 0.0), Vec3::Y, 0.26 * radius + 0.012);
        part.add_at(&head, &(place * turn));
    }
}

/// Two flanges face to face about `middle`.
pub fn joint(part: &mut Part, middle: Vec3, direction: Vec3, radius: f32) {
    let gap = 0.003 * direction.normalize();
    flange(part, middle + gap, direction, radius);
    flange(part, middle - gap, -direction, radius);
}

/// A globe valve about `middle` in a pipe along `direction`, its stem and handwheel towards `stem`.
pub fn valve(body: &mut Part, wheel: &mut Part, middle: Vec3, direction: Vec3, stem: Vec3, radius: f32) {
    let r = radius;
    let half = 2.2 * r;
    let profile: Vec<Vec2> = [
        (0.0, -half),
        (1.05 * r, -half),
        (1.1 * r, -1.3 * r),
        (1.55 * r, -0.6 * r),
        (1.7 * r, 0.0),
        (1.55 * r, 0.6 * r),
        (1.1 * r, 1.3 * r),
        (1.05 * r, half),
        (0.0, half),
    ]
    .map(|(x, y)| Vec2::new(x, y))
    .to_vec();
    body.add_at(&lathe(&profile, 12), &standing_on(middle, middle + direction));
    let direction = direction.normalize();
    flange(body, middle + direction * half, -direction, r);
    flange(body, middle - direction * half, direction, r);
    let up = standing_on(middle, middle + stem);
    let bonnet: Vec<Vec2> = [
        (0.9 * r, 1.0 * r),
        (0.9 * r, 2.0 * r),
        (1.4 * r, 2.0 * r),
        (1.4 * r, 2.35 * r),
        (0.6 * r, 2.5 * r),
        (0.45 * r, 3.6 * r),
        (0.2 * r, 3.7 * r),
        (0.2 * r, 5.2 * r),
        (0.0, 5.2 * r),
    ]
    .map(|(x, y)| Vec2::new(x, y))
    .to_vec();
    body.add_at(&lathe(&bonnet, 10), &up);
    handwheel(wheel, &(up * at(0.0, 4.7 * r, 0.0)), 1.5 * r + 0.04);
}

/// A handwheel in the plane y = 0 of `place`.
pub fn handwheel(part: &mut Part, place: &Affine3A, radius: f32) {
    part.add_at(&torus(radius, 0.09 * radius, 16, 5), place);
    part.add_at(&cylinder(0.2 * radius, 0.2 * radius, 8), &(*place * at(0.0, -0.1 * radius, 0.0)));
    for k in 0..4 {
        let end = turned(90.0 * k as f32 + 20.0, Vec3::ZERO).transform_point3(Vec3::X * radius);
        part.add_at(&rod(0.12 * end, end, 0.06 * radius, 4), place);
    }
}

/// A hanger: a strap round a horizontal pipe about `middle`, on two rods up to `height`.
pub fn hanger(part: &mut Part, middle: Vec3, along: Vec3, radius: f32, height: f32) {
    let strap = profile_lathe(
        &[(1.0, -0.03), (1.12, -0.03), (1.12, 0.03), (1.0, 0.03)]
            .map(|(s, y)| Vec2::new(s * radius + 0.004, y)),
        16,
    );
    part.add_at(&strap, &standing_on(middle, middle + along));
    let across = along.cross(Vec3::Y).normalize() * 1.08 * radius;
    for side in [across, -across] {
        part.add(&rod(middle + side, (middle + side).with_y(height), 0.01, 5));
    }
}

/// A pressure gauge on a short stem above `foot`, its face towards +z turned by `degrees`.
pub fn gauge(part: &mut Part, foot: Vec3, degrees: f32) {
    part.add(&cylinder(0.012, 0.16, 6).transformed(&at(foot.x, foot.y - 0.02, foot.z)));
    let dial: Vec<Vec2> =
        [(0.0, -0.03), (0.07, -0.03), (0.075, 0.02), (0.065, 0.03), (0.062, 0.02), (0.0, 0.02)]
            .map(|(x, y)| Vec2::new(x, y))
            .to_vec();
    let face = standing_on(Vec3::ZERO, Vec3::Z);
    part.add_at(&lathe(&dial, 16), &(turned(degrees, foot + Vec3::Y * 0.2) * face));
}
