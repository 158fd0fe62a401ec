//! The side aisles: low rib vaults between the arcade and an outer wall with one window a bay.

use super::arcade::string_course;
use super::piers::{PLINTH, shaft_profile, thin_shaft_profile};
use super::plan::{AISLE, AISLE_WALL, AISLE_WINDOW, ARCADE_SPRING, BAY, BAYS, EAST, pier_z, south_wall};
use super::vault::{Bay, Detail};
use super::windows;
use crate::shapes::Part;
use crate::shapes::{Faces, at, beveled_box, block, extrude_faces, lathe_sector, mirror_x, rectangle};
use glam::{Vec2, Vec3};

/// Height of the crown of the aisle vaults.
const CROWN: f32 = 8.35;
const DETAIL: Detail = Detail {
    web: [3, 5],
    diagonal: Vec2::new(0.24, 0.26),
    transverse: Vec2::new(0.38, 0.34),
    wall: Vec2::new(0.18, 0.16),
    both_walls: false,
    roll: 2,
};

/// The parts that aisles contribute to.
pub struct Parts<'a> {
    /// Ashlar walls.
    pub walls: &'a mut Part,
    /// Shafts and string courses.
    pub piers: &'a mut Part,
    /// Ribs of the vault.
    pub ribs: &'a mut Part,
    /// Webs of the vault.
    pub webs: &'a mut Part,
    /// Windows.
    pub windows: &'a mut windows::Parts,
}

/// Appends both aisles.
pub fn build(parts: &mut Parts) {
    let mut webs = Part::default();
    let mut ribs = Part::default();
    let bay = Bay {
        low: Vec2::new(AISLE[0], -BAY),
        high: Vec2::new(AISLE[1], 0.0),
        spring: ARCADE_SPRING,
        crown: CROWN,
        apex: [CROWN - 0.2, CROWN - 0.2],
    };
    bay.build(&DETAIL, &mut webs, &mut ribs);
    let respond = respond();
    let outline = rectangle(Vec2::new(0.0, -0.1), Vec2::new(BAY, CROWN + 0.6));
    let holes = [AISLE_WINDOW.outline(0.5 * BAY, 8)];
    let wall = extrude_faces(&outline, &holes, AISLE_WALL, Faces { rim: false, ..Faces::ALL });
    for mirror in [at(0.0, 0.0, 0.0), mirror_x(0.0)] {
        for k in 0..BAYS {
            let along = mirror * at(0.0, 0.0, pier_z(k));
            parts.webs.append(&webs, &along);
            parts.ribs.append(&ribs, &along);
            let frame = mirror * south_wall(AISLE[1], k);
            parts.walls.add_at(&wall, &frame);
            parts.piers.add_at(&string_course(0.0, BAY, AISLE_WINDOW.sill - 0.25), &frame);
            windows::build(parts.windows, &AISLE_WINDOW, 0.5 * BAY, AISLE_WALL, &frame);
        }
        for k in 0..=BAYS {
            parts.piers.append(&respond, &(mirror * at(AISLE[1], 0.0, pier_z(k))));
        }
        // A bench of stone along the outer wall, and the wall at the east end.
        let bench = beveled_box(
            Vec3::new(AISLE[1] - 0.42, -0.05, EAST - 0.1),
            Vec3::new(AISLE[1] + 0.1, 0.45, 0.1),
            0.03,
        );
        parts.piers.add_at(&bench, &mirror);
        let end = block(
            Vec3::new(AISLE[0] - 0.1, -0.1, EAST - 0.6),
            Vec3::new(AISLE[1] + AISLE_WALL, CROWN + 0.6, EAST - 0.02),
        );
        parts.walls.add_at(&end, &mirror);
    }
}

/// The half pier against the outer wall that takes the vault.
fn respond() -> Part {
    let mut part = Part::default();
    let shaft = |radius: f32, segments: usize| {
        lathe_sector(&shaft_profile(radius, PLINTH, ARCADE_SPRING), 80.0, 280.0, segments)
    };
    part.add(&beveled_box(Vec3::new(-0.62, -0.05, -0.72), Vec3::new(0.1, PLINTH, 0.72), 0.05));
    part.add(&block(Vec3::new(-0.14, 0.1, -0.42), Vec3::new(0.1, ARCADE_SPRING + 0.01, 0.42)));
    part.add_at(&shaft(0.18, 6), &at(-0.14, 0.0, 0.0));
    let thin = lathe_sector(&thin_shaft_profile(0.08, PLINTH, ARCADE_SPRING), 80.0, 280.0, 4);
    for z in [-0.3, 0.3] {
        part.add_at(&thin, &at(-0.14, 0.0, z));
    }
    part
}
