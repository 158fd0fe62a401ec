//! Planks with bevelled edges, staggered at random, in three shades.

use crate::shapes::*;
use glam::{Vec2, Vec3};

const PLANK: Vec2 = Vec2::new(1.6, 0.155);
const SHADES: [&str; 3] = ["parquet_light", "parquet_middle", "parquet_dark"];

pub fn add(scene: &mut Assembly) {
    let mut rng = Rng::new(17);
    for (low, high) in [(Vec2::ZERO, Vec2::new(5.65, 4.6)), (Vec2::new(5.65, -2.4), Vec2::new(9.7, 5.6))] {
        let rows = ((high.y - low.y) / PLANK.y).round() as usize;
        let width = (high.y - low.y) / rows as f32;
        for row in 0..rows {
            let z = low.y + (row as f32 + 0.5) * width;
            let mut from = low.x - rng.range(0.0, 0.8) * PLANK.x;
            while from < high.x - 0.02 {
                let (a, b) = (from.max(low.x), (from + PLANK.x).min(high.x));
                if b - a > 0.02 {
                    let size = Vec2::new(b - a - 0.0015, width - 0.0015);
                    let shade = SHADES[rng.below(SHADES.len())];
                    scene.add_at(shade, &plank(size), at(0.5 * (a + b), 0.0, z));
                }
                from += PLANK.x;
            }
        }
    }
}

/// Plank about the origin, 2 mm above y = 0, open below.
fn plank(size: Vec2) -> Shell {
    tile(size, 0.002, 0.0012, |p, height| Vec3::new(p.x, height, -p.y))
}
