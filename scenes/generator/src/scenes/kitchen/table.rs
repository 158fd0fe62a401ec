//! The table with turned legs, four chairs around it and places laid on it, under three hanging lamps.

use super::room::ROOM;
use crate::props::furniture::{chair, dining_table, downlight, pendant, uplighter};
use crate::props::kitchen::tableware;
use crate::shapes::*;
use glam::Vec3;

const CENTRE: Vec3 = Vec3::new(1.75, 0.0, 2.55);
const TOP: Vec3 = Vec3::new(1.5, 0.75, 0.88);

pub fn add(scene: &mut Assembly) {
    let mut group = Assembly::new();
    group.place(&dining_table(TOP), at(0.0, 0.0, 0.0));
    let chair = chair("wood", "cloth");
    // Pulled out by different amounts, turned a little.
    let seats = [(-0.36, -0.5, 3.0), (0.37, -0.47, -6.0), (-0.35, 0.62, 176.0), (0.42, 0.56, 192.0)];
    for (x, z, degrees) in seats {
        group.place(&chair, turned(degrees, [x, 0.0, z]));
    }
    lay(&mut group);
    scene.place(&group, turned(4.0, CENTRE));
    for x in [-0.45, 0.0, 0.45] {
        scene.place(&pendant("pendant_light", 0.68), at(CENTRE.x + x, ROOM.y, CENTRE.z - 0.05 * x));
    }
    for (x, z) in [(1.2, 1.2), (3.4, 1.2), (1.2, 3.5), (3.4, 3.0)] {
        scene.place(&downlight("lamp_metal", "down_light", 0.045), at(x, ROOM.y, z));
    }
    scene.place(&uplighter("up_light", 1.8), at(0.4, 0.0, 3.78));
}

/// Places laid for four, fruit and bottles.
fn lay(group: &mut Assembly) {
    let mut place = Assembly::new();
    place.add("crockery", &tableware::PLATE.turned(1.0));
    place.add_at("glaze", &tableware::BOWL.turned(1.0), at(0.0, 0.007, 0.0));
    place.place(&tableware::cutlery(), at(0.0, 0.0, 0.0));
    place.add_at("tumblers", &tableware::TUMBLER.turned(1.0), at(0.17, 0.0, -0.17));
    for (z, degrees) in [(-0.27, 180.0), (0.27, 0.0)] {
        for x in [-0.36, 0.36] {
            group.place(&place, turned(degrees, [x, TOP.y, z]));
        }
    }
    group.place(&tableware::fruit_bowl(), at(0.0, TOP.y, -0.02));
    group.add_at("bottles", &tableware::BOTTLE.turned(1.0), at(-0.02, TOP.y, 0.3));
    group.add_at("bottles", &tableware::BOTTLE.turned(0.75), at(0.06, TOP.y, -0.31));
}
