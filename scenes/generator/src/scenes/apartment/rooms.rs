//! Furniture of the rooms.

use super::walls::HEIGHT;
use crate::props::furniture::*;
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Middle of the round table.
const TABLE: Vec3 = Vec3::new(4.42, 0.0, 3.72);

pub fn add(scene: &mut Assembly) {
    living_room(scene);
    corridor(scene);
    bedroom(scene);
    study(scene);
}

/// Sitting corner on a rug, a sideboard, books, and a round table for four.
fn living_room(scene: &mut Assembly) {
    scene.add_at("rug", &rug(Vec2::new(2.7, 1.9)), at(2.3, 0.002, 1.5));
    scene.place(&sofa("sofa", 3), at(2.3, 0.0, 0.12));
    scene.place(&sofa("armchair", 1), turned(64.0, [0.45, 0.0, 1.75]));
    scene.place(&coffee_table(), turned(3.0, [2.35, 0.015, 1.55]));
    scene.place(&bookcase("lacquer", Vec3::new(1.4, 2.1, 0.3), 6, 3), at(4.75, 0.0, 0.02));
    scene.place(&sideboard(), turned(180.0, [2.0, 0.0, 4.58]));
    scene.place(&shaded("lamp_light", 1.35), at(3.72, 0.0, 0.4));
    scene.place(&potted_rubber_tree(1.55, 22, 8), at(0.42, 0.0, 0.5));
    scene.place(&potted_fern(26, 4), at(5.15, 0.0, 1.2));
    scene.place(&picture(Vec2::new(1.3, 0.8), 1), at(1.65, 1.3, 0.0));
    scene.place(&round_table(), at(TABLE.x, 0.002, TABLE.z));
    scene.place(&pendant("lamp_light", 0.85), at(TABLE.x, HEIGHT, TABLE.z));
    scene.place(&drapes(2.48, 3.5, 0.6, 7), turned(90.0, [0.0, 0.0, 4.25]));
}

/// Console, a runner, pictures, hooks, the flat's door and two lights in the ceiling.
fn corridor(scene: &mut Assembly) {
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
    scene.add("wood", &beveled_box([6.0, 1.6, 2.978], [6.42, 1.69, 3.0], 0.004));
    let hooks = [0.0, 1.0, 2.0].map(|k| turned(180.0, [6.08 + 0.13 * k, 1.645, 2.979]));
    scene.add_each("door_furniture", &knob(0.02), hooks);
}

/// Bed, night tables with lamps, a wardrobe, a chest of drawers with a mirror, an open door.
fn bedroom(scene: &mut Assembly) {
    scene.place(&bed(), turned(90.0, [5.72, 0.002, -0.5]));
    for z in [-1.72, 0.7] {
        scene.place(&night_table(), turned(90.0, [5.72, 0.0, z]));
    }
    scene.add_at("rug", &rug(Vec2::new(1.5, 2.2)), at(7.75, 0.002, -0.5));
    scene.place(&wardrobe(), turned(180.0, [7.1, 0.0, 1.585]));
    scene.place(&chest(), turned(-90.0, [9.685, 0.0, -0.85]));
    scene.place(&door_leaf(), turned(84.0, [9.28, 0.0, 1.63]));
    scene.place(&potted_fern(22, 9), at(9.27, 0.0, -1.97));
    scene.place(&drapes(2.42, 2.9, 0.5, 6), at(6.35, 0.0, -2.4));
}

/// Desk with a lamp, a chair, two bookcases, an uplighter.
fn study(scene: &mut Assembly) {
    scene.place(&desk(), turned(180.0, [8.3, 0.0, 5.56]));
    scene.place(&chair("wood", "seats"), turned(12.0, [8.4, 0.016, 4.62]));
    scene.add_at("rug", &rug(Vec2::new(1.6, 1.3)), at(8.4, 0.002, 4.1));
    scene.place(&bookcase("lacquer", Vec3::new(1.2, 2.1, 0.3), 6, 21), turned(-90.0, [9.68, 0.0, 4.85]));
    scene.place(&bookcase("lacquer", Vec3::new(1.1, 1.25, 0.3), 3, 22), turned(90.0, [5.72, 0.0, 4.75]));
    scene.place(&uplighter("ceiling_light", 1.75), at(9.35, 0.0, 3.5));
    scene.add_at("vases", &VASE.turned(1.0), at(5.87, 1.28, 4.55));
    scene.place(&door_leaf(), turned(-88.0, [7.48, 0.0, 3.07]));
}
