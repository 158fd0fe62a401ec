//! Floor, walls and the sawtooth roof. The teeth's glazing looks towards the camera; the sky behind it is dim,
//! and most light comes from lamps that are aimed at the roof.

use super::plan::{BAY, BAYS, END, HALF, PLINTH_WALL, ROOF, line_z};
use crate::shapes::Part;
use crate::shapes::{
    Rng, Shell, at, beveled_box, block, grid, mirror_x, parallelogram, rectangle, slab, upright,
};
use glam::{Affine3A, Vec2, Vec3};

/// What the envelope is made of.
#[derive(Default)]
pub struct Parts {
    /// Concrete floor.
    pub floor: Part,
    /// Joints between its slabs.
    pub joints: Part,
    /// Lines painted on it.
    pub floor_marks: Part,
    /// Concrete wall under the cladding.
    pub concrete: Part,
    /// Profiled sheets of the walls.
    pub cladding: Part,
    /// Profiled sheets of the roof.
    pub roof: Part,
    /// Glazing bars, gutters, door frames.
    pub frames: Part,
    /// Sky behind the glazing.
    pub sky: Part,
    /// Roller shutter.
    pub shutter: Part,
}

/// Appends the envelope.
pub fn build(parts: &mut Parts) {
    floor(parts);
    for side in [at(0.0, 0.0, 0.0), mirror_x(0.0)] {
        side_wall(parts, &side);
    }
    end_wall(parts, &upright(Vec3::new(-HALF, 0.0, END), Vec3::X, Vec3::Y), true);
    end_wall(parts, &upright(Vec3::new(HALF, 0.0, 0.0), Vec3::NEG_X, Vec3::Y), false);
    roof(parts);
}

fn floor(parts: &mut Parts) {
    let mut rng = Rng::new(11);
    let (columns, rows) = (6, 10);
    let size = Vec2::new(2.0 * HALF / columns as f32, -END / rows as f32);
    for row in 0..rows {
        for column in 0..columns {
            let low = Vec2::new(-HALF + size.x * column as f32, -size.y * (row + 1) as f32);
            let joint = Vec2::splat(0.008);
            let level = at(0.0, rng.range(-0.003, 0.0), 0.0);
            parts.floor.add_at(&slab(low + joint, low + size - joint, 0.03, 0.01), &level);
        }
    }
    // Strips under the joints.
    for column in 0..=columns {
        let x = -HALF + size.x * column as f32;
        parts.joints.add(&block(Vec3::new(x - 0.03, -0.05, END - 0.1), Vec3::new(x + 0.03, -0.02, 0.1)));
    }
    for row in 0..=rows {
        let z = -size.y * row as f32;
        parts.joints.add(&block(Vec3::new(-HALF, -0.06, z - 0.03), Vec3::new(HALF, -0.021, z + 0.03)));
    }
    // Painted gangway lines, as thin as paint can be without fighting for the surface.
    for x in [-0.9, 2.9] {
        for k in 0..10 {
            let z = -1.2 - 3.85 * k as f32;
            parts
                .floor_marks
                .add(&block(Vec3::new(x - 0.06, -0.005, z - 3.4), Vec3::new(x + 0.06, 0.002, z)));
        }
    }
}

/// A trapezoidal sheet along x from 0 to `width`, up to `height`, its ribs standing out towards +z.
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

fn side_wall(parts: &mut Parts, side: &Affine3A) {
    let length = -END;
    // x runs towards +z seen from inside, so that the sheet's ribs stand out into the hall.
    let frame = *side * upright(Vec3::new(HALF, 0.0, END), Vec3::Z, Vec3::Y);
    let sheet = profiled_sheet(length + 0.2, ROOF[1] + 0.4 - PLINTH_WALL, 0.32, 0.045);
    parts.cladding.add_at(&sheet, &(frame * at(-0.1, PLINTH_WALL, 0.0)));
    for k in 0..BAYS {
        let low = Vec3::new(BAY * k as f32 + 0.01, -0.1, -0.05);
        let high = Vec3::new(BAY * (k + 1) as f32 - 0.01, PLINTH_WALL + 0.01, 0.14);
        parts.concrete.add_at(&beveled_box(low, high, 0.025), &frame);
    }
    let corner = Vec3::new(-0.2, -0.2, -0.01);
    let backing = parallelogram(corner, Vec3::X * (length + 0.4), Vec3::Y * (PLINTH_WALL + 0.4), 1, 1);
    parts.concrete.add_at(&backing, &frame);
    let sill = block(Vec3::new(0.0, PLINTH_WALL, -0.02), Vec3::new(length, PLINTH_WALL + 0.05, 0.19));
    parts.frames.add_at(&sill, &frame);
}

/// An end wall in its frame: x along it from one corner, z into the hall.
fn end_wall(parts: &mut Parts, frame: &Affine3A, shutter: bool) {
    let width = 2.0 * HALF;
    let height = ROOF[1] + 0.4;
    let sheet = profiled_sheet(width, height, 0.32, 0.045);
    parts.cladding.add_at(&sheet, frame);
    let middle = 0.5 * width;
    let door = [3.0, 5.2];
    let gap = if shutter { door[0] } else { 0.0 };
    for (from, to) in [(0.0, middle - gap), (middle + gap, width)] {
        let panel = beveled_box(Vec3::new(from, -0.1, -0.02), Vec3::new(to, PLINTH_WALL, 0.16), 0.02);
        parts.concrete.add_at(&panel, frame);
    }
    if shutter {
        let slats = profiled_sheet(door[1], 2.0 * door[0], 0.12, 0.03);
        // The ribs of a shutter lie across: the sheet is turned on its side.
        let turn = upright(Vec3::new(middle + door[0], 0.0, 0.1), Vec3::Y, Vec3::NEG_X);
        parts.shutter.add_at(&slats, &(*frame * turn));
        for (low, high) in [
            (Vec3::new(middle - door[0] - 0.25, -0.1, 0.0), Vec3::new(middle - door[0], door[1] + 0.7, 0.28)),
            (Vec3::new(middle + door[0], -0.1, 0.0), Vec3::new(middle + door[0] + 0.25, door[1] + 0.7, 0.28)),
            (
                Vec3::new(middle - door[0], door[1] - 0.1, 0.0),
                Vec3::new(middle + door[0], door[1] + 0.7, 0.6),
            ),
        ] {
            parts.frames.add_at(&beveled_box(low, high, 0.02), frame);
        }
        // Windows over the door, in a frame that stands out from the cladding.
        for k in 0..5 {
            let x = middle - 8.5 + 3.4 * k as f32;
            window(parts, frame, Vec2::new(x, 6.9), Vec2::new(x + 2.8, 8.6));
        }
    }
}

fn window(parts: &mut Parts, frame: &Affine3A, low: Vec2, high: Vec2) {
    let outline = rectangle(low, high);
    let inner = rectangle(low + Vec2::splat(0.07), high - Vec2::splat(0.07));
    let surround = crate::shapes::extrude(&outline, &[inner], 0.2);
    parts.frames.add_at(&surround, frame);
    let pane = parallelogram(
        (low + Vec2::splat(0.05)).extend(0.06),
        Vec3::X * (high.x - low.x - 0.1),
        Vec3::Y * (high.y - low.y - 0.1),
        1,
        1,
    );
    parts.sky.add_at(&pane, frame);
    for k in 1..4 {
        let x = low.x + (high.x - low.x) * k as f32 / 4.0;
        let bar = block(Vec3::new(x - 0.02, low.y + 0.06, 0.08), Vec3::new(x + 0.02, high.y - 0.06, 0.13));
        parts.frames.add_at(&bar, frame);
    }
    let y = 0.5 * (low.y + high.y);
    parts.frames.add_at(
        &block(Vec3::new(low.x + 0.06, y - 0.02, 0.075), Vec3::new(high.x - 0.06, y + 0.02, 0.125)),
        frame,
    );
}

fn roof(parts: &mut Parts) {
    let half = HALF + 0.05;
    for bay in 0..BAYS {
        let (near, far) = (line_z(bay), line_z(bay + 1));
        let foot = Vec3::new(-half, ROOF[0], near);
        let slope = Vec3::new(0.0, ROOF[1] - ROOF[0], far - near);
        let along = slope.normalize();
        // Ribs run down the slope and stand out downwards: x across the hall, y up the slope.
        let frame = upright(foot + Vec3::X * (2.0 * half), Vec3::NEG_X, along);
        let sheet = profiled_sheet(2.0 * half, slope.length(), 0.36, 0.05);
        parts.roof.add_at(&sheet, &frame);

        // The glazed end of the tooth: an upstand, then panes between bars. The last one is in the end wall.
        let z = far + if bay + 1 == BAYS { 0.06 } else { 0.0 };
        let upstand = ROOF[0] + 0.35;
        parts
            .frames
            .add(&block(Vec3::new(-half, ROOF[0] - 0.12, z - 0.04), Vec3::new(half, upstand, z + 0.04)));
        let pane = parallelogram(
            Vec3::new(-half, upstand - 0.02, z),
            Vec3::X * (2.0 * half),
            Vec3::Y * (ROOF[1] - upstand + 0.1),
            1,
            1,
        );
        parts.sky.add(&pane);
        for k in 0..=30 {
            let x = -HALF + 2.0 * HALF * k as f32 / 30.0;
            parts.frames.add(&block(
                Vec3::new(x - 0.025, upstand - 0.01, z + 0.012),
                Vec3::new(x + 0.025, ROOF[1] - 0.02, z + 0.07),
            ));
        }
        for y in [upstand + 0.9, upstand + 1.75] {
            parts
                .frames
                .add(&block(Vec3::new(-HALF, y - 0.03, z + 0.01), Vec3::new(HALF, y + 0.03, z + 0.06)));
        }
    }
}
