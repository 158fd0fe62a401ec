//! The apse: five sides of a decagon with tall windows, and ribs that meet at the chancel arch's keystone.

use super::arcade::string_course;
use super::piers::shaft_profile;
use super::plan::{APSE_WINDOW, CHANCEL_FLOOR, CROWN, EAST, NAVE, TOP, VAULT_SPRING};
use super::vault::{Rib, rib_along, web, whole_arch};
use super::windows;
use crate::shapes::Part;
use crate::shapes::{Faces, at, beveled_box, extrude_faces, lathe_sector, rectangle, upright};
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

/// Appends walls, shafts, vault and windows of the apse.
pub fn build(
    walls: &mut Part,
    piers: &mut Part,
    ribs: &mut Part,
    webs: &mut Part,
    windows: &mut windows::Parts,
) {
    let key = Vec3::new(0.0, CROWN, EAST);
    for side in 0..SIDES {
        let (south, north) = (corner(side, VAULT_SPRING), corner(side + 1, VAULT_SPRING));
        let middle = (0.5 * (south + north)).with_y(APEX);
        let edges = [Rib { foot: south, crown: middle }, Rib { foot: north, crown: middle }];
        for edge in edges {
            webs.add(&web(edge, Rib { foot: edge.foot, crown: key }, 0.1, 5, 12));
        }
        ribs.add(&whole_arch(edges, Vec2::new(0.22, 0.2), 10, 3));

        let along = (north - south).normalize();
        // Depth is along x y, which must lead out of the apse.
        let frame = upright(south.with_y(0.0), along, Vec3::Y);
        let width = south.distance(north);
        let outline = rectangle(Vec2::new(0.0, -0.1), Vec2::new(width, TOP));
        let holes = [APSE_WINDOW.outline(0.5 * width, 8)];
        let wall = extrude_faces(&outline, &holes, WALL, Faces { rim: false, ..Faces::ALL });
        walls.add_at(&wall, &frame);
        piers.add_at(&string_course(0.0, width, APSE_WINDOW.sill - 0.3), &frame);
        windows::build(windows, &APSE_WINDOW, 0.5 * width, WALL, &frame);
    }
    for k in 1..SIDES {
        let foot = corner(k, VAULT_SPRING);
        let rib = Rib { foot, crown: key };
        ribs.add(&rib_along(&rib.points(14), Vec2::new(0.3, 0.32), 5));
        shaft_in_corner(piers, k);
    }
    let boss: Vec<Vec2> =
        [[0.0, -0.75], [0.2, -0.72], [0.28, -0.55], [0.44, -0.5], [0.44, 0.0]].map(Vec2::from_array).to_vec();
    ribs.add_at(&crate::shapes::lathe(&boss, 16), &Affine3A::from_translation(key));
}

fn shaft_in_corner(piers: &mut Part, k: usize) {
    let outwards = (corner(k, 0.0) - Vec3::new(0.0, 0.0, EAST)).normalize();
    let turn = Quat::from_rotation_arc(Vec3::X, outwards);
    let place = Affine3A::from_rotation_translation(turn, corner(k, 0.0));
    let profile = shaft_profile(0.17, CHANCEL_FLOOR + 0.3, VAULT_SPRING);
    piers.add_at(&lathe_sector(&profile, 65.0, 295.0, 10), &place);
    let foot = beveled_box(
        Vec3::new(-0.42, CHANCEL_FLOOR - 0.1, -0.38),
        Vec3::new(0.3, CHANCEL_FLOOR + 0.3, 0.38),
        0.04,
    );
    piers.add_at(&foot, &(place * at(0.0, 0.0, 0.0)));
}
