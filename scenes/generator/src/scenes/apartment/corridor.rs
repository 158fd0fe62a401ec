//! The corridor: a console, a runner, pictures, hooks, the flat's door and two lights in the ceiling.

use super::HEIGHT;
use super::living::{VASE, picture};
use crate::props::furniture::{door, downlight, framed_panel, knob, pile, rug, turned_leg};
use crate::shapes::*;
use glam::Vec2;

pub fn add(scene: &mut Assembly) {
    scene.add_at("runner", &rug(Vec2::new(2.6, 0.75)), at(7.75, 0.002, 2.35));
    scene.place(&door(), turned(-90.0, [9.7, 0.0, 2.35]));
    for x in [6.7, 8.6] {
        scene.place(&downlight("lamp_metal", "ceiling_light", 0.11), at(x, HEIGHT, 2.35));
    }
    scene.place(&console(), turned(180.0, [8.7, 0.0, 2.985]));
    scene.place(&picture(Vec2::new(0.6, 0.45), 2), turned(180.0, [9.0, 1.35, 3.0]));
    scene.place(&picture(Vec2::new(0.5, 0.65), 3), at(6.1, 1.25, 1.7));
    scene.place(&picture(Vec2::new(0.5, 0.65), 4), at(7.2, 1.25, 1.7));
    // A row of hooks by the door.
    let board = beveled_box([6.0, 1.6, 2.978], [6.42, 1.69, 3.0], 0.004);
    scene.add("wood", &board);
    for k in 0..3 {
        scene.add_at("door_furniture", &knob(0.02), turned(180.0, [6.08 + 0.13 * k as f32, 1.645, 2.979]));
    }
}

/// A narrow table with two drawers, a vase and books on it.
fn console() -> Assembly {
    let mut table = Assembly::new();
    table.add("lacquer", &beveled_box([-0.5, 0.78, 0.0], [0.5, 0.805, 0.3], 0.005));
    table.add("lacquer", &beveled_box([-0.47, 0.64, 0.02], [0.47, 0.779, 0.265], 0.003));
    for (x, z) in [(-1.0, 0.05), (1.0, 0.05), (-1.0, 0.24), (1.0, 0.24)] {
        table.add_at("wood", &turned_leg(0.641, 0.022, 10, 1), at(0.44 * x, 0.0, z));
    }
    for x in [-0.46, 0.005] {
        table.add_at("lacquer", &framed_panel(Vec2::new(0.455, 0.125), 0.012, 0.025), at(x, 0.647, 0.2645));
        table.add_at("door_furniture", &knob(0.013), at(x + 0.2275, 0.709, 0.274));
    }
    table.add_at("vases", &VASE.turned(0.95), at(0.3, 0.805, 0.15));
    table.place(&pile(31, 3), turned(6.0, [-0.42, 0.805, 0.08]));
    table
}
