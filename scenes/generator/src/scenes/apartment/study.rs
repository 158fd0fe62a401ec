//! The study: a desk with a lamp, a chair, two bookcases, an uplighter.

use super::living::VASE;
use crate::props::furniture::{bookcase, chair, door_leaf, framed_panel, knob, pile, rug, shaded, uplighter};
use crate::shapes::*;
use glam::{Vec2, Vec3};

pub fn add(scene: &mut Assembly) {
    scene.place(&desk(), turned(180.0, [8.3, 0.0, 5.56]));
    scene.place(&chair("wood", "seats"), turned(12.0, [8.4, 0.016, 4.62]));
    scene.add_at("rug", &rug(Vec2::new(1.6, 1.3)), at(8.4, 0.002, 4.1));
    scene.place(&bookcase("lacquer", Vec3::new(1.2, 2.1, 0.3), 6, 21), turned(-90.0, [9.68, 0.0, 4.85]));
    scene.place(&bookcase("lacquer", Vec3::new(1.1, 1.25, 0.3), 3, 22), turned(90.0, [5.72, 0.0, 4.75]));
    scene.place(&uplighter("ceiling_light", 1.75), at(9.35, 0.0, 3.5));
    scene.add_at("vases", &VASE.turned(1.0), at(5.87, 1.28, 4.55));
    scene.place(&door_leaf(), turned(-88.0, [7.48, 0.0, 3.07]));
}

/// A desk with three drawers on one side and legs on the other; the wall is at z = 0.
fn desk() -> Assembly {
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
