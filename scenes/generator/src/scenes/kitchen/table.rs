//! The table with turned legs, four chairs around it and places laid on it, under three hanging lamps.

use super::ROOM;
use crate::props::furniture::{chair, downlight, pendant, turned_leg, uplighter};
use crate::props::kitchen::tableware;
use crate::shapes::*;
use glam::{Vec2, Vec3};

const CENTRE: Vec3 = Vec3::new(1.75, 0.0, 2.55);
const TOP: Vec3 = Vec3::new(1.5, 0.75, 0.88);

pub fn add(scene: &mut Assembly) {
    let mut group = Assembly::new();
    group.place(&table(), at(0.0, 0.0, 0.0));
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

fn table() -> Assembly {
    let mut table = Assembly::new();
    let half = Vec2::new(0.5 * TOP.x, 0.5 * TOP.z);
    let top = rounded_box([-half.x, TOP.y - 0.032, -half.y], [half.x, TOP.y, half.y], 0.009, 3);
    table.add("table_top", &top);
    let leg = half - 0.075;
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0_f32)] {
        table.add_at("wood", &turned_leg(0.62, 0.042, 18, 2), at(x * leg.x, 0.0, z * leg.y));
        let block = Vec3::new(x * leg.x, 0.668, z * leg.y);
        table.add(
            "wood",
            &beveled_box(block - Vec3::new(0.04, 0.05, 0.04), block + Vec3::new(0.04, 0.05, 0.04), 0.004),
        );
    }
    for z in [-leg.y, leg.y] {
        table.add(
            "wood",
            &beveled_box([0.04 - leg.x, 0.63, z - 0.012], [leg.x - 0.04, 0.718, z + 0.012], 0.003),
        );
    }
    for x in [-leg.x, leg.x] {
        table.add(
            "wood",
            &beveled_box([x - 0.012, 0.63, 0.04 - leg.y], [x + 0.012, 0.718, leg.y - 0.04], 0.003),
        );
    }
    table
}

fn lay(group: &mut Assembly) {
    let mut place = Assembly::new();
    place.add("crockery", &tableware::plate());
    place.add_at("glaze", &tableware::bowl(), at(0.0, 0.007, 0.0));
    place.place(&tableware::cutlery(), at(0.0, 0.0, 0.0));
    place.add_at("tumblers", &tableware::tumbler(), at(0.17, 0.0, -0.17));
    for (x, z, degrees) in
        [(-0.36, -0.27, 180.0), (0.36, -0.27, 180.0), (-0.36, 0.27, 0.0), (0.36, 0.27, 0.0)]
    {
        group.place(&place, turned(degrees, [x, TOP.y, z]));
    }
    group.place(&tableware::fruit_bowl(), at(0.0, TOP.y, -0.02));
    group.add_at("bottles", &tableware::bottle(1.0), at(-0.02, TOP.y, 0.3));
    group.add_at("bottles", &tableware::bottle(0.75), at(0.06, TOP.y, -0.31));
}
