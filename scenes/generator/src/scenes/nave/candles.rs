//! Candles: two hanging crowns, six on the altar, and tall ones at the chancel steps. The flames are the only
//! emitters that the church's interior sees directly.

use super::furniture::ALTAR;
use super::plan::{BAY, CHANCEL, CHANCEL_FLOOR, CROWN, pier_z};
use crate::shapes::Part;
use crate::shapes::{at, cylinder, lathe, profile_lathe, rod, turned};
use glam::{Affine3A, Vec2, Vec3};

/// What candles are made of.
#[derive(Default)]
pub struct Parts {
    /// Iron crowns, chains and candlesticks.
    pub iron: Part,
    /// Wax.
    pub wax: Part,
    /// Flames.
    pub flames: Part,
}

const CROWN_HEIGHT: f32 = 5.6;
const CROWN_RADIUS: f32 = 1.15;

/// Appends all candles.
pub fn build(parts: &mut Parts) {
    for bay in [2, 4] {
        hanging_crown(parts, pier_z(bay) - 0.5 * BAY);
    }
    for x in [-1.05, -0.75, -0.45, 0.45, 0.75, 1.05] {
        let foot = ALTAR + Vec3::new(x, 1.06, -0.2);
        candlestick(parts, &Affine3A::from_translation(foot), 0.42);
    }
    for x in [-3.4, 3.4] {
        candlestick(parts, &at(x, CHANCEL_FLOOR - 0.005, CHANCEL - 1.1), 1.35);
    }
}

/// A candlestick with its candle; `height` is that of the stick.
fn candlestick(parts: &mut Parts, place: &Affine3A, height: f32) {
    let s = (height / 0.42).sqrt();
    let profile: Vec<Vec2> = [
        [0.09 * s, 0.0],
        [0.09 * s, 0.02],
        [0.03 * s, 0.06],
        [0.018 * s, 0.1],
        [0.018 * s, 0.45 * height],
        [0.035 * s, 0.5 * height],
        [0.018 * s, 0.55 * height],
        [0.018 * s, 0.9 * height],
        [0.06 * s, height],
        [0.0, height],
    ]
    .iter()
    .map(|p| Vec2::from_array(*p))
    .collect();
    parts.iron.add_at(&lathe(&profile, 8), place);
    candle(parts, &(*place * at(0.0, height - 0.002, 0.0)), 0.02 * s, 0.26 * s);
}

fn candle(parts: &mut Parts, place: &Affine3A, radius: f32, height: f32) {
    parts.wax.add_at(&cylinder(radius, height, 6), place);
    let flame: Vec<Vec2> = [[0.0, 0.0], [0.8, 0.3], [0.5, 0.7], [0.0, 1.0]]
        .iter()
        .map(|p| Vec2::new(p[0] * 0.022, p[1] * 0.09))
        .collect();
    parts.flames.add_at(&lathe(&flame, 5).creased(90.0), &(*place * at(0.0, height + 0.008, 0.0)));
}

/// An iron hoop with twelve candles on four chains from the vault.
fn hanging_crown(parts: &mut Parts, z: f32) {
    let place = at(0.0, CROWN_HEIGHT, z);
    let band = [[-0.015, -0.09], [0.015, -0.09], [0.015, 0.09], [-0.015, 0.09]]
        .map(|p| Vec2::new(CROWN_RADIUS + p[0], p[1]));
    parts.iron.add_at(&profile_lathe(&band, 24).creased(15.0), &place);
    for y in [-0.09, 0.09] {
        let rim = crate::shapes::torus(CROWN_RADIUS, 0.022, 24, 4);
        parts.iron.add_at(&rim, &(place * at(0.0, y, 0.0)));
    }
    let knot = Vec3::new(0.0, 2.1, 0.0);
    for k in 0..4 {
        let turn = turned(90.0 * k as f32 + 15.0, Vec3::ZERO);
        let end = turn.transform_point3(Vec3::new(CROWN_RADIUS, 0.09, 0.0));
        parts.iron.add_at(&rod(end, knot, 0.014, 5), &place);
    }
    parts.iron.add_at(&rod(knot - Vec3::Y * 0.05, Vec3::Y * (CROWN - CROWN_HEIGHT - 0.5), 0.02, 6), &place);
    parts.iron.add_at(
        &crate::shapes::ellipsoid(Vec3::new(0.09, 0.13, 0.09), 10, 6),
        &(place * Affine3A::from_translation(knot)),
    );
    for k in 0..12 {
        let turn = turned(30.0 * k as f32, Vec3::ZERO);
        let foot = place * turn * at(CROWN_RADIUS, 0.1, 0.0);
        let dish: Vec<Vec2> =
            [[0.0, 0.0], [0.03, 0.0], [0.07, 0.04], [0.07, 0.05], [0.0, 0.03]].map(Vec2::from_array).to_vec();
        parts.iron.add_at(&lathe(&dish, 5), &foot);
        candle(parts, &(foot * at(0.0, 0.028, 0.0)), 0.026, 0.2);
    }
}
