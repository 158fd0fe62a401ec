//! The side aisles: low rib vaults between the arcade and an outer wall with one window a bay.

use super::arcade::string_course;
use super::piers::{PLINTH, half_shaft, shaft_profile, thin_shaft_profile};
use super::plan::{AISLE, AISLE_WALL, AISLE_WINDOW, ARCADE_SPRING, BAY, BAYS, EAST, pier_z, south_wall};
use super::vault::{Bay, Detail};
use super::windows::glazed;
use crate::shapes::*;
use glam::Vec2;

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

pub fn add(scene: &mut Assembly) {
    let vault = Bay {
        low: Vec2::new(AISLE[0], -BAY),
        high: Vec2::new(AISLE[1], 0.0),
        spring: ARCADE_SPRING,
        crown: CROWN,
        apex: [CROWN - 0.2, CROWN - 0.2],
    };
    let vault = vault.vaulted(&DETAIL);
    let respond = respond();
    let outline = rectangle(Vec2::new(0.0, -0.1), Vec2::new(BAY, CROWN + 0.6));
    let wall = extrude_faces(&outline, &[AISLE_WINDOW.outline(0.5 * BAY, 8)], AISLE_WALL, Faces::NO_RIM);
    let course = string_course(0.0, BAY, AISLE_WINDOW.sill - 0.25);
    for side in both_sides() {
        for k in 0..BAYS {
            scene.place(&vault, side * at(0.0, 0.0, pier_z(k)));
            let frame = side * south_wall(AISLE[1], k);
            scene.add_at("walls", &wall, frame);
            scene.add_at("piers", &course, frame);
            scene.merge(glazed(&AISLE_WINDOW, 0.5 * BAY, AISLE_WALL, frame));
        }
        for k in 0..=BAYS {
            scene.place(&respond, side * at(AISLE[1], 0.0, pier_z(k)));
        }
        // A bench of stone along the outer wall, and the wall at the east end.
        let (low, high) = ([AISLE[1] - 0.42, -0.05, EAST - 0.1], [AISLE[1] + 0.1, 0.45, 0.1]);
        scene.add_at("piers", &beveled_box(low, high, 0.03), side);
        let low = [AISLE[0] - 0.1, -0.1, EAST - 0.6];
        let end = block(low, [AISLE[1] + AISLE_WALL, CROWN + 0.6, EAST - 0.02]);
        scene.add_at("walls", &end, side);
    }
}

/// Half pier against the outer wall that takes the vault.
fn respond() -> Assembly {
    let mut respond = Assembly::new();
    respond.add("piers", &beveled_box([-0.62, -0.05, -0.72], [0.1, PLINTH, 0.72], 0.05));
    respond.add("piers", &block([-0.14, 0.1, -0.42], [0.1, ARCADE_SPRING + 0.01, 0.42]));
    respond.add_at("piers", &half_shaft(&shaft_profile(0.18, PLINTH, ARCADE_SPRING), 6), at(-0.14, 0.0, 0.0));
    let thin = half_shaft(&thin_shaft_profile(0.08, PLINTH, ARCADE_SPRING), 4);
    respond.add_each("piers", &thin, [-0.3, 0.3].map(|z| at(-0.14, 0.0, z)));
    respond
}
