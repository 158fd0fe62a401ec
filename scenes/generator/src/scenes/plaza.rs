//! A plaza at night: 140 blocks (houses with set-back tops, kiosks with roofs, benches, and a monument in four tiers)
//! under strings of small lamps. The lamps' surface together does not depend on their number.

use crate::shapes::*;
use glam::Vec3;
use std::f32::consts::TAU;

/// Number of lamps by default.
pub const LAMPS: u32 = 1000;

/// Half the side of the paved square, and the side of a paving tile.
const HALF: f32 = 32.0;
const TILE: f32 = 2.0;

/// Surface of all lamps together, m².
const LAMP_AREA: f32 = 40.0;

/// Numbers of blocks.
const HOUSES_A_SIDE: usize = 10;
const KIOSKS: usize = 20;
const BENCHES: usize = 16;

/// Top of the mast, from which strings of lamps run to the houses, and the number of these strings.
const MAST: Vec3 = Vec3::new(0.0, 17.0, 0.0);
const STRINGS: u32 = 24;

/// Materials of houses and of kiosks.
const WALLS: [&str; 4] = ["plaster", "brick", "stone", "slate"];
const STALLS: [&str; 3] = ["red_paint", "blue_paint", "bronze"];

/// Colours of lamps.
const COLOURS: [&str; 3] = ["white_lamps", "amber_lamps", "rose_lamps"];

/// Parts of the scene with so many lamps.
pub fn parts(lamps: u32) -> Vec<Part> {
    let mut scene = Assembly::new();
    paving(&mut scene);
    houses(&mut scene);
    let kiosks = kiosks(&mut scene);
    middle(&mut scene);
    hang(&mut scene, &kiosks, lamps.max(1));
    scene.into_parts()
}

fn paving(scene: &mut Assembly) {
    let count = (2.0 * HALF / TILE) as i32;
    for (i, k) in (0..count).flat_map(|i| (0..count).map(move |k| (i, k))) {
        let name = if (i + k) % 2 == 0 { "pale_paving" } else { "dark_paving" };
        let corner = Vec3::new(i as f32 * TILE - HALF, 0.0, (k + 1) as f32 * TILE - HALF);
        scene.add(name, &sheet(corner, Vec3::X * TILE, -Vec3::Z * TILE));
    }
}

/// Houses around the square, each with a narrower block on top.
fn houses(scene: &mut Assembly) {
    let mut rng = Rng::new(7);
    let width = 2.0 * HALF / HOUSES_A_SIDE as f32;
    for side in 0..4 {
        let turn = turned(90.0 * side as f32, Vec3::ZERO);
        for i in 0..HOUSES_A_SIDE {
            let (x, depth, height) = (i as f32 * width - HALF, rng.range(5.0, 8.0), rng.range(7.0, 13.0));
            let house = block([x + 0.05, 0.0, -HALF - depth], [x + width - 0.05, height, -HALF]);
            let inset = rng.range(0.6, 1.4);
            let low = [x + inset, height, -HALF - depth + 0.5];
            let top = block(low, [x + width - inset, height + rng.range(1.5, 4.0), -HALF - inset]);
            scene.add_at(WALLS[rng.below(WALLS.len())], &house, turn);
            scene.add_at(WALLS[rng.below(WALLS.len())], &top.without_faces(-Vec3::Y), turn);
        }
    }
}

/// Kiosks in a ring, each a body under a wider roof; returns the middles of the roofs' edges.
fn kiosks(scene: &mut Assembly) -> Vec<Vec3> {
    let mut rng = Rng::new(11);
    let mut eaves = Vec::new();
    for i in 0..KIOSKS {
        let angle = TAU * (i as f32 + 0.5) / KIOSKS as f32;
        let radius = if i % 2 == 0 { 13.0 } else { 19.5 };
        let place =
            turned(-angle.to_degrees() + rng.jitter(12.0), [radius * angle.cos(), 0.0, radius * angle.sin()]);
        scene.add_at(STALLS[i % STALLS.len()], &beveled_box([-1.1, 0.0, -1.1], [1.1, 2.3, 1.1], 0.05), place);
        let roof = frustum([-1.6, 2.3, -1.6], [1.6, 3.1, 1.6], glam::Vec2::splat(0.35));
        scene.add_at(WALLS[i % WALLS.len()], &roof, place);
        let sides = [Vec3::X, Vec3::Z, -Vec3::X, -Vec3::Z].map(|side| Vec3::Y * 2.2 + side * 1.7);
        eaves.extend(sides.map(|side| place.transform_point3(side)));
    }
    eaves
}

/// Benches, and the monument with its mast.
fn middle(scene: &mut Assembly) {
    for i in 0..BENCHES {
        let place = turned(360.0 / BENCHES as f32 * i as f32, Vec3::ZERO);
        scene.add_at("wood", &block([-0.9, 0.0, 8.0], [0.9, 0.45, 8.5]), place);
    }
    for (tier, [half, low, high]) in
        [[4.0, 0.0, 0.5], [3.0, 0.5, 1.0], [1.2, 1.0, 4.5]].into_iter().enumerate()
    {
        let name = if tier == 2 { "stone" } else { "slate" };
        scene.add(name, &block([-half, low, -half], [half, high, half]).without_faces(-Vec3::Y));
    }
    scene.add("bronze", &block([-0.25, 4.5, -0.25], [0.25, MAST.y, 0.25]).without_faces(-Vec3::Y));
}

/// Hangs the lamps: four of five along strings from the mast, the others under the roofs of kiosks and over them.
fn hang(scene: &mut Assembly, eaves: &[Vec3], count: u32) {
    let radius = (LAMP_AREA / (count as f32 * 2.0 * TAU)).sqrt();
    let lamp = ellipsoid(Vec3::splat(radius), 6, 4);
    let on_eaves = count / 5;
    let on_strings = count - on_eaves;
    let mut rng = Rng::new(13);
    let mut add = |i: u32, at: Vec3| {
        let colour = COLOURS[[0, 0, 1, 0, 2, 1][i as usize % 6]];
        scene.add_at(colour, &lamp, posed(glam::Quat::IDENTITY, at));
    };
    for i in 0..on_strings {
        let (string, place) = (i % STRINGS, (i / STRINGS) as f32 + 0.5);
        let share = place / on_strings.div_ceil(STRINGS) as f32;
        let angle = TAU * (string as f32 + 0.5) / STRINGS as f32;
        let end = Vec3::new(0.96 * HALF * angle.cos(), 7.0, 0.96 * HALF * angle.sin());
        let sag = Vec3::Y * (-4.0 * 2.2 * share * (1.0 - share));
        add(string + i / STRINGS, MAST - Vec3::Y + (end - MAST) * (0.04 + 0.96 * share) + sag);
    }
    for i in 0..on_eaves {
        let along = Vec3::new(rng.jitter(1.0), 0.0, rng.jitter(1.0));
        let level = (i as usize / eaves.len()) as f32;
        add(i + 2, eaves[i as usize % eaves.len()] + along * level.min(1.0) - Vec3::Y * 0.1 * (level % 8.0));
    }
}
