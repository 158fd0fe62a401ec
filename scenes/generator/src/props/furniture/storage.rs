//! Lacquered cupboards and drawers with the objects on them; the wall is at z = 0, the middle at x = 0.

use super::{VASE, bar_handle, casing, framed_panel, knob, on_end, shaded};
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Night table with two drawers and a lamp.
pub fn night_table() -> Assembly {
    let mut table = Assembly::new();
    table.add("lacquer", &block([-0.22, 0.15, 0.0], [0.22, 0.5, 0.36]));
    table.add("lacquer", &beveled_box([-0.235, 0.5, 0.0], [0.235, 0.522, 0.392], 0.005));
    table.add_each("wood", &cone(0.013, 0.023, 0.15, 12), feet(0.18, [0.05, 0.32]));
    for y in [0.155, 0.33] {
        table.add_at("lacquer", &framed_panel(Vec2::new(0.434, 0.166), 0.02, 0.03), at(-0.217, y, 0.361));
        table.add_at("door_furniture", &knob(0.014), at(0.0, y + 0.083, 0.377));
    }
    table.place(&shaded("lamp_light", 0.0), at(0.0, 0.522, 0.18));
    table
}

/// Wardrobe: four panelled doors in two tiers below a cornice.
pub fn wardrobe() -> Assembly {
    let mut wardrobe = Assembly::new();
    let (half, height, depth) = (1.0, 2.2, 0.55);
    wardrobe.add("lacquer", &block([-half, 0.08, 0.0], [half, height, depth]));
    wardrobe.add("lacquer", &block([-half + 0.03, 0.0, 0.0], [half - 0.03, 0.08, depth - 0.05]));
    let (low, high) = ([-half - 0.03, height, 0.0], [half + 0.03, height + 0.07, depth + 0.05]);
    wardrobe.add("lacquer", &beveled_box(low, high, 0.025));
    for k in 0..4 {
        let x = -half + 0.5 * k as f32 + 0.003;
        for (y, h) in [(0.085, 0.68), (0.771, 1.425)] {
            let panel = framed_panel(Vec2::new(0.494, h), 0.022, 0.07);
            wardrobe.add_at("lacquer", &panel, at(x, y, depth + 0.001));
        }
        let grip = x + if k % 2 == 0 { 0.46 } else { 0.035 };
        wardrobe.add_at(
            "door_furniture",
            &bar_handle(0.2, 0.035, 0.006),
            on_end([grip, 1.08, depth + 0.022]),
        );
    }
    wardrobe
}

/// Chest of three wide drawers below a mirror.
pub fn chest() -> Assembly {
    let mut chest = Assembly::new();
    let (half, depth) = (0.6, 0.45);
    chest.add("lacquer", &block([-half, 0.12, 0.0], [half, 0.82, depth]));
    let (low, high) = ([-half - 0.015, 0.82, 0.0], [half + 0.015, 0.845, depth + 0.03]);
    chest.add("lacquer", &beveled_box(low, high, 0.006));
    chest.add_each("wood", &cone(0.018, 0.03, 0.12, 14), feet(0.54, [0.06, depth - 0.06]));
    for k in 0..3 {
        let y = 0.125 + 0.231 * k as f32;
        let panel = framed_panel(Vec2::new(1.194, 0.226), 0.02, 0.035);
        chest.add_at("lacquer", &panel, at(-0.597, y, depth + 0.001));
        let knobs = [-0.32, 0.32].map(|x| at(x, y + 0.113, depth + 0.017));
        chest.add_each("door_furniture", &knob(0.016), knobs);
    }
    let size = Vec2::new(0.8, 0.75);
    chest.add_at("frames", &casing(size, 0.06, true), at(-0.4, 1.12, -0.013));
    let glass = sheet([-0.41, 1.11, -0.003], Vec3::X * (size.x + 0.02), Vec3::Y * (size.y + 0.02));
    chest.add("mirror", &glass);
    chest.add_at("vases", &VASE.turned(0.8), at(-0.42, 0.845, 0.2));
    chest
}

/// Low sideboard with four panelled doors on turned feet; on it a television, a vase and a lamp.
pub fn sideboard() -> Assembly {
    let mut board = Assembly::new();
    let (half, depth) = (0.95, 0.42);
    board.add("lacquer", &block([-half, 0.14, 0.0], [half, 0.56, depth - 0.02]));
    let (low, high) = ([-half - 0.012, 0.56, 0.0], [half + 0.012, 0.585, depth + 0.012]);
    board.add("lacquer", &beveled_box(low, high, 0.004));
    board.add_each("wood", &cone(0.016, 0.028, 0.14, 14), feet(0.88, [0.06, depth - 0.08]));
    for k in 0..4 {
        let x = -half + 0.475 * k as f32;
        let panel = framed_panel(Vec2::new(0.469, 0.412), 0.02, 0.05);
        board.add_at("lacquer", &panel, at(x + 0.003, 0.144, depth - 0.019));
        let grip = at(x + if k % 2 == 0 { 0.41 } else { 0.065 }, 0.48, depth + 0.001);
        board.add_at("door_furniture", &bar_handle(0.1, 0.028, 0.005), grip);
    }
    board.add("screen", &rounded_box([-0.58, 0.67, 0.17], [0.58, 1.34, 0.2], 0.008, 2));
    board.add("lamp_metal", &rounded_box([-0.17, 0.585, 0.1], [0.17, 0.597, 0.28], 0.005, 2));
    board.add("lamp_metal", &block([-0.04, 0.597, 0.16], [0.04, 0.75, 0.172]));
    board.add_at("vases", &VASE.turned(1.1), at(-0.8, 0.585, 0.2));
    board.place(&shaded("lamp_light", 0.0), at(0.78, 0.585, 0.21));
    board
}
