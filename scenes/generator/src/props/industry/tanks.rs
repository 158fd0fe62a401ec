//! Vessels: standing tanks with dished heads on legs, a lying tank on saddles, with manholes and pipes: parts
//! "tank_shells", "tank_frames", "tank_pipes", "tank_handwheels".

use super::pipework::{flange, gauge, run, valve};
use super::steel::bolt;
use super::ways::ladder;
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

const SHELL: &str = "tank_shells";
const FRAME: &str = "tank_frames";
const PIPES: &str = "tank_pipes";
const WHEELS: &str = "tank_handwheels";

/// Profile of a vessel with dished ends of height `rise`, from its bottom crown to its top one; the shell's lower seam
/// is at 0.
fn vessel(radius: f32, height: f32, rise: f32) -> Vec<Vec2> {
    const STEPS: usize = 7;
    let dish: Vec<Vec2> = (0..=STEPS)
        .map(|k| {
            let t = std::f32::consts::FRAC_PI_2 * k as f32 / STEPS as f32;
            Vec2::new(if k == STEPS { 0.0 } else { radius * t.cos().powf(0.7) }, rise * t.sin())
        })
        .collect();
    let bottom = dish.iter().rev().map(|p| Vec2::new(p.x, -p.y));
    bottom.chain(dish.iter().map(|p| Vec2::new(p.x, p.y + height))).collect()
}

/// Standing tank in the frame `place` with its feet on the floor.
pub fn standing_tank(place: Affine3A, radius: f32, height: f32) -> Assembly {
    let mut tank = Assembly::framed(place);
    let bottom = 1.25;
    let body = at(0.0, bottom, 0.0);
    tank.add_at(SHELL, &lathe(&vessel(radius, height, 0.34 * radius), 40), body);
    for y in [0.02, 0.5 * height, height - 0.05] {
        tank.add_at(SHELL, &ring(radius - 0.01, radius + 0.035, y - 0.04, y + 0.04, 40), body);
    }
    for k in 0..4 {
        let mut leg = Assembly::framed(place * turned(90.0 * k as f32 + 45.0, Vec3::ZERO));
        let x = radius - 0.06;
        leg.add(FRAME, &rod([x, -0.02, 0.0], [x, bottom + 0.35, 0.0], 0.09, 12));
        leg.add(FRAME, &block([x - 0.2, -0.02, -0.2], [x + 0.2, 0.03, 0.2]));
        for (dx, dz) in [(-0.14, -0.14), (0.14, -0.14), (-0.14, 0.14), (0.14, 0.14)] {
            leg.add(FRAME, &bolt([x + dx, 0.03, dz], Vec3::Y, 0.05));
        }
        tank.merge(leg);
    }
    let neck = standing_on([0.0, bottom + 0.8, radius - 0.05], [0.0, bottom + 0.8, 9.0]);
    tank.merge(manhole(place * turned(20.0, Vec3::ZERO) * neck));
    let rungs = place * turned(-60.0, Vec3::ZERO) * at(0.0, 0.0, radius + 0.22);
    tank.merge(ladder(FRAME, rungs, bottom + height - 0.5));
    let top = bottom + height + 0.3 * radius;
    let over = radius + 0.8;
    let overflow = [[0.3, top - 0.1, 0.0], [0.3, top + 0.6, 0.0], [over, top + 0.6, 0.0], [over, -0.1, 0.0]];
    tank.merge(run(PIPES, &moved(&overflow, place), 0.09, 14));
    let out = -radius - 0.6;
    let outlet = [[0.0, 1.0, 0.0], [0.0, 0.45, 0.0], [out, 0.45, 0.0], [out, -0.1, 0.0]];
    tank.merge(run(PIPES, &moved(&outlet, place), 0.11, 14));
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    let along = place.transform_vector3(Vec3::X);
    tank.merge(valve(PIPES, WHEELS, v(-0.75, 0.45, 0.0), along, Vec3::Y, 0.11));
    tank.merge(gauge(PIPES, v(-0.3, top - 0.12, 0.3), 0.0));
    tank
}

/// Bolted cover on a short neck, the neck along y of `place`.
fn manhole(place: Affine3A) -> Assembly {
    let mut manhole = Assembly::framed(place);
    let neck = [[0.3, -0.1], [0.3, 0.16], [0.4, 0.16], [0.4, 0.25], [0.3, 0.27], [0.0, 0.29]];
    manhole.add(SHELL, &lathe(&neck, 28));
    manhole.add_each(FRAME, &bolt([0.36, 0.25, 0.0], Vec3::Y, 0.045), turns(16));
    manhole
}

/// Lying tank in the frame `place`, its axis along x at the height of its saddles.
pub fn lying_tank(place: Affine3A, radius: f32, length: f32) -> Assembly {
    let mut tank = Assembly::framed(place);
    let height = radius + 0.55;
    let axis = standing_on([-0.5 * length, height, 0.0], [1.0, height, 0.0]);
    tank.add_at(SHELL, &lathe(&vessel(radius, length, 0.4 * radius), 40), axis);
    for k in 0..4 {
        let y = 0.02 + (length - 0.04) * k as f32 / 3.0;
        tank.add_at(SHELL, &ring(radius - 0.01, radius + 0.03, y - 0.05, y + 0.05, 40), axis);
    }
    for x in [-0.3 * length, 0.3 * length] {
        let mut outline = points(&[[-0.85 * radius, -0.02], [0.85 * radius, -0.02]]);
        outline.extend(arc(Vec2::new(0.0, height), radius + 0.02, -32.0, -148.0, 12));
        // The outline is in (z, y); its depth becomes x.
        let saddle = extrude(&outline, &[], 0.22).mapped(|p| Vec3::new(p.z + x - 0.11, p.y, p.x)).flipped();
        tank.add(FRAME, &saddle);
        let foot = 0.95 * radius;
        tank.add(FRAME, &beveled_box([x - 0.3, -0.05, -foot], [x + 0.3, 0.1, foot], 0.02));
    }
    tank.merge(manhole(place * at(0.0, height + radius - 0.05, 0.0)));
    let v = |x: f32, y: f32, z: f32| place.transform_point3(Vec3::new(x, y, z));
    let end = v(-0.5 * length - 0.55 * radius, height, 0.0);
    tank.merge(flange(PIPES, end, place.transform_vector3(Vec3::X), 0.16));
    for x in [-0.35 * length, 0.35 * length] {
        let (top, back) = (height + radius, -radius - 0.5);
        let path = [[x, top - 0.1, 0.0], [x, top + 0.9, 0.0], [x, top + 0.9, back], [x, -0.1, back]];
        tank.merge(run(PIPES, &moved(&path, place), 0.08, 12));
        let stem = place.transform_vector3(Vec3::Z);
        tank.merge(valve(PIPES, WHEELS, v(x, top + 0.45, 0.0), Vec3::Y, stem, 0.08));
    }
    tank.merge(ladder(FRAME, place * mirror_z() * at(0.15 * length, 0.0, -radius - 0.2), height + 0.4));
    tank
}
