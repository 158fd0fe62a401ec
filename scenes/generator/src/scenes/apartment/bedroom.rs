//! The bedroom: bed, night tables with lamps, wardrobe, chest of drawers with a mirror, an open door.

use super::living::VASE;
use crate::props::furniture::{
    bar_handle, bed, casing, curtain, door_leaf, framed_panel, knob, potted_fern, rug, shaded,
};
use crate::shapes::*;
use glam::{Quat, Vec2, Vec3};

pub fn add(scene: &mut Assembly) {
    scene.place(&bed(), turned(90.0, [5.72, 0.002, -0.5]));
    let table = night_table();
    scene.place(&table, turned(90.0, [5.72, 0.0, -1.72]));
    scene.place(&table, turned(90.0, [5.72, 0.0, 0.7]));
    scene.add_at("rug", &rug(Vec2::new(1.5, 2.2)), at(7.75, 0.002, -0.5));
    scene.place(&wardrobe(), turned(180.0, [7.1, 0.0, 1.585]));
    scene.place(&chest(), turned(-90.0, [9.685, 0.0, -0.85]));
    scene.place(&door_leaf(), turned(84.0, [9.28, 0.0, 1.63]));
    scene.place(&potted_fern(22, 9), at(9.27, 0.0, -1.97));
    let mut drapes = Assembly::new();
    let (rail, length) = (2.42, 2.9);
    drapes.add("lamp_metal", &rod([0.0, rail, 0.1], [length, rail, 0.1], 0.012, 12));
    for x in [0.0, length] {
        drapes.add_at("lamp_metal", &ellipsoid(Vec3::splat(0.028), 12, 8), at(x, rail, 0.1));
    }
    for x in [0.12, length - 0.12] {
        drapes.add("lamp_metal", &rod([x, rail, 0.0], [x, rail, 0.1], 0.008, 8));
    }
    for x in [0.03, length - 0.53] {
        drapes.add_at("curtains", &curtain(0.5, 2.38, 6), at(x, rail - 0.005, 0.1));
    }
    scene.place(&drapes, at(6.35, 0.0, -2.4));
}

fn night_table() -> Assembly {
    let mut table = Assembly::new();
    table.add("lacquer", &block([-0.22, 0.15, 0.0], [0.22, 0.5, 0.36]));
    table.add("lacquer", &beveled_box([-0.235, 0.5, 0.0], [0.235, 0.522, 0.392], 0.005));
    for (x, z) in [(-1.0, 0.05), (1.0, 0.05), (-1.0, 0.32), (1.0, 0.32)] {
        table.add_at("wood", &cone(0.013, 0.023, 0.15, 12), at(0.18 * x, 0.0, z));
    }
    for y in [0.155, 0.33] {
        table.add_at("lacquer", &framed_panel(Vec2::new(0.434, 0.166), 0.02, 0.03), at(-0.217, y, 0.361));
        table.add_at("door_furniture", &knob(0.014), at(0.0, y + 0.083, 0.377));
    }
    table.place(&shaded("lamp_light", 0.0), at(0.0, 0.522, 0.18));
    table
}

/// Four panelled doors in two tiers below a cornice.
fn wardrobe() -> Assembly {
    let mut wardrobe = Assembly::new();
    let (half, height, depth) = (1.0, 2.2, 0.55);
    wardrobe.add("lacquer", &block([-half, 0.08, 0.0], [half, height, depth]));
    wardrobe.add("lacquer", &block([-half + 0.03, 0.0, 0.0], [half - 0.03, 0.08, depth - 0.05]));
    wardrobe.add(
        "lacquer",
        &beveled_box([-half - 0.03, height, 0.0], [half + 0.03, height + 0.07, depth + 0.05], 0.025),
    );
    for k in 0..4 {
        let x = -half + 0.5 * k as f32 + 0.003;
        wardrobe.add_at(
            "lacquer",
            &framed_panel(Vec2::new(0.494, 0.68), 0.022, 0.07),
            at(x, 0.085, depth + 0.001),
        );
        wardrobe.add_at(
            "lacquer",
            &framed_panel(Vec2::new(0.494, 1.425), 0.022, 0.07),
            at(x, 0.771, depth + 0.001),
        );
        let grip = x + if k % 2 == 0 { 0.46 } else { 0.035 };
        let stand = posed(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2), [grip, 1.08, depth + 0.022]);
        wardrobe.add_at("door_furniture", &bar_handle(0.2, 0.035, 0.006), stand);
    }
    wardrobe
}

/// A chest of three wide drawers below a mirror.
fn chest() -> Assembly {
    let mut chest = Assembly::new();
    let (half, depth) = (0.6, 0.45);
    chest.add("lacquer", &block([-half, 0.12, 0.0], [half, 0.82, depth]));
    chest
        .add("lacquer", &beveled_box([-half - 0.015, 0.82, 0.0], [half + 0.015, 0.845, depth + 0.03], 0.006));
    for (x, z) in [(-1.0, 0.06), (1.0, 0.06), (-1.0, depth - 0.06), (1.0, depth - 0.06)] {
        chest.add_at("wood", &cone(0.018, 0.03, 0.12, 14), at(0.54 * x, 0.0, z));
    }
    for k in 0..3 {
        let y = 0.125 + 0.231 * k as f32;
        chest.add_at(
            "lacquer",
            &framed_panel(Vec2::new(1.194, 0.226), 0.02, 0.035),
            at(-0.597, y, depth + 0.001),
        );
        for x in [-0.32, 0.32] {
            chest.add_at("door_furniture", &knob(0.016), at(x, y + 0.113, depth + 0.017));
        }
    }
    let size = Vec2::new(0.8, 0.75);
    chest.add_at("frames", &casing(size, 0.06, true), at(-0.4, 1.12, -0.013));
    let glass = sheet([-0.41, 1.11, -0.003], Vec3::X * (size.x + 0.02), Vec3::Y * (size.y + 0.02));
    chest.add("mirror", &glass);
    chest.add_at("vases", &VASE.turned(0.8), at(-0.42, 0.845, 0.2));
    chest
}
