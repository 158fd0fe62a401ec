//! Candles: parts "iron", "wax", "flames".

use crate::shapes::*;
use glam::{Affine3A, Vec3};

const CROWN_RADIUS: f32 = 1.15;

/// Candlestick of `height` in the frame `place`, with its candle.
pub fn candlestick(place: Affine3A, height: f32) -> Assembly {
    let mut stick = Assembly::framed(place);
    let s = (height / 0.42).sqrt();
    let foot = [[0.09 * s, 0.0], [0.09 * s, 0.02], [0.03 * s, 0.06], [0.018 * s, 0.1]];
    let knot = [[0.018 * s, 0.45 * height], [0.035 * s, 0.5 * height], [0.018 * s, 0.55 * height]];
    let dish = [[0.018 * s, 0.9 * height], [0.06 * s, height], [0.0, height]];
    stick.add("iron", &lathe(&[&foot[..], &knot, &dish].concat(), 8));
    stick.merge(candle(place * at(0.0, height - 0.002, 0.0), 0.02 * s, 0.26 * s));
    stick
}

fn candle(place: Affine3A, radius: f32, height: f32) -> Assembly {
    let mut candle = Assembly::framed(place);
    candle.add("wax", &cylinder(radius, height, 6));
    let flame = [[0.0, 0.0], [0.8, 0.3], [0.5, 0.7], [0.0, 1.0]].map(|p| [p[0] * 0.022, p[1] * 0.09]);
    candle.add_at("flames", &lathe(&flame, 5).creased(90.0), at(0.0, height + 0.008, 0.0));
    candle
}

/// Iron hoop about the origin of `place` with twelve candles, on four chains that meet in a bar up to `top`.
pub fn candle_crown(place: Affine3A, top: f32) -> Assembly {
    let mut crown = Assembly::framed(place);
    let (inner, outer) = (CROWN_RADIUS - 0.015, CROWN_RADIUS + 0.015);
    crown.add("iron", &ring(inner, outer, -0.09, 0.09, 24).creased(15.0));
    crown.add_each("iron", &torus(CROWN_RADIUS, 0.022, 24, 4), [-0.09, 0.09].map(|y| at(0.0, y, 0.0)));
    let knot = Vec3::new(0.0, 2.1, 0.0);
    for k in 0..4 {
        let turn = turned(90.0 * k as f32 + 15.0, Vec3::ZERO);
        let end = turn.transform_point3(Vec3::new(CROWN_RADIUS, 0.09, 0.0));
        crown.add("iron", &rod(end, knot, 0.014, 5));
    }
    crown.add("iron", &rod(knot - Vec3::Y * 0.05, Vec3::Y * top, 0.02, 6));
    crown.add_at("iron", &ellipsoid([0.09, 0.13, 0.09], 10, 6), Affine3A::from_translation(knot));
    let dish = lathe(&[[0.0, 0.0], [0.03, 0.0], [0.07, 0.04], [0.07, 0.05], [0.0, 0.03]], 5);
    for k in 0..12 {
        let foot = place * turned(30.0 * k as f32, Vec3::ZERO) * at(CROWN_RADIUS, 0.1, 0.0);
        let mut holder = Assembly::framed(foot);
        holder.add("iron", &dish);
        crown.merge(holder);
        crown.merge(candle(foot * at(0.0, 0.028, 0.0), 0.026, 0.2));
    }
    crown
}
