//! Vases, bowls and pictures.

use super::casing;
use crate::shapes::*;
use glam::{Vec2, Vec3};

#[rustfmt::skip]
pub const VASE: Vessel = Vessel::new(&[[0.045, 0.0], [0.05, 0.008], [0.085, 0.09], [0.08, 0.17], [0.035, 0.23],
    [0.04, 0.27], [0.048, 0.28]], 0.004, 20, 1);
pub const BOWL: Vessel = Vessel::new(&[[0.06, 0.0], [0.062, 0.01], [0.12, 0.03], [0.16, 0.07]], 0.005, 24, 2);

/// Framed picture on the wall z = 0, its lower left corner at the origin: a landscape of sky, woods and field,
/// different for every `seed`.
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
