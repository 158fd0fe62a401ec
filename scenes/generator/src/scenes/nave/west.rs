//! The west wall: a door in a stepped portal, and a rose window over it.

use super::plan::{AISLE, AISLE_WALL, TOP, WALL, Window};
use super::windows::sky_behind;
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

const ROSE: Vec2 = Vec2::new(0.0, 14.2);
const ROSE_RADIUS: f32 = 2.1;
const DOOR: PointedArch = PointedArch { half_span: 1.25, rise: 1.6 };
const DOOR_SPRING: f32 = 2.5;

/// West wall with its rose and its door.
pub fn add(scene: &mut Assembly) {
    let half = AISLE[1] + AISLE_WALL;
    let outline = rectangle(Vec2::new(-half, -0.1), Vec2::new(half, TOP));
    let rose: Vec<Vec2> = circle(ROSE_RADIUS, 40).iter().map(|p| *p + ROSE).collect();
    let door =
        |arch: PointedArch, below: f32| arch.opening(Vec2::new(0.0, DOOR_SPRING), -DOOR_SPRING - below, 10);
    scene.add("walls", &extrude_faces(&outline, &[rose, door(DOOR, 0.02)], WALL, Faces::NO_RIM));

    scene.add_at("tracery", &rose_tracery(), at(ROSE.x, ROSE.y, 0.55 * WALL));
    let opening = Window {
        head: PointedArch { half_span: ROSE_RADIUS, rise: ROSE_RADIUS },
        sill: ROSE.y - ROSE_RADIUS,
        spring: ROSE.y,
    };
    scene.merge(sky_behind(&opening, WALL, Affine3A::IDENTITY));

    for offset in [0.0, 0.3] {
        // The outline goes from the lower right up over the arch; the last point of the outline is the left springing.
        let path: Vec<Vec3> = door(DOOR.offset(offset), 0.02)[1..].iter().map(|p| p.extend(0.0)).collect();
        let profile = circle(0.09 - 0.1 * offset, 8);
        let section = Section { points: &profile, closed: true, crease_degrees: 60.0 };
        scene.add("mouldings", &sweep_along(section, &path, Vec3::X, false, Faces::ALL));
    }
    let leaf = extrude(&door(DOOR.offset(0.03), 0.05), &[], 0.1);
    scene.add_at("wood", &leaf, at(0.0, 0.0, 0.5 * WALL));
    for k in 0..7 {
        let x = -1.08 + 0.36 * k as f32;
        let height = DOOR_SPRING + 1.4 * (1.0 - (x / 1.3).powi(2));
        let (back, front) = (0.5 * WALL - 0.04, 0.5 * WALL + 0.02);
        scene.add("wood", &beveled_box([x - 0.16, 0.02, back], [x + 0.16, height, front], 0.015));
    }
    scene.add_at("wood", &ellipsoid(Vec3::splat(0.06), 12, 8), at(0.2, 1.15, 0.5 * WALL - 0.1));
}

/// Wheel of eight trefoils around a foiled eye.
fn rose_tracery() -> Shell {
    let outline = circle(ROSE_RADIUS + 0.03, 40);
    let mut holes = vec![foil(8, 0.36, 0.2, 0.0, 4)];
    for k in 0..8 {
        let turn = 22.5 + 45.0 * k as f32;
        let centre = Vec2::from_angle(turn.to_radians()) * 1.42;
        holes.push(foil(3, 0.24, 0.26, turn, 5).iter().map(|p| *p + centre).collect());
        let gap = Vec2::from_angle((turn + 22.5).to_radians()) * 0.95;
        let mut eye: Vec<Vec2> = circle(0.13, 8).iter().map(|p| *p + gap).collect();
        eye.reverse();
        holes.push(eye);
    }
    extrude_faces(&outline, &holes, 0.2, Faces::NO_RIM)
}
