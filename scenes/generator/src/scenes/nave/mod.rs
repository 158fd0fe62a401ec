//! `nave`: a church of five rib-vaulted bays with aisles, triforium, clerestory and a five-sided apse. All
//! surfaces are diffuse. Most of the light comes from floodlights on the ledge under the clerestory that look
//! up at the vault, so that nearly everything below is lit indirectly; the windows add a little sky.
//!
//! Units: metres; 25 m long to the chancel arch, 9 m wide between the arcades, 18 m high.

mod aisles;
mod apse;
mod arcade;
mod floodlights;
mod floor;
mod piers;
mod plan;
mod vault;
mod west;
mod windows;

use crate::props::church::{altar, candle_crown, candlestick, font, pew, pulpit};
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};
use plan::{BAY, BAYS, CHANCEL, CHANCEL_FLOOR, CROWN, EAST, NAVE, VAULT_SPRING, pier_z};

/// Rows of pews on each side.
const ROWS: usize = 9;
const PITCH: f32 = 1.15;
/// z of the westernmost row.
const FIRST_ROW: f32 = -8.4;
/// Position of the altar.
const ALTAR: Vec3 = Vec3::new(0.0, CHANCEL_FLOOR + 0.16, EAST - 1.7);
/// Height of the hanging candle crowns.
const CROWN_HEIGHT: f32 = 5.6;

/// Parts of the scene.
pub fn parts() -> Vec<Part> {
    let mut scene = Assembly::new();
    high_vault(&mut scene);
    piers::add(&mut scene);
    arcade::add(&mut scene);
    aisles::add(&mut scene);
    apse::add(&mut scene);
    west::add(&mut scene);
    floor::add(&mut scene);
    furnish(&mut scene);
    floodlights::add(&mut scene);
    scene.into_parts()
}

fn high_vault(scene: &mut Assembly) {
    let detail = vault::Detail {
        web: [3, 8],
        diagonal: Vec2::new(0.34, 0.36),
        transverse: Vec2::new(0.5, 0.45),
        wall: Vec2::new(0.24, 0.2),
        both_walls: true,
        roll: 2,
    };
    for k in 0..BAYS {
        let bay = vault::Bay {
            low: Vec2::new(-NAVE, pier_z(k) - BAY),
            high: Vec2::new(NAVE, pier_z(k)),
            spring: VAULT_SPRING,
            crown: CROWN,
            apex: [CROWN, CROWN - 0.7],
        };
        scene.merge(bay.vaulted(&detail));
        if k + 1 == BAYS {
            let halves = [bay.transverse(true, false), bay.transverse(true, true)];
            scene.add("vault_ribs", &vault::whole_arch(halves, Vec2::new(0.8, 0.6), 14, 6));
        }
    }
}

/// Pews, altar, pulpit, font and candles. The flames are the only emitters that one sees directly from below.
fn furnish(scene: &mut Assembly) {
    let pew = pew(1.0, 3.75);
    for row in 0..ROWS {
        for side in both_sides() {
            scene.place(&pew, side * at(0.0, 0.0, FIRST_ROW - PITCH * row as f32));
        }
    }
    scene.merge(altar(ALTAR));
    scene.merge(pulpit(turned(22.5, [-3.1, -0.01, pier_z(4) - 1.9])));
    scene.add_at("furniture_stone", &font(), turned(22.5, [-2.55, -0.01, pier_z(1) + 0.9]));
    for bay in [2, 4] {
        let place = at(0.0, CROWN_HEIGHT, pier_z(bay) - 0.5 * BAY);
        scene.merge(candle_crown(place, CROWN - CROWN_HEIGHT - 0.5));
    }
    for x in [-1.05, -0.75, -0.45, 0.45, 0.75, 1.05] {
        let foot = ALTAR + Vec3::new(x, 1.06, -0.2);
        scene.merge(candlestick(Affine3A::from_translation(foot), 0.42));
    }
    for x in [-3.4, 3.4] {
        scene.merge(candlestick(at(x, CHANCEL_FLOOR - 0.005, CHANCEL - 1.1), 1.35));
    }
}
