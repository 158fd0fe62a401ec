//! Tables with the objects on them.

use super::{BOWL, VASE, chair, framed_panel, knob, pile, shaded, turned_leg};
use crate::shapes::*;
use glam::{Vec2, Vec3};

#[rustfmt::skip]
mod section {
    pub const ROUND_TOP: [[f32; 2]; 7] = [[0.0, 0.715], [0.5, 0.715], [0.53, 0.722], [0.535, 0.735], [0.525, 0.748],
        [0.51, 0.75], [0.0, 0.75]];
    pub const COLUMN: [[f32; 2]; 9] = [[0.16, 0.0], [0.17, 0.02], [0.06, 0.06], [0.04, 0.1], [0.055, 0.2],
        [0.075, 0.32], [0.04, 0.48], [0.05, 0.6], [0.12, 0.7]];
}

/// Table on four turned legs, its top of `size` (x and z) at the height `size.y`: parts "table_top" and "wood".
pub fn dining_table(size: Vec3) -> Assembly {
    let mut table = Assembly::new();
    let half = Vec2::new(0.5 * size.x, 0.5 * size.z);
    let top = rounded_box([-half.x, size.y - 0.032, -half.y], [half.x, size.y, half.y], 0.009, 3);
    table.add("table_top", &top);
    let leg = half - 0.075;
    for place in feet(leg.x, [-leg.y, leg.y]) {
        table.add_at("wood", &turned_leg(0.62, 0.042, 18, 2), place);
        let middle = Vec3::from(place.translation).with_y(0.668);
        let reach = Vec3::new(0.04, 0.05, 0.04);
        table.add("wood", &beveled_box(middle - reach, middle + reach, 0.004));
    }
    let rail = |x: [f32; 2], z: [f32; 2]| beveled_box([x[0], 0.63, z[0]], [x[1], 0.718, z[1]], 0.003);
    for z in [-leg.y, leg.y] {
        table.add("wood", &rail([0.04 - leg.x, leg.x - 0.04], [z - 0.012, z + 0.012]));
    }
    for x in [-leg.x, leg.x] {
        table.add("wood", &rail([x - 0.012, x + 0.012], [0.04 - leg.y, leg.y - 0.04]));
    }
    table
}

/// Round table on a turned column, with a vase and four chairs.
pub fn round_table() -> Assembly {
    let mut table = Assembly::new();
    table.add("lacquer", &lathe(&section::ROUND_TOP, 48));
    table.add("wood", &spindle(&section::COLUMN, 2, 20));
    table.add_at("wood", &cylinder(0.2, 0.018, 24), at(0.0, 0.698, 0.0));
    table.add_at("vases", &VASE.turned(0.85), at(0.05, 0.75, -0.06));
    let chair = chair("wood", "seats");
    for k in 0..4 {
        let degrees = 45.0 + 90.0 * k as f32 + [4.0, -6.0, 5.0, -3.0][k];
        table.place(&chair, turned(degrees, Vec3::ZERO) * at(0.0, 0.0, -[0.6, 0.52, 0.5, 0.56][k]));
    }
    table
}

/// Coffee table with a shelf, books and a bowl of fruit.
pub fn coffee_table() -> Assembly {
    let mut table = Assembly::new();
    table.add("lacquer", &rounded_box([-0.6, 0.4, -0.33], [0.6, 0.43, 0.33], 0.012, 3));
    table.add("lacquer", &beveled_box([-0.5, 0.13, -0.25], [0.5, 0.15, 0.25], 0.004));
    table.add_each("wood", &turned_leg(0.401, 0.026, 10, 1), feet(0.52, [-0.26, 0.26]));
    table.place(&pile(11, 3), turned(18.0, [-0.36, 0.43, 0.12]));
    table.add_at("vases", &BOWL.turned(1.0), at(0.22, 0.43, 0.02));
    for (x, z) in [(0.03, 0.045), (0.05, -0.035), (-0.045, 0.0)] {
        table.add_at("fruit", &ellipsoid([0.038, 0.036, 0.038], 14, 9), at(0.22 + x, 0.479, 0.02 + z));
    }
    table.place(&pile(12, 2), turned(-20.0, [-0.1, 0.15, 0.05]));
    table
}

/// Narrow table against the wall z = 0 with two drawers, a vase and books.
pub fn console() -> Assembly {
    let mut table = Assembly::new();
    table.add("lacquer", &beveled_box([-0.5, 0.78, 0.0], [0.5, 0.805, 0.3], 0.005));
    table.add("lacquer", &beveled_box([-0.47, 0.64, 0.02], [0.47, 0.779, 0.265], 0.003));
    table.add_each("wood", &turned_leg(0.641, 0.022, 10, 1), feet(0.44, [0.05, 0.24]));
    for x in [-0.46, 0.005] {
        table.add_at("lacquer", &framed_panel(Vec2::new(0.455, 0.125), 0.012, 0.025), at(x, 0.647, 0.2645));
        table.add_at("door_furniture", &knob(0.013), at(x + 0.2275, 0.709, 0.274));
    }
    table.add_at("vases", &VASE.turned(0.95), at(0.3, 0.805, 0.15));
    table.place(&pile(31, 3), turned(6.0, [-0.42, 0.805, 0.08]));
    table
}

/// Desk against the wall z = 0 with three drawers on one side and legs on the other, a lamp, books and paper.
pub fn desk() -> Assembly {
    let mut desk = Assembly::new();
    desk.add("lacquer", &rounded_box([-0.75, 0.72, 0.0], [0.75, 0.75, 0.7], 0.008, 2));
    desk.add("lacquer", &block([0.3, 0.06, 0.03], [0.72, 0.719, 0.62]));
    for k in 0..3 {
        let y = 0.066 + 0.217 * k as f32;
        desk.add_at("lacquer", &framed_panel(Vec2::new(0.412, 0.212), 0.02, 0.03), at(0.304, y, 0.621));
        desk.add_at("door_furniture", &knob(0.014), at(0.51, y + 0.106, 0.637));
    }
    for z in [0.06, 0.62] {
        desk.add("wood", &beveled_box([-0.72, 0.0, z - 0.025], [-0.67, 0.721, z + 0.025], 0.004));
    }
    desk.add("wood", &block([0.33, 0.0, 0.06], [0.69, 0.061, 0.58]));
    desk.add("wood", &rod([-0.695, 0.2, 0.08], [-0.695, 0.2, 0.6], 0.01, 10));
    desk.place(&shaded("lamp_light", 0.0), at(0.52, 0.75, 0.28));
    desk.place(&pile(41, 4), turned(20.0, [-0.62, 0.75, 0.2]));
    desk.add_at("pages", &block([-0.15, 0.0, -0.1], [0.06, 0.004, 0.2]), turned(-8.0, [0.0, 0.75, 0.4]));
    desk
}
