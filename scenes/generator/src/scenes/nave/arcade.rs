//! The walls of the nave, one bay at a time: moulded arcade arch, string courses, a triforium that opens on a
//! dark gallery, and the clerestory window.

use super::plan::{
    ARCADE, ARCADE_SPRING, BAY, BAYS, CLERESTORY, CLERESTORY_WINDOW, EAST, NAVE, TOP, TRIFORIUM, WALL,
    pier_z, south_wall,
};
use super::vault::rib_along;
use super::windows::glazed;
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

const MOULDINGS: &str = "mouldings";
/// Openings of the triforium in a bay.
const GALLERY_ARCHES: usize = 4;
const GALLERY_PITCH: f32 = 0.92;
const GALLERY_SILL: f32 = 9.05;
const GALLERY_SPRING: f32 = 10.2;
const GALLERY_ARCH: PointedArch = PointedArch { half_span: 0.36, rise: 0.66 };
/// Depth of the gallery behind the wall.
const GALLERY_DEPTH: f32 = 1.9;

/// Both arcade walls.
pub fn add(scene: &mut Assembly) {
    let mut wall = Assembly::new();
    wall_bay(&mut wall);
    mouldings_of_bay(&mut wall);
    for bay in 0..BAYS {
        for side in both_sides() {
            let frame = side * south_wall(NAVE, bay);
            scene.place(&wall, frame);
            scene.merge(glazed(&CLERESTORY_WINDOW, 0.5 * BAY, WALL, frame));
        }
    }
    for side in both_sides() {
        scene.merge(gallery(side));
    }
}

/// Wall in its local frame: both faces and the reveals of all openings.
fn wall_bay(wall: &mut Assembly) {
    let middle = 0.5 * BAY;
    let arch: Vec<Vec2> = ARCADE.curve(12).iter().map(|p| *p + Vec2::new(middle, ARCADE_SPRING)).collect();
    let mut outline = vec![Vec2::new(0.0, ARCADE_SPRING)];
    outline.extend(&arch);
    outline.extend([Vec2::new(BAY, ARCADE_SPRING), Vec2::new(BAY, TOP), Vec2::new(0.0, TOP)]);
    let mut holes: Vec<Vec<Vec2>> = gallery_middles()
        .map(|x| GALLERY_ARCH.opening(Vec2::new(x, GALLERY_SPRING), GALLERY_SILL - GALLERY_SPRING, 4))
        .collect();
    holes.push(CLERESTORY_WINDOW.outline(middle, 10));
    // The ends of a bay meet the next one, so only the soffit is left of the rim.
    wall.add("walls", &extrude_faces(&outline, &holes, WALL, Faces::NO_RIM));
    let soffit = patch(arch.len() - 1, 1, |u, v| {
        let p = arch[(u * (arch.len() - 1) as f32).round() as usize];
        p.extend(v * WALL)
    });
    wall.add("walls", &soffit.facing(Vec3::new(middle, ARCADE_SPRING, 0.5 * WALL)));
}

fn gallery_middles() -> impl Iterator<Item = f32> {
    (0..GALLERY_ARCHES).map(|k| 0.5 * BAY + GALLERY_PITCH * (k as f32 - 0.5 * (GALLERY_ARCHES - 1) as f32))
}

fn mouldings_of_bay(wall: &mut Assembly) {
    let centre = Vec3::new(0.5 * BAY, ARCADE_SPRING, 0.0);
    let on_wall = |arch: PointedArch, segments: usize, depth: f32| -> Vec<Vec3> {
        arch.curve(segments).iter().map(|p| p.extend(depth) + centre).collect()
    };
    // The inner order hangs below the soffit; its section is that of a heavy rib.
    wall.add(MOULDINGS, &rib_along(&on_wall(ARCADE, 8, 0.5 * WALL), Vec2::new(0.56, 0.34), 3));
    // A roll on the edge of the outer order and a hood over it, towards the nave.
    wall.add(MOULDINGS, &roll(&on_wall(ARCADE, 8, 0.0), 0.085));
    wall.add(MOULDINGS, &roll(&on_wall(ARCADE.offset(0.24), 8, 0.0), 0.06));
    for height in [TRIFORIUM, CLERESTORY] {
        wall.add(MOULDINGS, &string_course(0.0, BAY, height));
    }
    triforium_colonnettes(wall);
}

fn roll(path: &[Vec3], radius: f32) -> Shell {
    let profile = circle(radius, 4);
    let section = Section { points: &profile, closed: true, crease_degrees: 95.0 };
    sweep_along(section, path, Vec3::NEG_X, false, Faces::NO_ENDS)
}

/// Projecting course with a drip, from `from` to `to` along a wall's inner face.
pub fn string_course(from: f32, to: f32, height: f32) -> Shell {
    // Travelling along +x with y up, the right is +z, which is into the wall.
    let profile = [
        [-0.05, -0.12],
        [-0.08, -0.05],
        [-0.14, -0.01],
        [-0.14, 0.03],
        [-0.07, 0.1],
        [0.05, 0.1],
        [0.05, -0.12],
    ];
    sweep(&profile, &[Vec3::new(from, height, 0.0), Vec3::new(to, height, 0.0)], Vec3::Y).creased(20.0)
}

fn triforium_colonnettes(wall: &mut Assembly) {
    let base = [[0.11, 0.0], [0.11, 0.05], [0.055, 0.14]];
    let capital = [[0.055, 0.93], [0.08, 0.96], [0.115, 1.1], [0.115, 1.16]];
    let colonnette = lathe(&[&base[..], &capital].concat(), 5);
    let first = gallery_middles().next().unwrap_or(0.0) - 0.5 * GALLERY_PITCH;
    for k in 0..=GALLERY_ARCHES {
        let x = first + GALLERY_PITCH * k as f32;
        wall.add_at(MOULDINGS, &colonnette, at(x, GALLERY_SILL - 0.01, 0.02));
    }
    for x in gallery_middles() {
        let arch = GALLERY_ARCH.offset(0.05).curve(3);
        let path: Vec<Vec3> = arch.iter().map(|p| Vec3::new(p.x + x, p.y + GALLERY_SPRING, 0.0)).collect();
        wall.add(MOULDINGS, &roll(&path, 0.045));
    }
    // The ledge they stand on.
    let last = first + GALLERY_PITCH * GALLERY_ARCHES as f32;
    let ledge = block([first - 0.2, GALLERY_SILL - 0.12, -0.12], [last + 0.2, GALLERY_SILL, 0.05]);
    wall.add(MOULDINGS, &ledge);
}

/// Passage behind the triforium in the frame of a side: floor, back, ceiling and ends, seen from inside.
fn gallery(side: Affine3A) -> Assembly {
    let mut gallery = Assembly::framed(side);
    let (near, far) = (NAVE + WALL - 0.01, NAVE + WALL + GALLERY_DEPTH);
    let (low, high) = (GALLERY_SILL - 0.05, CLERESTORY - 0.1);
    let (across, up, length) = (Vec3::X * (far - near), Vec3::Y * (high - low), Vec3::Z * EAST);
    let inside = Vec3::new(0.5 * (near + far), 0.5 * (low + high), 0.5 * pier_z(BAYS));
    for face in [
        sheet([near, low, 0.0], length, across),
        sheet([near, high, 0.0], length, across),
        sheet([far, low, 0.0], length, up),
        sheet([near, low, 0.0], across, up),
        sheet([near, low, EAST], across, up),
    ] {
        gallery.add("walls", &face.facing(inside));
    }
    gallery
}
