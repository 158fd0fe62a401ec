//! Pipes with welded bends, bolted flanges, valves with handwheels, hangers and gauges. All stand where their
//! arguments say.

use super::steel::bolt;
use crate::shapes::*;
use glam::{Affine3A, Vec3};

/// Half sections of a valve in radii of its pipe.
#[rustfmt::skip]
mod section {
    pub const BODY: [[f32; 2]; 9] = [[0.0, -2.2], [1.05, -2.2], [1.1, -1.3], [1.55, -0.6], [1.7, 0.0], [1.55, 0.6],
        [1.1, 1.3], [1.05, 2.2], [0.0, 2.2]];
    pub const BONNET: [[f32; 2]; 9] = [[0.9, 1.0], [0.9, 2.0], [1.4, 2.0], [1.4, 2.35], [0.6, 2.5], [0.45, 3.6],
        [0.2, 3.7], [0.2, 5.2], [0.0, 5.2]];
}

/// Pipe along `path` with bends of 1.5 diameters and a flange at either end.
pub fn run(part: &str, path: &[Vec3], radius: f32, segments: usize) -> Assembly {
    let mut run = Assembly::new();
    run.add(part, &pipe(&fillet(path, 3.0 * radius, 18.0), radius, segments));
    let last = path.len() - 1;
    for (end, next) in [(path[0], path[1]), (path[last], path[last - 1])] {
        // Where the pipe goes through the floor there is none to be seen.
        if end.y > 0.0 {
            run.merge(flange(part, end, next - end, radius));
        }
    }
    run
}

/// Flange at `foot`, looking back from the pipe that leaves along `direction`; a ring of bolts holds it.
pub fn flange(part: &str, foot: Vec3, direction: Vec3, radius: f32) -> Assembly {
    let direction = direction.normalize();
    let (outer, thick) = (1.65 * radius + 0.02, 0.22 * radius + 0.012);
    let mut flange = Assembly::framed(standing_on(foot, foot + direction));
    flange
        .add(part, &lathe(&[[0.6 * radius, 0.0], [outer, 0.0], [outer, thick], [1.25 * radius, thick]], 12));
    let head = bolt([0.5 * (outer + 1.25 * radius), thick, 0.0], Vec3::Y, 0.26 * radius + 0.012);
    flange.add_each(part, &head, turns(6));
    flange
}

/// Two flanges face to face about `middle`.
pub fn joint(part: &str, middle: Vec3, direction: Vec3, radius: f32) -> Assembly {
    let gap = 0.003 * direction.normalize();
    let mut joint = flange(part, middle + gap, direction, radius);
    joint.merge(flange(part, middle - gap, -direction, radius));
    joint
}

/// Globe valve about `middle` in a pipe along `direction`, its stem and handwheel towards `stem`: parts `body` and
/// `wheel`.
pub fn valve(body: &str, wheel: &str, middle: Vec3, direction: Vec3, stem: Vec3, radius: f32) -> Assembly {
    let mut valve = Assembly::new();
    let shape = lathe(&scaled(&section::BODY, radius), 12);
    valve.add_at(body, &shape, standing_on(middle, middle + direction));
    let direction = direction.normalize();
    let half = 2.2 * radius;
    valve.merge(flange(body, middle + direction * half, -direction, radius));
    valve.merge(flange(body, middle - direction * half, direction, radius));
    let up = standing_on(middle, middle + stem);
    valve.add_at(body, &lathe(&scaled(&section::BONNET, radius), 10), up);
    valve.merge(handwheel(wheel, up * at(0.0, 4.7 * radius, 0.0), 1.5 * radius + 0.04));
    valve
}

/// Handwheel in the plane y = 0 of `place`.
fn handwheel(part: &str, place: Affine3A, radius: f32) -> Assembly {
    let mut wheel = Assembly::framed(place);
    wheel.add(part, &torus(radius, 0.09 * radius, 16, 5));
    wheel.add_at(part, &cylinder(0.2 * radius, 0.2 * radius, 8), at(0.0, -0.1 * radius, 0.0));
    for k in 0..4 {
        let end = turned(90.0 * k as f32 + 20.0, Vec3::ZERO).transform_point3(Vec3::X * radius);
        wheel.add(part, &rod(0.12 * end, end, 0.06 * radius, 4));
    }
    wheel
}

/// Strap round a horizontal pipe about `middle`, on two rods up to `height`.
pub fn hanger(part: &str, middle: Vec3, along: Vec3, radius: f32, height: f32) -> Assembly {
    let mut hanger = Assembly::new();
    let (inner, outer) = (1.0 * radius + 0.004, 1.12 * radius + 0.004);
    hanger.add_at(part, &ring(inner, outer, -0.03, 0.03, 16), standing_on(middle, middle + along));
    let across = along.cross(Vec3::Y).normalize() * 1.08 * radius;
    for side in [across, -across] {
        hanger.add(part, &rod(middle + side, (middle + side).with_y(height), 0.01, 5));
    }
    hanger
}

/// Pressure gauge on a short stem above `foot`, its face towards +z turned by `degrees`.
pub fn gauge(part: &str, foot: Vec3, degrees: f32) -> Assembly {
    let mut gauge = Assembly::new();
    gauge.add(part, &cylinder(0.012, 0.16, 6).transformed(at(foot.x, foot.y - 0.02, foot.z)));
    let dial = [[0.0, -0.03], [0.07, -0.03], [0.075, 0.02], [0.065, 0.03], [0.062, 0.02], [0.0, 0.02]];
    let face = standing_on(Vec3::ZERO, Vec3::Z);
    gauge.add_at(part, &lathe(&dial, 16), turned(degrees, foot + Vec3::Y * 0.2) * face);
    gauge
}
