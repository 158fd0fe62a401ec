//! Floodlights on the ledge under the clerestory: deep boxes that light the vault and that nobody below can
//! look into.

use super::plan::{BAY, BAYS, CLERESTORY, NAVE, pier_z};
use crate::shapes::Part;
use crate::shapes::{Faces, at, extrude_faces, mirror_x, parallelogram, rectangle};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Half the length of a lamp along the wall and half its width.
const HALF: Vec2 = Vec2::new(0.3, 0.1);
/// Depth of the box, and of the emitter in it.
const BOX: f32 = 0.26;
const RECESS: f32 = 0.2;
/// Leaning towards the nave, from the vertical.
const LEAN_DEGREES: f32 = 24.0;

/// Appends two lamps a bay on either side.
pub fn build(iron: &mut Part, lamps: &mut Part) {
    let mut housing = Part::default();
    let wall = 0.015;
    let outline = rectangle(-HALF, HALF);
    let mouth = rectangle(-HALF + wall, HALF - wall);
    // Drawn in plan and stood up, open at the top; the emitter is the bottom of the inside.
    let upright = Affine3A::from_quat(Quat::from_rotation_x(-90.0_f32.to_radians()));
    housing.add_at(&extrude_faces(&outline, &[mouth], BOX, Faces::ALL), &upright);
    let inner = HALF - Vec2::splat(wall);
    let panel = parallelogram(
        Vec3::new(-inner.x, BOX - RECESS, inner.y),
        Vec3::X * (2.0 * inner.x),
        Vec3::NEG_Z * (2.0 * inner.y),
        1,
        1,
    );
    let back = parallelogram(
        Vec3::new(-inner.x, BOX - RECESS - 0.02, -inner.y),
        Vec3::X * (2.0 * inner.x),
        Vec3::Z * (2.0 * inner.y),
        1,
        1,
    );
    housing.add(&back);
    let stand = Quat::from_rotation_y(90.0_f32.to_radians());
    let lean = Quat::from_rotation_z(LEAN_DEGREES.to_radians());
    for bay in 0..BAYS {
        for along in [0.27, 0.73] {
            let place = at(NAVE - 0.02, CLERESTORY + 0.14, pier_z(bay) - along * BAY)
                * Affine3A::from_quat(lean * stand);
            for place in [place, mirror_x(0.0) * place] {
                iron.append(&housing, &place);
                lamps.add_at(&panel, &place);
            }
        }
    }
}
