//! Floodlights on the ledge under the clerestory: deep boxes that light the vault and hide their lamps from
//! below.

use super::plan::{BAY, BAYS, CLERESTORY, NAVE, pier_z};
use crate::shapes::*;
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Half the length of a lamp along the wall and half its width.
const HALF: Vec2 = Vec2::new(0.3, 0.1);
/// Depth of the box, and of the emitter in it.
const BOX: f32 = 0.26;
const RECESS: f32 = 0.2;
/// Thickness of the box.
const WALL: f32 = 0.015;
/// Leaning towards the nave, from the vertical.
const LEAN_DEGREES: f32 = 24.0;

/// Two lamps a bay on either side.
pub fn add(scene: &mut Assembly) {
    let inner = HALF - Vec2::splat(WALL);
    let (across, along) = (Vec3::X * (2.0 * inner.x), Vec3::Z * (2.0 * inner.y));
    let panel = sheet([-inner.x, BOX - RECESS, inner.y], across, -along);
    let housing = housing();
    let stand = Quat::from_rotation_y(90.0_f32.to_radians());
    let lean = Affine3A::from_quat(Quat::from_rotation_z(LEAN_DEGREES.to_radians()) * stand);
    for bay in 0..BAYS {
        for along in [0.27, 0.73] {
            let place = at(NAVE - 0.02, CLERESTORY + 0.14, pier_z(bay) - along * BAY) * lean;
            for side in both_sides() {
                scene.place(&housing, side * place);
                scene.add_at("floodlights", &panel, side * place);
            }
        }
    }
}

/// Box drawn in plan and stood up, open at the top.
fn housing() -> Assembly {
    let mut housing = Assembly::new();
    let inner = HALF - Vec2::splat(WALL);
    let upright = Affine3A::from_quat(Quat::from_rotation_x(-90.0_f32.to_radians()));
    housing.add_at("iron", &extrude(&rectangle(-HALF, HALF), &[rectangle(-inner, inner)], BOX), upright);
    let (across, along) = (Vec3::X * (2.0 * inner.x), Vec3::Z * (2.0 * inner.y));
    housing.add("iron", &sheet([-inner.x, BOX - RECESS - 0.02, -inner.y], across, along));
    housing
}
