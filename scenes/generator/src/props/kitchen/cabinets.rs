//! Cupboards: bodies, panelled doors, drawers, worktops. A unit is built about its lower left rear corner,
//! x along the wall, z off it.

use super::{BASE_DEPTH, WALL_UNIT, WORKTOP, WORKTOP_DEPTH};
use crate::props::furniture::{bar_handle, downlight, framed_panel, knob, on_end};
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Height of the recessed plinth below base cupboards.
const PLINTH: f32 = 0.1;
/// Thickness of the worktops.
const SLAB: f32 = 0.035;
/// Gap around each front.
const GAP: f32 = 0.003;
const FRONT: f32 = 0.02;

/// Doors and drawers of a unit.
#[derive(Clone, Copy, Debug)]
pub enum Fronts {
    /// One door hinged on the left.
    Left,
    /// One door hinged on the right.
    Right,
    /// Two doors.
    Pair,
    /// Drawer above two doors.
    DrawerAndPair,
    /// Stack of this many drawers.
    Drawers(usize),
}

/// Base cupboard of `width`.
pub fn base_unit(width: f32, fronts: Fronts) -> Assembly {
    base_unit_below(width, fronts, 0.0)
}

/// Base cupboard whose body ends `room` below the worktop, for a basin to hang in.
pub fn base_unit_below(width: f32, fronts: Fronts, room: f32) -> Assembly {
    let mut unit = Assembly::new();
    let top = WORKTOP - SLAB;
    unit.add("carcass", &block([0.0, PLINTH, 0.0], [width, top - room, BASE_DEPTH]));
    unit.add("plinth", &block(Vec3::ZERO, [width, PLINTH, BASE_DEPTH - 0.06]));
    let low = Vec2::new(0.0, PLINTH + 0.005);
    add_fronts(&mut unit, low, Vec2::new(width, top) - low, BASE_DEPTH, fronts, true);
    unit
}

/// Wall cupboard of `width`, hung at its height, with a light below it: parts "under_case", "under_light".
pub fn wall_unit(width: f32, fronts: Fronts, light: bool) -> Assembly {
    let (low, height, depth) = WALL_UNIT;
    let mut unit = Assembly::new();
    unit.add("carcass", &block([0.0, low, 0.0], [width, low + height, depth]));
    let (top, overhang) = (low + height, [width + 0.002, low + height + 0.045, depth + 0.05]);
    unit.add("fronts", &beveled_box([-0.002, top, 0.0], overhang, 0.012));
    add_fronts(&mut unit, Vec2::new(0.0, low), Vec2::new(width, height), depth, fronts, false);
    if light {
        unit.place(&downlight("lamp_metal", "under_light", 0.035), at(0.5 * width, low, 0.6 * depth));
    }
    unit
}

fn add_fronts(unit: &mut Assembly, low: Vec2, size: Vec2, depth: f32, fronts: Fronts, base: bool) {
    let half = Vec2::new(0.5 * size.x, size.y);
    match fronts {
        Fronts::Left => add_door(unit, low, size, depth, true, base),
        Fronts::Right => add_door(unit, low, size, depth, false, base),
        Fronts::Pair => {
            add_door(unit, low, half, depth, true, base);
            add_door(unit, low + Vec2::X * half.x, half, depth, false, base);
        }
        Fronts::DrawerAndPair => {
            let drawer = 0.16;
            add_drawer(unit, low + Vec2::Y * (size.y - drawer), Vec2::new(size.x, drawer), depth);
            let below = Vec2::new(size.x, size.y - drawer);
            add_fronts(unit, low, below, depth, Fronts::Pair, base);
        }
        Fronts::Drawers(count) => {
            // The uppermost is half as high as the others.
            let high = size.y / (count as f32 - 0.5);
            for k in 0..count {
                let top = k + 1 == count;
                let height = if top { 0.5 * high } else { high };
                add_drawer(unit, low + Vec2::Y * high * k as f32, Vec2::new(size.x, height), depth);
            }
        }
    }
}

fn add_door(unit: &mut Assembly, low: Vec2, size: Vec2, depth: f32, hinged_left: bool, base: bool) {
    let place = at(low.x + GAP, low.y + GAP, depth + 0.001);
    unit.add_at("fronts", &framed_panel(size - 2.0 * GAP, FRONT, 0.062), place);
    let x = if hinged_left { low.x + size.x - 0.035 } else { low.x + 0.035 };
    let y = if base { low.y + size.y - 0.13 } else { low.y + 0.13 };
    unit.add_at("handles", &bar_handle(0.13, 0.032, 0.0055), on_end([x, y, depth + FRONT]));
}

fn add_drawer(unit: &mut Assembly, low: Vec2, size: Vec2, depth: f32) {
    let place = at(low.x + GAP, low.y + GAP, depth + 0.001);
    let frame = if size.y < 0.2 { 0.032 } else { 0.05 };
    unit.add_at("fronts", &framed_panel(size - 2.0 * GAP, FRONT, frame), place);
    let middle = at(low.x + 0.5 * size.x, low.y + 0.5 * size.y, depth + FRONT - 0.004);
    if size.x > 0.7 {
        unit.add_each("handles", &knob(0.016), [-0.25, 0.25].map(|x| middle * at(x * size.x, 0.0, 0.0)));
    } else {
        unit.add_at("handles", &bar_handle(0.16, 0.036, 0.0055), middle);
    }
}

/// Worktop from x = `from` to `to`, with `holes` in (x, depth).
pub fn worktop(from: f32, to: f32, holes: &[Vec<Vec2>]) -> Shell {
    // Outline y runs towards the wall, so that the slab grows upwards.
    let flip = |p: &Vec2| Vec2::new(p.x, -p.y);
    let outline = rectangle(Vec2::new(from, -WORKTOP_DEPTH), Vec2::new(to, 0.0));
    let holes: Vec<Vec<Vec2>> = holes.iter().map(|h| h.iter().map(flip).collect()).collect();
    let slab = extrude(&outline, &holes, SLAB);
    slab.transformed(upright([0.0, WORKTOP - SLAB, 0.0], Vec3::X, -Vec3::Z))
}

/// Open shelf of `width` on two brackets, its upper face at y = 0.
pub fn shelf(width: f32, depth: f32) -> Assembly {
    let mut shelf = Assembly::new();
    shelf.add("wood", &beveled_box([0.0, -0.028, 0.0], [width, 0.0, depth], 0.003));
    let top = [[0.0, 0.0], [0.85 * depth, 0.0], [0.8 * depth, -0.02]];
    let bracket = [top, [[0.3 * depth, -0.05], [0.03, -0.15], [0.0, -0.17]]].concat();
    let places = [0.08, width - 0.08].map(|x| at(x, -0.028, 0.0) * turned(-90.0, Vec3::ZERO));
    shelf.add_each("handles", &extrude(&bracket, &[], 0.014), places);
    shelf
}
