//! The steel frame: columns with base plates and stiffeners, crane girders on brackets, sawtooth trusses with
//! gusset plates, rafters, sheeting rails and bracing.

use super::plan::{BAY, BAYS, COLUMN, EAVES, END, HALF, RAIL, ROOF, TRUSS, line_z};
use crate::props::industry::{angle_section, bar, bolt, channel_section, i_section};
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Panels of a truss.
const PANELS: usize = 10;

const FRAME: &str = "frame";
/// Section of the crane rails.
#[rustfmt::skip]
const RAIL_SECTION: [[f32; 2]; 14] = [[-0.07, -0.1], [0.07, -0.1], [0.07, -0.085], [0.014, -0.07], [0.014, -0.035],
    [0.035, -0.025], [0.035, -0.004], [0.028, 0.0], [-0.028, 0.0], [-0.035, -0.004], [-0.035, -0.025],
    [-0.014, -0.035], [-0.014, -0.07], [-0.07, -0.085]];

pub fn add(scene: &mut Assembly) {
    let (column, truss) = (column(), truss());
    for line in 0..=BAYS {
        // The end frames stand just inside the end walls.
        let inwards = match line {
            0 => -0.35,
            BAYS => 0.35,
            _ => 0.0,
        };
        let z = line_z(line) + inwards;
        for side in both_sides() {
            scene.place(&column, side * at(COLUMN, 0.0, z));
        }
        scene.place(&truss, at(0.0, 0.0, z));
    }
    for side in both_sides() {
        let mut wall = Assembly::framed(side);
        crane_girder(&mut wall);
        sheeting_rails(&mut wall);
        for bay in [1, 6] {
            bracing(&mut wall, bay);
        }
        scene.merge(wall);
    }
    rafters(scene);
}

/// Column about the origin, its web across the hall, with the bracket for the crane towards -x.
fn column() -> Assembly {
    let mut column = Assembly::new();
    let section = i_section(0.6, 0.32, 0.03, 0.018);
    // Swept upwards with `up` = x: the section's height lies along x.
    column.add(FRAME, &bar(&section, Vec3::Y * 0.04, Vec3::Y * EAVES, Vec3::X));
    column.add(FRAME, &beveled_box([-0.6, -0.03, -0.42], [0.5, 0.12, 0.42], 0.02));
    column.add(FRAME, &block([-0.45, 0.1, -0.3], [0.42, 0.155, 0.3]));
    for (x, z) in [(-0.38, -0.22), (-0.38, 0.22), (0.36, -0.22), (0.36, 0.22)] {
        column.add(FRAME, &bolt([x, 0.155, z], Vec3::Y, 0.07));
    }
    for y in [0.5, 3.2, 6.2, 8.8] {
        for z in [-0.085, 0.085] {
            column.add(FRAME, &block([-0.275, y, z - 0.07], [0.275, y + 0.015, z + 0.07]));
        }
    }
    // The bracket: a tapering plate with a flange on top.
    let reach = COLUMN - RAIL[0] + 0.22;
    let top = RAIL[1] - 0.87;
    let plate = [[-0.29, top - 0.9], [-0.29, top], [-reach, top], [-reach, top - 0.3]];
    column.add_at(FRAME, &extrude(&plate, &[], 0.03), at(0.0, 0.0, -0.015));
    column.add(FRAME, &block([-reach, top - 0.01, -0.17], [-0.28, top + 0.03, 0.17]));
    let slope = Vec2::new(-reach + 0.29, 0.6).normalize();
    let section = rectangle(Vec2::new(-0.15, -0.012), Vec2::new(0.15, 0.012));
    let (low, high) = ([-0.29, top - 0.9, 0.0], [-reach, top - 0.3, 0.0]);
    column.add(FRAME, &bar(&section, low, high, Vec3::new(-slope.y, slope.x, 0.0)));
    column.add(FRAME, &block([-0.33, EAVES - 0.02, -0.2], [0.3, EAVES + 0.02, 0.2]));
    column
}

/// Parallel truss across the hall about z = 0, of double angles with gussets.
fn truss() -> Assembly {
    let mut truss = Assembly::new();
    let chord = angle_section(0.14, 0.014);
    let strut = angle_section(0.09, 0.01);
    let (low, high) = (EAVES + 0.12, EAVES + TRUSS);
    let node = |k: usize, y: f32| Vec3::new(-COLUMN + 2.0 * COLUMN * k as f32 / PANELS as f32, y, 0.0);
    let mut pair = |section: &[Vec2], from: Vec3, to: Vec3, up: Vec3| {
        let mirrored: Vec<Vec2> = section.iter().rev().map(|p| Vec2::new(-p.x, p.y)).collect();
        let gap = Vec3::Z * 0.012;
        // Travelling towards +x with y up, the section's +x is +z.
        truss.add(FRAME, &bar(section, from + gap, to + gap, up));
        truss.add(FRAME, &bar(&mirrored, from - gap, to - gap, up));
    };
    pair(&chord, node(0, low), node(PANELS, low), Vec3::Y);
    let flipped: Vec<Vec2> = chord.iter().rev().map(|p| Vec2::new(p.x, -p.y)).collect();
    pair(&flipped, node(0, high), node(PANELS, high), Vec3::Y);
    for k in 0..=PANELS {
        pair(&strut, node(k, low + 0.02), node(k, high - 0.02), Vec3::NEG_X);
    }
    for k in 0..PANELS {
        // Diagonals fall towards the middle.
        let (a, b) = if k < PANELS / 2 {
            (node(k, high), node(k + 1, low))
        } else {
            (node(k, low), node(k + 1, high))
        };
        let up = Vec3::Z.cross(b - a).normalize();
        let inset = 0.1 * (b - a).normalize();
        pair(&strut, a + inset, b - inset, up);
    }
    for k in 0..=PANELS {
        let w = 0.26;
        let x = node(k, 0.0).x;
        let lower = points(&[[-w, 0.0], [w, 0.0], [0.7 * w, 0.3], [-0.7 * w, 0.3]]);
        truss.add_at(FRAME, &extrude(&lower, &[], 0.016), at(x, low, -0.008));
        let upper = scaled(&lower, Vec2::new(1.0, -1.0));
        truss.add_at(FRAME, &extrude(&upper, &[], 0.016), at(x, high, -0.008));
        truss.add(FRAME, &bolt([x, low + 0.2, 0.02], Vec3::Z, 0.045));
    }
    truss
}

fn crane_girder(wall: &mut Assembly) {
    let [x, top] = RAIL;
    let section = i_section(0.75, 0.3, 0.028, 0.016);
    let y = top - 0.465;
    wall.add(FRAME, &bar(&section, [x, y, -0.1], [x, y, END + 0.1], Vec3::Y));
    for k in 0..BAYS * 2 {
        let z = -1.2 - BAY * 0.5 * k as f32;
        for across in [-0.078, 0.078] {
            let low = Vec3::new(x + across - 0.068, top - 0.81, z);
            wall.add(FRAME, &block(low, low + Vec3::new(0.136, 0.69, 0.012)));
        }
    }
    let rail = bar(&points(&RAIL_SECTION), [x, top, -0.1], [x, top, END + 0.1], Vec3::Y);
    wall.add("crane_rails", &rail);
}

/// Channels along the wall that carry the cladding.
fn sheeting_rails(wall: &mut Assembly) {
    let section = channel_section(0.18, 0.07, 0.008);
    let x = HALF - 0.2;
    for y in [2.55, 4.3, 6.0, 7.7, 9.2] {
        wall.add(FRAME, &bar(&section, [x, y, -0.05], [x, y, END + 0.05], Vec3::Y));
    }
}

fn bracing(wall: &mut Assembly, bay: usize) {
    let x = COLUMN + 0.05;
    let (near, far) = (line_z(bay) - 0.2, line_z(bay + 1) + 0.2);
    // The two bars pass each other.
    for (x, a, b) in [(x, 0.4, 6.3), (x + 0.06, 6.3, 0.4)] {
        wall.add(FRAME, &rod([x, a, near], [x, b, far], 0.022, 8));
    }
    for (y, z) in [(0.4, near), (0.4, far), (6.3, near), (6.3, far)] {
        let low = Vec3::new(x - 0.012, y - 0.15, z - 0.15);
        wall.add(FRAME, &block(low, low + Vec3::new(0.012, 0.3, 0.3)));
    }
    let middle = 0.5 * (near + far);
    wall.add(FRAME, &block([x - 0.02, 3.25, middle - 0.12], [x + 0.09, 3.45, middle + 0.12]));
}

/// Rafters under the slopes and purlins across them.
fn rafters(scene: &mut Assembly) {
    let rafter = i_section(0.2, 0.1, 0.012, 0.008);
    let purlin = channel_section(0.12, 0.05, 0.006);
    for bay in 0..BAYS {
        let foot = Vec3::new(0.0, ROOF[0] - 0.3, line_z(bay) - 0.1);
        let head = Vec3::new(0.0, ROOF[1] - 0.3, line_z(bay + 1) + 0.12);
        let up = (head - foot).cross(Vec3::X).normalize();
        let up = if up.y < 0.0 { -up } else { up };
        for k in 0..=6 {
            let x = Vec3::X * (-COLUMN + 2.0 * COLUMN * k as f32 / 6.0);
            scene.add(FRAME, &bar(&rafter, foot + x, head + x, up));
        }
        for k in 0..4 {
            let middle = foot.lerp(head, 0.12 + 0.25 * k as f32) + up * 0.15;
            let end = Vec3::X * (HALF - 0.05);
            scene.add(FRAME, &bar(&purlin, middle - end, middle + end, up));
        }
    }
}
