//! Books and the shelves they stand on.

use crate::shapes::*;
use glam::{Affine3A, Quat, Vec3};

/// Parts books are divided into, for as many bindings.
const BINDINGS: [&str; 4] = ["books_red", "books_blue", "books_green", "books_cream"];

/// Book standing on y = 0 from x = 0, its spine towards +z at z = 0.
fn book(binding: &str, thickness: f32, height: f32, depth: f32) -> Assembly {
    let mut book = Assembly::new();
    let board = 0.0025;
    // Spine and boards, seen from above with the spine below.
    let inner = thickness - board;
    let right = [[0.0, 0.0], [thickness, 0.0], [thickness, depth], [inner, depth]];
    let left = [[inner, 0.004], [board, 0.004], [board, depth], [0.0, depth]];
    let rise = Affine3A::from_quat(Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2));
    book.add_at(binding, &extrude(&[right, left].concat(), &[], height), rise);
    let pages = block([board, 0.004, 0.006 - depth], [inner, height - 0.004, -0.004]);
    // Only the head and the fore-edge can be seen.
    let pages = [Vec3::X, -Vec3::X, Vec3::Z, -Vec3::Y].into_iter().fold(pages, Shell::without_faces);
    book.add("pages", &pages);
    book
}

/// Bookcase of `size` (width, height, depth) against the wall z = 0 with its middle at x = 0: `shelves`
/// boards with books and the odd gap, a back, parts `wood`, "books_…" and "pages".
pub fn bookcase(wood: &str, size: Vec3, shelves: usize, seed: u64) -> Assembly {
    let mut case = Assembly::new();
    let Vec3 { x: width, y: height, z: depth } = size;
    let (half, board) = (0.5 * width, 0.025);
    for side in [-1.0, 1.0] {
        let x = side * (half - 0.5 * board);
        case.add(wood, &beveled_box([x - 0.5 * board, 0.0, 0.0], [x + 0.5 * board, height, depth], 0.002));
    }
    let inner = half - board;
    case.add(wood, &block([-inner, 0.08, 0.004], [inner, height - 0.01, 0.012]));
    let (low, high) = ([-half - 0.01, height, 0.0], [half + 0.01, height + 0.03, depth + 0.012]);
    case.add(wood, &beveled_box(low, high, 0.006));
    case.add(wood, &block([-inner, 0.0, 0.02], [inner, 0.08, depth - 0.02]));
    let pitch = (height - 0.1) / shelves as f32;
    let mut rng = Rng::new(seed);
    for k in 0..shelves {
        let y = 0.08 + pitch * k as f32;
        case.add(wood, &beveled_box([-inner, y, 0.013], [inner, y + board, depth - 0.006], 0.002));
        let start = Vec3::new(-inner, y + board, depth - 0.03);
        let room = Vec3::new(2.0 * inner, pitch - board - 0.02, depth - 0.05);
        fill(&mut case, &mut rng, start, room);
    }
    case
}

/// Fills a shelf from `start`, its lower left front corner, with books and gaps; there is `room` in each direction.
fn fill(case: &mut Assembly, rng: &mut Rng, start: Vec3, room: Vec3) {
    let mut x = 0.004;
    while x < room.x - 0.07 {
        if rng.unit() < 0.05 && x > 0.1 {
            x += rng.range(0.06, 0.16);
            continue;
        }
        let thickness = rng.range(0.024, 0.062);
        let height = (rng.range(0.17, 0.27)).min(room.y - 0.005);
        let depth = rng.range(0.13, 0.19).min(room.z);
        let binding = BINDINGS[rng.below(BINDINGS.len())];
        let set_back = rng.range(0.0, 0.012);
        let place = at(start.x + x, start.y, start.z - set_back);
        case.place(&book(binding, thickness, height, depth), place);
        x += thickness + rng.range(0.0005, 0.002);
    }
}

/// Small pile of lying books on y = 0.
pub fn pile(seed: u64, count: usize) -> Assembly {
    let mut pile = Assembly::new();
    let mut rng = Rng::new(seed);
    let mut y = 0.0;
    for _ in 0..count {
        let thickness = rng.range(0.02, 0.035);
        let (height, depth) = (rng.range(0.2, 0.26), rng.range(0.15, 0.19));
        let lying = Affine3A::from_quat(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
        let place = turned(rng.jitter(14.0), [0.0, y, 0.0]) * at(0.5 * height, 0.0, 0.5 * depth) * lying;
        pile.place(&book(BINDINGS[rng.below(BINDINGS.len())], thickness, height, depth), place);
        y += thickness + 0.0005;
    }
    pile
}
