//! The pavement: slabs with worn edges in two kinds of stone, each a little off level, on a bed of mortar; and
//! the steps and floor of the chancel.

use super::plan::{AISLE, CHANCEL, CHANCEL_FLOOR, EAST, NAVE};
use crate::shapes::*;
use glam::{Vec2, Vec3};

const LIGHT: &str = "slabs_light";
const BED: &str = "floor_bed";
const SLAB: f32 = 1.0;
const JOINT: f32 = 0.012;
const STEPS: usize = 3;
const TREAD: f32 = 0.36;

/// Light and dark slabs, and the mortar below them together with the chancel's steps.
pub fn add(scene: &mut Assembly) {
    let mut rng = Rng::new(3);
    let half_width = AISLE[1];
    let columns = (2.0 * half_width / SLAB).round() as usize;
    let rows = (-EAST / SLAB).round() as usize;
    for row in 0..rows {
        for column in 0..columns {
            let low = Vec2::new(-half_width + SLAB * column as f32, -SLAB * (row + 1) as f32);
            let under_chancel = low.y + SLAB < CHANCEL && low.x.abs().max((low.x + SLAB).abs()) <= NAVE;
            if under_chancel {
                continue;
            }
            let part = if (row + column) % 2 == 0 { LIGHT } else { "slabs_dark" };
            scene.add(part, &worn_slab(low, &mut rng));
        }
    }
    let corner = Vec3::new(-half_width - 0.2, -0.016, EAST - 0.2);
    scene.add(BED, &sheet(corner, Vec3::Z * (0.4 - EAST), Vec3::X * (2.0 * half_width + 0.4)));
    chancel(scene);
}

/// Slab, its top slightly tilted.
fn worn_slab(low: Vec2, rng: &mut Rng) -> Shell {
    let tilt = Vec2::new(rng.jitter(0.002), rng.jitter(0.002));
    let height = rng.range(-0.002, 0.002);
    let centre = low + Vec2::splat(0.5 * SLAB);
    let joint = Vec2::splat(0.5 * JOINT);
    slab(low + joint, low + Vec2::splat(SLAB) - joint, 0.03, 0.012).mapped(|p| {
        let lift = if p.y < 0.0 { 0.0 } else { height + tilt.dot(Vec2::new(p.x, p.z) - centre) };
        p + Vec3::Y * lift
    })
}

fn chancel(scene: &mut Assembly) {
    let rise = CHANCEL_FLOOR / STEPS as f32;
    for step in 0..STEPS {
        let front = CHANCEL - TREAD * step as f32;
        let back = if step + 1 == STEPS { EAST } else { front - TREAD - 0.1 };
        let low = Vec3::new(-NAVE + 0.01, -0.05, back);
        let high = Vec3::new(NAVE - 0.01, rise * (step + 1) as f32, front);
        let part = if step + 1 == STEPS { LIGHT } else { BED };
        scene.add(part, &beveled_box(low, high, 0.02));
    }
    // The floor of the apse, a little larger than it so that it ends inside the walls.
    let outline: Vec<Vec2> = arc(Vec2::ZERO, NAVE + 0.25, 0.0, 180.0, 10);
    let floor = extrude(&outline, &[], 0.5)
        .mapped(|p| Vec3::new(p.x, p.z - 0.5 + CHANCEL_FLOOR - 0.003, EAST - p.y + 0.02));
    scene.add(LIGHT, &floor);
    scene.add(
        LIGHT,
        &beveled_box([-2.4, CHANCEL_FLOOR - 0.05, EAST - 2.9], [2.4, CHANCEL_FLOOR + 0.16, EAST + 0.6], 0.02),
    );
}
