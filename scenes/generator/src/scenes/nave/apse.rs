//! The apse: five sides of a decagon with tall windows, and ribs that meet at the chancel arch's keystone.

use super::arcade::string_course;
use super::piers::shaft_profile;
use super::plan::{APSE_WINDOW, CHANCEL_FLOOR, CROWN, EAST, NAVE, TOP, VAULT_SPRING};
use super::vault::{Rib, rib_along, web, whole_arch};
use super::windows::glazed;
use crate::shapes::*;
use glam::{Affine3A, Quat, Vec2, Vec3};

const SIDES: usize = 5;
const WALL: f32 = 0.75;
/// Apex of the arches over the windows.
const APEX: f32 = 15.6;

/// Corner `k` of 0..=5, from the south round to the north, at `height`.
fn corner(k: usize, height: f32) -> Vec3 {
    let (sin, cos) = (std::f32::consts::PI * k as f32 / SIDES as f32).sin_cos();
    Vec3::new(NAVE * cos, height, EAST - NAVE * sin)
}

/// Walls, shafts, vault and windows of the apse.
pub fn add(scene: &mut Assembly) {
    let key = Vec3::new(0.0, CROWN, EAST);
    for side in 0..SIDES {
        let (south, north) = (corner(side, VAULT_SPRING), corner(side + 1, VAULT_SPRING));
        let middle = (0.5 * (south + north)).with_y(APEX);
        let edges = [Rib { foot: south, crown: middle }, Rib { foot: north, crown: middle }];
        for edge in edges {
            scene.add("vault_webs", &web(edge, Rib { foot: edge.foot, crown: key }, 0.1, 5, 12));
        }
        scene.add("vault_ribs", &whole_arch(edges, Vec2::new(0.22, 0.2), 10, 3));

        let along = (north - south).normalize();
        // Depth is along x y, which must lead out of the apse.
        let frame = upright(south.with_y(0.0), along, Vec3::Y);
        let width = south.distance(north);
        let outline = rectangle(Vec2::new(0.0, -0.1), Vec2::new(width, TOP));
        let wall = extrude_faces(&outline, &[APSE_WINDOW.outline(0.5 * width, 8)], WALL, Faces::NO_RIM);
        scene.add_at("walls", &wall, frame);
        scene.add_at("piers", &string_course(0.0, width, APSE_WINDOW.sill - 0.3), frame);
        scene.merge(glazed(&APSE_WINDOW, 0.5 * width, WALL, frame));
    }
    for k in 1..SIDES {
        let rib = Rib { foot: corner(k, VAULT_SPRING), crown: key };
        scene.add("vault_ribs", &rib_along(&rib.points(14), Vec2::new(0.3, 0.32), 5));
        scene.merge(shaft_in_corner(k));
    }
    let boss = lathe(&[[0.0, -0.75], [0.2, -0.72], [0.28, -0.55], [0.44, -0.5], [0.44, 0.0]], 16);
    scene.add_at("vault_ribs", &boss, Affine3A::from_translation(key));
}

fn shaft_in_corner(k: usize) -> Assembly {
    let outwards = (corner(k, 0.0) - Vec3::new(0.0, 0.0, EAST)).normalize();
    let mut shaft = Assembly::framed(posed(Quat::from_rotation_arc(Vec3::X, outwards), corner(k, 0.0)));
    let profile = shaft_profile(0.17, CHANCEL_FLOOR + 0.3, VAULT_SPRING);
    shaft.add("piers", &lathe_sector(&profile, 65.0, 295.0, 10));
    let (low, high) = ([-0.42, CHANCEL_FLOOR - 0.1, -0.38], [0.3, CHANCEL_FLOOR + 0.3, 0.38]);
    shaft.add("piers", &beveled_box(low, high, 0.04));
    shaft
}
