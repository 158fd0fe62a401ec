//! Surfaces through a stack of outlines: basins, panelled doors, rounded boxes, pillows.

use super::{Shell, arc, grid};
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Rectangle of `size` about the origin with corners rounded by `radius` in `steps` each,
/// counter-clockwise; 4 (steps + 1) points.
pub fn rounded_rectangle(size: Vec2, radius: f32, steps: usize) -> Vec<Vec2> {
    let radius = radius.min(0.499 * size.min_element());
    let inner = 0.5 * size - radius;
    let corners = [(1.0, -1.0, -90.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 90.0), (-1.0, -1.0, 180.0)];
    corners
        .iter()
        .flat_map(|&(x, y, from)| arc(Vec2::new(x, y) * inner, radius, from, from + 90.0, steps))
        .collect()
}

/// Surface through closed `rings` of equally many points, each counter-clockwise seen from where the
/// stack goes to; `close_start` and `close_end` fill the first and the last by a fan about its middle.
pub fn loft(rings: &[Vec<Vec3>], close_start: bool, close_end: bool, crease_degrees: f32) -> Shell {
    let mut rows = rings.to_vec();
    let middle = |ring: &Vec<Vec3>| vec![ring.iter().sum::<Vec3>() / ring.len() as f32; ring.len()];
    if let (true, Some(ring)) = (close_start, rings.first()) {
        rows.insert(0, middle(ring));
    }
    if let (true, Some(ring)) = (close_end, rings.last()) {
        rows.push(middle(ring));
    }
    grid(&rows, true, false, crease_degrees)
}

/// Stack of rounded rectangles upwards along y: `levels` are (inset from `size`, height), with corners
/// of `radius` less the inset. Closed as asked, with the first level's middle at x = z = 0.
pub fn stacked(
    size: Vec2,
    radius: f32,
    steps: usize,
    levels: &[(f32, f32)],
    close_start: bool,
    close_end: bool,
) -> Shell {
    let rings: Vec<Vec<Vec3>> = levels
        .iter()
        .map(|&(inset, height)| {
            let outline = rounded_rectangle(size - 2.0 * inset, (radius - inset).max(1e-3), steps);
            outline.iter().map(|p| Vec3::new(p.x, height, -p.y)).collect()
        })
        .collect();
    loft(&rings, close_start, close_end, 40.0)
}

/// Box between `low` and `high` with all edges rounded by `radius` in `steps`.
pub fn rounded_box(low: impl Into<Vec3>, high: impl Into<Vec3>, radius: f32, steps: usize) -> Shell {
    let (low, high) = (low.into(), high.into());
    let size = high - low;
    let radius = radius.min(0.49 * size.min_element());
    let quarter = |k: usize| (0.5 * PI * k as f32 / steps as f32).sin_cos();
    let lower = (0..=steps).map(|k| {
        let (sin, cos) = quarter(k);
        (radius * (1.0 - sin), radius * (1.0 - cos))
    });
    let upper = (0..=steps).map(|k| {
        let (sin, cos) = quarter(k);
        (radius * (1.0 - cos), size.y - radius * (1.0 - sin))
    });
    let levels: Vec<(f32, f32)> = lower.chain(upper).collect();
    let middle = 0.5 * (low + high);
    stacked(Vec2::new(size.x, size.z), radius, steps, &levels, true, true)
        .mapped(|p| p + Vec3::new(middle.x, low.y, middle.z))
}

/// Superellipsoid about the origin, from box (exponents near 0) to ellipsoid (1): `flatness` shapes the
/// section through the y axis, `squareness` the outline seen from above. Upholstery and pillows.
///
/// Paper: Barr, "Superquadrics and Angle-Preserving Transformations", 1981.
pub fn superellipsoid(
    radii: impl Into<Vec3>,
    flatness: f32,
    squareness: f32,
    segments: usize,
    rings: usize,
) -> Shell {
    let radii = radii.into();
    let power = |x: f32, e: f32| x.abs().powf(e).copysign(x);
    let rows: Vec<Vec<Vec3>> = (0..=rings)
        .map(|j| {
            let (sin_latitude, cos_latitude) = (PI * (j as f32 / rings as f32 - 0.5)).sin_cos();
            let pole = j == 0 || j == rings;
            let across = if pole { 0.0 } else { power(cos_latitude, flatness) };
            (0..segments)
                .map(|i| {
                    let (sin, cos) = (-TAU * (i as f32 + 0.5) / segments as f32).sin_cos();
                    let outline = Vec2::new(power(cos, squareness), power(sin, squareness)) * across;
                    Vec3::new(outline.x, power(sin_latitude, flatness), outline.y) * radii
                })
                .collect()
        })
        .collect();
    grid(&rows, true, false, 80.0)
}

/// Flat disc about the origin that looks along +y.
pub fn disc(radius: f32, segments: usize) -> Shell {
    let ring: Vec<Vec3> = (0..segments)
        .map(|i| {
            let (sin, cos) = (-TAU * i as f32 / segments as f32).sin_cos();
            radius * Vec3::new(cos, 0.0, sin)
        })
        .collect();
    loft(&[ring], false, true, 40.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_solids_are_closed_and_hold_their_volume() {
        let (low, high) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 4.0, 3.5));
        let round = rounded_box(low, high, 0.02, 4);
        assert!(round.is_closed());
        assert!((round.signed_volume() - 1.0).abs() < 0.01, "{}", round.signed_volume());
        let ball = superellipsoid(Vec3::ONE, 1.0, 1.0, 128, 64);
        assert!(ball.is_closed());
        assert!((ball.signed_volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.01);
        let pillow = superellipsoid(Vec3::ONE, 0.3, 0.3, 64, 32);
        assert!(pillow.is_closed() && pillow.signed_volume() > ball.signed_volume());
        let slab = stacked(Vec2::ONE, 0.1, 4, &[(0.0, 0.0), (0.0, 1.0)], true, true);
        assert!(slab.is_closed() && slab.signed_volume() > 0.98 && slab.signed_volume() < 1.0);
    }

    #[test]
    fn a_disc_looks_up() {
        let shell = disc(1.0, 64);
        for &[a, b, c] in &shell.triangles {
            let [a, b, c] = [a, b, c].map(|i| shell.points[i as usize]);
            assert!((b - a).cross(c - a).y > 0.0);
        }
    }
}
