//! Floor, walls and the sawtooth roof. The teeth's glazing looks towards the camera; the sky behind it is dim,
//! and most light comes from lamps that are aimed at the roof.

use super::plan::{BAY, BAYS, END, HALF, PLINTH_WALL, ROOF, line_z};
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

/// Glazing bars, gutters, door frames.
const FRAMES: &str = "window_frames";
/// Half the width of the door in the far wall, and its height.
const DOOR: Vec2 = Vec2::new(3.0, 5.2);

pub fn add(scene: &mut Assembly) {
    floor(scene);
    for side in both_sides() {
        // x runs towards +z seen from inside, so that the sheet's ribs stand out into the hall.
        scene.merge(side_wall(side * upright([HALF, 0.0, END], Vec3::Z, Vec3::Y)));
    }
    let far = upright([-HALF, 0.0, END], Vec3::X, Vec3::Y);
    scene.merge(end_wall(far, DOOR.x));
    scene.merge(shutter(far));
    // Windows over the door, in a frame that stands out from the cladding.
    for k in 0..5 {
        let x = HALF - 8.5 + 3.4 * k as f32;
        scene.merge(window(far, Vec2::new(x, 6.9), Vec2::new(x + 2.8, 8.6)));
    }
    scene.merge(end_wall(upright([HALF, 0.0, 0.0], Vec3::NEG_X, Vec3::Y), 0.0));
    roof(scene);
}

fn floor(scene: &mut Assembly) {
    let mut rng = Rng::new(11);
    let (columns, rows) = (6, 10);
    let size = Vec2::new(2.0 * HALF / columns as f32, -END / rows as f32);
    for row in 0..rows {
        for column in 0..columns {
            let low = Vec2::new(-HALF + size.x * column as f32, -size.y * (row + 1) as f32);
            let joint = Vec2::splat(0.008);
            let level = at(0.0, rng.range(-0.003, 0.0), 0.0);
            scene.add_at("floor", &slab(low + joint, low + size - joint, 0.03, 0.01), level);
        }
    }
    // Strips under the joints.
    for column in 0..=columns {
        let x = -HALF + size.x * column as f32;
        scene.add("floor_joints", &block([x - 0.03, -0.05, END - 0.1], [x + 0.03, -0.02, 0.1]));
    }
    for row in 0..=rows {
        let z = -size.y * row as f32;
        scene.add("floor_joints", &block([-HALF, -0.06, z - 0.03], [HALF, -0.021, z + 0.03]));
    }
    // Painted gangway lines, as thin as paint can be without fighting for the surface.
    for x in [-0.9, 2.9] {
        for k in 0..10 {
            let z = -1.2 - 3.85 * k as f32;
            scene.add("floor_marks", &block([x - 0.06, -0.005, z - 3.4], [x + 0.06, 0.002, z]));
        }
    }
}

/// Trapezoidal sheet along x from 0 to `width`, up to `height`, its ribs standing out towards +z.
fn profiled_sheet(width: f32, height: f32, pitch: f32, depth: f32) -> Shell {
    let count = (width / pitch).round() as usize;
    let pitch = width / count as f32;
    let mut line = Vec::new();
    for k in 0..count {
        for (x, z) in [(0.0, 0.0), (0.34, 0.0), (0.5, depth), (0.84, depth)] {
            line.push(Vec2::new((k as f32 + x) * pitch, z));
        }
    }
    line.push(Vec2::new(width, 0.0));
    let row = |y: f32| line.iter().map(|p| Vec3::new(p.x, y, p.y)).collect::<Vec<_>>();
    grid(&[row(0.0), row(height)], false, false, 20.0)
}

fn side_wall(frame: Affine3A) -> Assembly {
    let mut wall = Assembly::framed(frame);
    let length = -END;
    let cladding = profiled_sheet(length + 0.2, ROOF[1] + 0.4 - PLINTH_WALL, 0.32, 0.045);
    wall.add_at("cladding", &cladding, at(-0.1, PLINTH_WALL, 0.0));
    for k in 0..BAYS {
        let low = [BAY * k as f32 + 0.01, -0.1, -0.05];
        let high = [BAY * (k + 1) as f32 - 0.01, PLINTH_WALL + 0.01, 0.14];
        wall.add("concrete_wall", &beveled_box(low, high, 0.025));
    }
    let (across, up) = (Vec3::X * (length + 0.4), Vec3::Y * (PLINTH_WALL + 0.4));
    wall.add("concrete_wall", &sheet([-0.2, -0.2, -0.01], across, up));
    wall.add(FRAMES, &block([0.0, PLINTH_WALL, -0.02], [length, PLINTH_WALL + 0.05, 0.19]));
    wall
}

/// End wall in its frame, x along it from one corner, z into the hall; `gap` to either side of its middle it has no
/// concrete.
fn end_wall(frame: Affine3A, gap: f32) -> Assembly {
    let mut wall = Assembly::framed(frame);
    wall.add("cladding", &profiled_sheet(2.0 * HALF, ROOF[1] + 0.4, 0.32, 0.045));
    for (from, to) in [(0.0, HALF - gap), (HALF + gap, 2.0 * HALF)] {
        wall.add("concrete_wall", &beveled_box([from, -0.1, -0.02], [to, PLINTH_WALL, 0.16], 0.02));
    }
    wall
}

/// Roller shutter in the middle of an end wall, with its frame.
fn shutter(frame: Affine3A) -> Assembly {
    let mut shutter = Assembly::framed(frame);
    let (left, right, top) = (HALF - DOOR.x, HALF + DOOR.x, DOOR.y);
    // The ribs of a shutter lie across: the sheet is turned on its side.
    let slats = profiled_sheet(top, 2.0 * DOOR.x, 0.12, 0.03);
    shutter.add_at("shutter", &slats, upright([right, 0.0, 0.1], Vec3::Y, Vec3::NEG_X));
    shutter.add(FRAMES, &beveled_box([left - 0.25, -0.1, 0.0], [left, top + 0.7, 0.28], 0.02));
    shutter.add(FRAMES, &beveled_box([right, -0.1, 0.0], [right + 0.25, top + 0.7, 0.28], 0.02));
    shutter.add(FRAMES, &beveled_box([left, top - 0.1, 0.0], [right, top + 0.7, 0.6], 0.02));
    shutter
}

fn window(frame: Affine3A, low: Vec2, high: Vec2) -> Assembly {
    let mut window = Assembly::framed(frame);
    let inner = rectangle(low + Vec2::splat(0.07), high - Vec2::splat(0.07));
    window.add(FRAMES, &extrude(&rectangle(low, high), &[inner], 0.2));
    let (across, up) = (Vec3::X * (high.x - low.x - 0.1), Vec3::Y * (high.y - low.y - 0.1));
    window.add("sky_panes", &sheet((low + Vec2::splat(0.05)).extend(0.06), across, up));
    for k in 1..4 {
        let x = low.x + (high.x - low.x) * k as f32 / 4.0;
        window.add(FRAMES, &block([x - 0.02, low.y + 0.06, 0.08], [x + 0.02, high.y - 0.06, 0.13]));
    }
    let y = 0.5 * (low.y + high.y);
    window.add(FRAMES, &block([low.x + 0.06, y - 0.02, 0.075], [high.x - 0.06, y + 0.02, 0.125]));
    window
}

fn roof(scene: &mut Assembly) {
    let half = HALF + 0.05;
    for bay in 0..BAYS {
        let (near, far) = (line_z(bay), line_z(bay + 1));
        let foot = Vec3::new(-half, ROOF[0], near);
        let slope = Vec3::new(0.0, ROOF[1] - ROOF[0], far - near);
        let along = slope.normalize();
        // Ribs run down the slope and stand out downwards: x across the hall, y up the slope.
        let frame = upright(foot + Vec3::X * (2.0 * half), Vec3::NEG_X, along);
        let ribbed = profiled_sheet(2.0 * half, slope.length(), 0.36, 0.05);
        scene.add_at("roof_sheets", &ribbed, frame);

        // The glazed end of the tooth: an upstand, then panes between bars. The last one is in the end wall.
        let z = far + if bay + 1 == BAYS { 0.06 } else { 0.0 };
        let upstand = ROOF[0] + 0.35;
        scene.add(FRAMES, &block([-half, ROOF[0] - 0.12, z - 0.04], [half, upstand, z + 0.04]));
        let (across, up) = (Vec3::X * (2.0 * half), Vec3::Y * (ROOF[1] - upstand + 0.1));
        scene.add("sky_panes", &sheet([-half, upstand - 0.02, z], across, up));
        for k in 0..=30 {
            let x = -HALF + 2.0 * HALF * k as f32 / 30.0;
            let low = [x - 0.025, upstand - 0.01, z + 0.012];
            scene.add(FRAMES, &block(low, [x + 0.025, ROOF[1] - 0.02, z + 0.07]));
        }
        for y in [upstand + 0.9, upstand + 1.75] {
            scene.add(FRAMES, &block([-HALF, y - 0.03, z + 0.01], [HALF, y + 0.03, z + 0.06]));
        }
    }
}
