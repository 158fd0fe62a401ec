//! The living room: a sitting corner on a rug, a sideboard, books, and a round table for four.

use super::HEIGHT;
use crate::props::furniture::{
    bar_handle, bookcase, casing, chair, curtain, framed_panel, pendant, pile, potted_fern,
    potted_rubber_tree, rug, shaded, sofa, turned_leg,
};
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Middle of the round table.
const TABLE: Vec3 = Vec3::new(4.42, 0.0, 3.72);

pub const VASE: Vessel = Vessel {
    outside: &[
        [0.045, 0.0],
        [0.05, 0.008],
        [0.085, 0.09],
        [0.08, 0.17],
        [0.035, 0.23],
        [0.04, 0.27],
        [0.048, 0.28],
    ],
    wall: 0.004,
    segments: 20,
    steps: 1,
};
const BOWL: Vessel = Vessel {
    outside: &[[0.06, 0.0], [0.062, 0.01], [0.12, 0.03], [0.16, 0.07]],
    wall: 0.005,
    segments: 24,
    steps: 2,
};

pub fn add(scene: &mut Assembly) {
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
    dining(scene);
    // Curtains to both sides of the window in the left wall, on a rail with turned ends.
    let mut drapes = Assembly::new();
    let (rail, length) = (2.48, 3.5);
    drapes.add("lamp_metal", &rod([0.0, rail, 0.1], [length, rail, 0.1], 0.012, 12));
    for x in [0.0, length] {
        drapes.add_at("lamp_metal", &ellipsoid(Vec3::splat(0.028), 12, 8), at(x, rail, 0.1));
    }
    for x in [0.12, length - 0.12] {
        drapes.add("lamp_metal", &rod([x, rail, 0.0], [x, rail, 0.1], 0.008, 8));
    }
    for x in [0.03, length - 0.63] {
        drapes.add_at("curtains", &curtain(0.6, 2.44, 7), at(x, rail - 0.005, 0.1));
    }
    scene.place(&drapes, turned(90.0, [0.0, 0.0, 4.25]));
}

fn coffee_table() -> Assembly {
    let mut table = Assembly::new();
    let top = rounded_box([-0.6, 0.4, -0.33], [0.6, 0.43, 0.33], 0.012, 3);
    table.add("lacquer", &top);
    table.add("lacquer", &beveled_box([-0.5, 0.13, -0.25], [0.5, 0.15, 0.25], 0.004));
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        table.add_at("wood", &turned_leg(0.401, 0.026, 10, 1), at(0.52 * x, 0.0, 0.26 * z));
    }
    table.place(&pile(11, 3), turned(18.0, [-0.36, 0.43, 0.12]));
    table.add_at("vases", &BOWL.turned(1.0), at(0.22, 0.43, 0.02));
    for (x, z) in [(0.03, 0.045), (0.05, -0.035), (-0.045, 0.0)] {
        table.add_at("fruit", &ellipsoid([0.038, 0.036, 0.038], 14, 9), at(0.22 + x, 0.479, 0.02 + z));
    }
    table.place(&pile(12, 2), turned(-20.0, [-0.1, 0.15, 0.05]));
    table
}

/// A low sideboard with four panelled doors on turned feet; on it a television, a vase and a lamp.
fn sideboard() -> Assembly {
    let mut board = Assembly::new();
    let (half, depth) = (0.95, 0.42);
    board.add("lacquer", &block([-half, 0.14, 0.0], [half, 0.56, depth - 0.02]));
    board.add(
        "lacquer",
        &beveled_box([-half - 0.012, 0.56, 0.0], [half + 0.012, 0.585, depth + 0.012], 0.004),
    );
    for (x, z) in [(-1.0, 0.06), (1.0, 0.06), (-1.0, depth - 0.08), (1.0, depth - 0.08)] {
        board.add_at("wood", &cone(0.016, 0.028, 0.14, 14), at(0.88 * x, 0.0, z));
    }
    for k in 0..4 {
        let x = -half + 0.475 * k as f32;
        board.add_at(
            "lacquer",
            &framed_panel(Vec2::new(0.469, 0.412), 0.02, 0.05),
            at(x + 0.003, 0.144, depth - 0.019),
        );
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

/// A round table on a turned column with three feet, four chairs and a lamp above.
fn dining(scene: &mut Assembly) {
    let mut table = Assembly::new();
    let top = [
        [0.0, 0.715],
        [0.5, 0.715],
        [0.53, 0.722],
        [0.535, 0.735],
        [0.525, 0.748],
        [0.51, 0.75],
        [0.0, 0.75],
    ];
    table.add("lacquer", &lathe(&top, 48));
    let column = [
        [0.16, 0.0],
        [0.17, 0.02],
        [0.06, 0.06],
        [0.04, 0.1],
        [0.055, 0.2],
        [0.075, 0.32],
        [0.04, 0.48],
        [0.05, 0.6],
        [0.12, 0.7],
    ];
    let mut profile = vec![Vec2::ZERO];
    profile.extend(spline(&column, 2));
    profile.push(Vec2::new(0.0, 0.7));
    table.add("wood", &lathe(&profile, 20));
    table.add_at("wood", &cylinder(0.2, 0.018, 24), at(0.0, 0.698, 0.0));
    table.add_at("vases", &VASE.turned(0.85), at(0.05, 0.75, -0.06));
    let chair = chair("wood", "seats");
    for k in 0..4 {
        let degrees = 45.0 + 90.0 * k as f32 + [4.0, -6.0, 5.0, -3.0][k];
        table.place(&chair, turned(degrees, Vec3::ZERO) * at(0.0, 0.0, -[0.6, 0.52, 0.5, 0.56][k]));
    }
    scene.place(&table, at(TABLE.x, 0.002, TABLE.z));
    scene.place(&pendant("lamp_light", 0.85), at(TABLE.x, HEIGHT, TABLE.z));
}

/// A framed picture on the wall z = 0, its lower left corner at the origin: a landscape of sky, woods and
/// field, different for every `seed`.
pub fn picture(size: Vec2, seed: u64) -> Assembly {
    let mut picture = Assembly::new();
    let mut rng = Rng::new(seed);
    picture.add("frames", &casing(size, 0.045, true));
    let flat = |low: Vec2, high: Vec2, z: f32| {
        let (low, size) = (low.extend(z), high - low);
        sheet(low, Vec3::X * size.x, Vec3::Y * size.y)
    };
    picture.add("pages", &flat(Vec2::splat(-0.005), size + 0.005, 0.006));
    let inner = |x: f32, y: f32| Vec2::splat(0.06) + (size - 0.12) * Vec2::new(x, y);
    picture.add("print_blue", &flat(inner(0.0, 0.0), inner(1.0, 1.0), 0.008));
    // Two ranges of hills, each in front of the one before.
    for (part, base, z) in [("print_green", 0.45, 0.01), ("print_ochre", 0.2, 0.0115)] {
        let (phase, waves, height) = (rng.range(0.0, 6.0), rng.range(2.0, 6.0), rng.range(0.05, 0.13));
        let level = base + rng.jitter(0.08);
        let hills = patch(24, 1, |u, v| {
            let skyline = level + height * (waves * u + phase).sin() + 0.3 * height * (3.1 * waves * u).cos();
            inner(u, v * skyline).extend(z)
        });
        picture.add(part, &hills);
    }
    let centre = inner(rng.range(0.2, 0.8), 0.8).extend(0.0095);
    let sun = disc(rng.range(0.05, 0.09) * size.min_element(), 24);
    picture.add_at("pages", &sun, standing_on(centre, centre + Vec3::Z));
    picture
}
