//! Positions of cupboards and appliances, and of the objects on them.

use super::room::ROOM;
use crate::props::kitchen::cabinets::{Fronts, base_unit, base_unit_below, shelf, wall_unit, worktop};
use crate::props::kitchen::{WORKTOP, WORKTOP_DEPTH, appliances, sink, tableware};
use crate::shapes::*;
use glam::Vec2;

pub fn add(scene: &mut Assembly) {
    scene.place(&back_run(), at(0.0, 0.0, 0.0));
    // Along the right wall, x runs towards the viewer.
    scene.place(&right_run(), turned(-90.0, [ROOM.x, 0.0, 0.0]));
}

fn back_run() -> Assembly {
    let mut run = Assembly::new();
    run.place(&appliances::refrigerator(), at(0.01, 0.0, 0.02));
    for (x, width, fronts) in [
        (0.72, 0.6, Fronts::Drawers(3)),
        (1.32, 0.8, Fronts::DrawerAndPair),
        (2.72, 0.9, Fronts::DrawerAndPair),
        (3.62, 0.38, Fronts::Left),
    ] {
        run.place(&base_unit(width, fronts), at(x, 0.0, 0.0));
    }
    run.place(&appliances::cooker(), at(2.12, 0.0, 0.0));
    run.add("worktop", &worktop(0.71, ROOM.x, &[]));
    run.place(&appliances::hood(ROOM.y - 1.5), at(2.12, 1.5, 0.0));
    for (x, width, fronts) in [
        (1.52, 0.6, Fronts::Pair),
        (2.72, 0.7, Fronts::Pair),
        (3.42, 0.7, Fronts::Pair),
        (4.12, 0.48, Fronts::Left),
    ] {
        run.place(&wall_unit(width, fronts, true), at(x, 0.0, 0.0));
    }
    // Where the two runs meet, boards close the corner between their fronts.
    let top = WORKTOP - 0.035;
    run.add("fronts", &block([3.985, 0.1, 0.0], [4.018, top, 0.6]));
    run.add("fronts", &block([4.002, 0.1, 0.55], [ROOM.x, top, 0.648]));
    shelves(&mut run);
    // On the worktop, from left to right.
    for (k, scale) in [1.1, 1.0, 0.9].into_iter().enumerate() {
        let jar = tableware::jar("jars", Vec2::new(scale, 1.3 * scale));
        run.place(&jar, at(0.84 + 0.14 * k as f32, WORKTOP, 0.16));
    }
    run.place(&appliances::toaster(), turned(8.0, [1.55, WORKTOP, 0.24]));
    run.place(&tableware::knife_block(), turned(-8.0, [1.95, WORKTOP, 0.18]));
    let deck = WORKTOP + 0.056;
    run.place(&tableware::pot(1.0), turned(20.0, [2.56, deck, 0.43]));
    run.place(&appliances::kettle(), turned(150.0, [2.28, deck, 0.19]));
    run.place(&tableware::pan(), turned(-60.0, [2.28, deck, 0.43]));
    run.add("wood", &rounded_box([2.86, WORKTOP, 0.2], [3.26, WORKTOP + 0.022, 0.48], 0.006, 3));
    run.add_at("bottles", &tableware::BOTTLE.turned(1.0), at(3.44, WORKTOP, 0.14));
    run.add_at("bottles", &tableware::BOTTLE.turned(0.85), at(3.54, WORKTOP, 0.2));
    for k in 0..3 {
        let place = turned(60.0 + 50.0 * k as f32, [3.85 + 0.13 * k as f32, WORKTOP, 0.2]);
        run.place(&tableware::mug("glaze"), place);
    }
    run
}

fn shelves(run: &mut Assembly) {
    let (left, depth) = (0.76, 0.22);
    for (level, y) in [1.5, 1.87].into_iter().enumerate() {
        run.place(&shelf(0.72, depth), at(left, y, 0.0));
        for k in 0..5 {
            let x = left + 0.09 + 0.135 * k as f32;
            match (level, k) {
                (0, 0..=2) => run.place(&tableware::jar("jars", Vec2::splat(1.0)), at(x, y, 0.11)),
                (0, _) => run.place(&tableware::mug("crockery"), turned(30.0 * k as f32, [x, y, 0.11])),
                (_, 0 | 1) => {
                    let stack = if k == 0 { 4 } else { 3 };
                    let places = (0..stack).map(|n| at(x + 0.05 * k as f32, y + 0.013 * n as f32, 0.11));
                    run.add_each("glaze", &tableware::BOWL.turned(1.0), places);
                }
                (_, 2) => run.add_at("bottles", &tableware::BOTTLE.turned(0.7), at(x + 0.04, y, 0.11)),
                _ => run.place(&tableware::jar("jars", Vec2::new(0.95, 1.2)), at(x, y, 0.11)),
            }
        }
    }
}

fn right_run() -> Assembly {
    let mut run = Assembly::new();
    for (x, width, fronts, room) in
        [(0.65, 0.7, Fronts::Pair, 0.0), (1.35, 0.9, Fronts::Pair, 0.2), (2.25, 0.6, Fronts::Drawers(4), 0.0)]
    {
        run.place(&base_unit_below(width, fronts, room), at(x, 0.0, 0.0));
    }
    let basin = Vec2::new(1.8, 0.33);
    run.add("worktop", &worktop(WORKTOP_DEPTH, 2.87, &[sink::cut_out(basin)]));
    run.place(&sink::sink(), at(basin.x, 0.0, basin.y));
    run.place(&wall_unit(0.3, Fronts::Right, true), at(2.57, 0.0, 0.0));
    // The draining side: a stack of plates and one of bowls; washing-up liquid by the tap.
    let plates = (0..6).map(|k| at(2.42, WORKTOP + 0.0065 * k as f32, 0.3));
    run.add_each("crockery", &tableware::PLATE.turned(1.0), plates);
    let side_plates = (0..4).map(|k| at(2.68, WORKTOP + 0.005 * k as f32, 0.24));
    run.add_each("crockery", &tableware::PLATE.turned(0.72), side_plates);
    run.add_at("glaze", &tableware::BOWL.turned(1.0), at(2.68, WORKTOP + 0.021, 0.24));
    run.add_at("jars", &tableware::BOTTLE.turned(0.6), at(1.5, WORKTOP, 0.1));
    let tumblers = [at(1.25, WORKTOP, 0.25), at(1.16, WORKTOP, 0.31)];
    run.add_each("tumblers", &tableware::TUMBLER.turned(1.0), tumblers);
    run
}
