//! Pews, the altar with its cross, a pulpit and a font.

use super::plan::{CHANCEL_FLOOR, EAST, pier_z};
use crate::shapes::Part;
use crate::shapes::{at, beveled_box, block, cylinder, extrude, lathe, mirror_x, mirror_z, tube, turned};
use glam::{Vec2, Vec3};

/// Rows of pews on each side.
const ROWS: usize = 9;
const PITCH: f32 = 1.15;
/// z of the westernmost row.
const FIRST_ROW: f32 = -8.4;
const PEW: [f32; 2] = [1.0, 3.75];
/// Where the altar stands.
pub const ALTAR: Vec3 = Vec3::new(0.0, CHANCEL_FLOOR + 0.16, EAST - 1.7);

/// Appends everything wooden to `wood` and everything of stone to `stone`; the altar cloth is `cloth`.
pub fn build(wood: &mut Part, stone: &mut Part, cloth: &mut Part) {
    let mut pew = Part::default();
    one_pew(&mut pew);
    for row in 0..ROWS {
        let place = at(0.0, 0.0, FIRST_ROW - PITCH * row as f32);
        wood.append(&pew, &place);
        wood.append(&pew, &(mirror_x(0.0) * place));
    }
    altar(stone, cloth, wood);
    pulpit(wood, stone);
    stone.add_at(
        &lathe(&font_profile(), 8).creased(20.0),
        &turned(22.5, Vec3::new(-2.55, -0.01, pier_z(1) + 0.9)),
    );
}

/// A pew on the south side, its seat at z = 0, looking east.
fn one_pew(wood: &mut Part) {
    let [near, far] = PEW;
    wood.add(&block(Vec3::new(near, 0.43, -0.22), Vec3::new(far, 0.47, 0.2)));
    // The back leans a little, under a moulded rail.
    let lean = |p: Vec3| Vec3::new(p.x, p.y, p.z + 0.14 * (p.y - 0.45));
    wood.add(&block(Vec3::new(near, 0.12, 0.2), Vec3::new(far, 0.88, 0.225)).mapped(lean));
    wood.add(
        &beveled_box(Vec3::new(near - 0.02, 0.86, 0.17), Vec3::new(far + 0.02, 0.92, 0.25), 0.02)
            .mapped(lean),
    );
    wood.add(&block(Vec3::new(near, 0.6, 0.33), Vec3::new(far, 0.63, 0.47)));
    wood.add(&block(Vec3::new(near, 0.12, 0.46), Vec3::new(far, 0.16, 0.62)));
    let end: Vec<Vec2> = [
        [-0.26, -0.02],
        [0.5, -0.02],
        [0.5, 0.16],
        [0.42, 0.3],
        [0.38, 0.6],
        [0.34, 0.86],
        [0.33, 1.0],
        [0.28, 1.06],
        [0.21, 1.07],
        [0.16, 1.02],
        [0.15, 0.92],
        [0.12, 0.72],
        [0.05, 0.6],
        [-0.08, 0.56],
        [-0.22, 0.58],
        [-0.27, 0.52],
        [-0.26, 0.4],
    ]
    .iter()
    .map(|p| Vec2::from_array(*p))
    .collect();
    // Outline in z and y; the prism's depth becomes x.
    let end = extrude(&end, &[], 0.06).mapped(|p| Vec3::new(p.z, p.y, p.x)).flipped();
    for x in [near - 0.05, far - 0.01] {
        wood.add_at(&end, &at(x, 0.0, 0.0));
    }
}

fn altar(stone: &mut Part, cloth: &mut Part, wood: &mut Part) {
    let base = at(ALTAR.x, ALTAR.y, ALTAR.z);
    stone.add_at(&beveled_box(Vec3::new(-1.25, -0.05, -0.5), Vec3::new(1.25, 0.12, 0.5), 0.03), &base);
    stone.add_at(&block(Vec3::new(-1.1, 0.1, -0.4), Vec3::new(1.1, 0.95, 0.4)), &base);
    stone.add_at(&beveled_box(Vec3::new(-1.3, 0.93, -0.5), Vec3::new(1.3, 1.05, 0.5), 0.03), &base);
    let leg = lathe(
        &[[0.1, 0.1], [0.1, 0.16], [0.06, 0.22], [0.06, 0.8], [0.1, 0.88], [0.1, 0.95]].map(Vec2::from_array),
        10,
    );
    for x in [-1.12, -0.4, 0.4, 1.12] {
        stone.add_at(&leg, &(base * at(x, 0.0, 0.43)));
    }
    // The cloth lies over the slab and hangs down at both ends, with a few folds.
    cloth.add_at(&beveled_box(Vec3::new(-1.32, 1.035, -0.46), Vec3::new(1.32, 1.062, 0.515), 0.008), &base);
    for side in [-1.0, 1.0] {
        let fall = crate::shapes::patch(20, 3, |u, v| {
            let fold = 0.02 * (1.0 - v) * (u * 40.0).sin();
            Vec3::new(side * (1.322 + fold.abs()), 0.35 + 0.7 * v, -0.46 + 0.975 * u)
        });
        cloth.add_at(&fall.facing(Vec3::new(side * 9.0, 0.7, 0.0)), &base);
    }
    let front = crate::shapes::patch(50, 3, |u, v| {
        let fold = 0.015 * (1.0 - v) * (u * 90.0).sin();
        Vec3::new(-1.32 + 2.64 * u, 0.62 + 0.43 * v, 0.517 + fold.abs())
    });
    cloth.add_at(&front.facing(Vec3::new(0.0, 0.7, 9.0)), &base);
    // A standing cross behind the altar.
    let cross = at(ALTAR.x, ALTAR.y, ALTAR.z - 1.0);
    wood.add_at(&beveled_box(Vec3::new(-0.35, -0.05, -0.35), Vec3::new(0.35, 0.2, 0.35), 0.04), &cross);
    wood.add_at(&beveled_box(Vec3::new(-0.09, 0.15, -0.07), Vec3::new(0.09, 3.6, 0.07), 0.02), &cross);
    wood.add_at(&beveled_box(Vec3::new(-0.85, 2.55, -0.065), Vec3::new(0.85, 2.73, 0.065), 0.02), &cross);
}

/// An eight-sided pulpit on a column, with a panelled parapet.
fn pulpit(wood: &mut Part, stone: &mut Part) {
    let place = turned(22.5, Vec3::new(-3.1, -0.01, pier_z(4) - 1.9));
    let column: Vec<Vec2> = [
        [0.5, 0.0],
        [0.5, 0.15],
        [0.3, 0.22],
        [0.2, 0.4],
        [0.2, 0.95],
        [0.26, 1.1],
        [0.5, 1.3],
        [0.76, 1.42],
        [0.0, 1.42],
    ]
    .iter()
    .map(|p| Vec2::from_array(*p))
    .collect();
    stone.add_at(&lathe(&column, 8).creased(20.0), &place);
    wood.add_at(&tube(0.72, 0.78, 0.95, 8).creased(20.0), &(place * at(0.0, 1.4, 0.0)));
    wood.add_at(&tube(0.69, 0.86, 0.08, 8).creased(20.0), &(place * at(0.0, 2.34, 0.0)));
    wood.add_at(&tube(0.7, 0.84, 0.07, 8).creased(20.0), &(place * at(0.0, 1.4, 0.0)));
    for k in 0..8 {
        let panel = beveled_box(Vec3::new(-0.2, 1.58, -0.02), Vec3::new(0.2, 2.24, 0.02), 0.015);
        let turn = turned(45.0 * k as f32 + 22.5, Vec3::ZERO);
        wood.add_at(&panel, &(place * turn * at(0.0, 0.0, 0.78 * 22.5_f32.to_radians().cos())));
    }
    wood.add_at(&cylinder(0.04, 1.3, 8), &(place * at(0.55, 1.42, 0.0) * mirror_z(0.0)));
}

fn font_profile() -> Vec<Vec2> {
    [
        [0.75, 0.0],
        [0.75, 0.16],
        [0.5, 0.17],
        [0.5, 0.3],
        [0.34, 0.4],
        [0.26, 0.5],
        [0.26, 0.68],
        [0.36, 0.78],
        [0.58, 0.86],
        [0.6, 0.9],
        [0.6, 1.2],
        [0.64, 1.24],
        [0.64, 1.32],
        [0.5, 1.32],
        [0.46, 1.14],
        [0.0, 1.08],
    ]
    .iter()
    .map(|p| Vec2::from_array(*p))
    .collect()
}
