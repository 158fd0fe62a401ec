//! The turned chair and its leg.

use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Foot, rings and a tapering vase, as shares of the greatest radius and of the height.
#[rustfmt::skip]
const LEG: [[f32; 2]; 15] = [[0.42, 0.0], [0.5, 0.02], [0.5, 0.05], [0.4, 0.07], [0.5, 0.2], [0.8, 0.42], [0.92, 0.52],
    [0.75, 0.6], [0.5, 0.64], [0.72, 0.66], [0.72, 0.69], [0.5, 0.71], [0.78, 0.74], [1.0, 0.8], [1.0, 1.0]];

/// Turned leg of `height` and greatest radius `radius`.
pub fn turned_leg(height: f32, radius: f32, segments: usize, steps: usize) -> Shell {
    spindle(&scaled(&LEG, Vec2::new(radius, height)), steps, segments).creased(50.0)
}

/// Wooden chair, 0.45 m wide: turned legs and stretchers, spindles under a bent rail, all part `wood`,
/// and a cushion, part `cloth`.
pub fn chair(wood: &str, cloth: &str) -> Assembly {
    let mut chair = Assembly::new();
    let seat = superellipsoid([0.225, 0.016, 0.215], 0.35, 0.55, 24, 6);
    chair.add_at(wood, &seat, at(0.0, 0.44, 0.0));
    let cushion = superellipsoid([0.195, 0.02, 0.185], 0.6, 0.5, 20, 6);
    chair.add_at(cloth, &cushion, at(0.0, 0.472, 0.005));
    for side in [-1.0, 1.0] {
        let front = [Vec3::new(side * 0.195, 0.0, 0.185), Vec3::new(side * 0.165, 0.435, 0.15)];
        let rear = [Vec3::new(side * 0.185, 0.0, -0.215), Vec3::new(side * 0.155, 0.435, -0.16)];
        for [foot, top] in [front, rear] {
            chair.add_at(wood, &turned_leg(foot.distance(top), 0.02, 8, 1), standing_on(foot, top));
        }
        let at_height = |leg: [Vec3; 2], t: f32| leg[0].lerp(leg[1], t);
        chair.add(wood, &rod(at_height(front, 0.36), at_height(rear, 0.36), 0.0085, 8));
    }
    chair.add(wood, &rod([-0.183, 0.157, 0.0], [0.183, 0.157, 0.0], 0.0085, 8));
    back(&mut chair, wood);
    chair
}

/// Two posts, five turned spindles and the bent rail they carry.
fn back(chair: &mut Assembly, wood: &str) {
    let foot = |x: f32| Vec3::new(x, 0.445, -0.175 + 0.35 * x * x);
    let head = |x: f32| Vec3::new(1.12 * x, 0.86, -0.285 + 0.7 * x * x);
    for x in [-0.18, -0.11, -0.055, 0.0, 0.055, 0.11, 0.18_f32] {
        let (from, to) = (foot(x), head(x));
        let thick = if x.abs() > 0.15 { 0.014 } else { 0.0075 };
        let length = from.distance(to);
        let profile = [[0.7, 0.0], [1.0, 0.3], [1.2, 0.45], [0.9, 0.6], [0.65, 1.0]];
        let spindle = lathe(&scaled(&profile, Vec2::new(thick, length)), 8);
        chair.add_at(wood, &spindle, standing_on(from, to));
    }
    // The rail: a board bent about the sitter, thicker in the middle, rounded at both ends.
    let line =
        spline3(&[-0.235, -0.12, 0.0, 0.12, 0.235_f32].map(|x| Vec3::new(x, 0.885, -0.29 + 0.56 * x * x)), 4);
    let rings: Vec<Vec<Vec3>> = line
        .iter()
        .map(|&centre| {
            let ends = (1.0 - (centre.x / 0.236).powi(6)).max(0.0).sqrt().max(0.02);
            let section = (0..10).map(|k| (std::f32::consts::TAU * k as f32 / 10.0).sin_cos());
            section.map(|(sin, cos)| centre + ends * Vec3::new(0.0, 0.045 * sin, -0.013 * cos)).collect()
        })
        .collect();
    chair.add(wood, &loft(&rings, true, true, 75.0));
}
