//! The steel frame: columns with base plates and stiffeners, crane girders on brackets, sawtooth trusses with
//! gusset plates, rafters, sheeting rails and bracing.

use super::plan::{BAY, BAYS, COLUMN, EAVES, END, HALF, RAIL, ROOF, TRUSS, line_z};
use super::steel::{angle_section, bar, bolt, channel_section, i_section};
use crate::shapes::Part;
use crate::shapes::{at, beveled_box, block, extrude, frustum, mirror_x, rod};
use glam::{Affine3A, Vec2, Vec3};

/// Panels of a truss.
const PANELS: usize = 10;

/// Appends the whole frame to `steel` and the crane rails to `rails`.
pub fn build(steel: &mut Part, rails: &mut Part) {
    let column = column();
    let truss = truss();
    for line in 0..=BAYS {
        // The end frames stand just inside the end walls.
        let z = line_z(line)
            + if line == 0 {
                -0.35
            } else if line == BAYS {
                0.35
            } else {
                0.0
            };
        for side in [at(0.0, 0.0, 0.0), mirror_x(0.0)] {
            steel.append(&column, &(side * at(COLUMN, 0.0, z)));
        }
        steel.append(&truss, &at(0.0, 0.0, z));
    }
    for side in [at(0.0, 0.0, 0.0), mirror_x(0.0)] {
        crane_girder(steel, rails, &side);
        sheeting_rails(steel, &side);
        for bay in [1, 6] {
            bracing(steel, bay, &side);
        }
    }
    rafters(steel);
}

/// A column about the origin, its web across the hall, with the bracket for the crane towards -x.
fn column() -> Part {
    let mut part = Part::default();
    let section = i_section(0.6, 0.32, 0.03, 0.018);
    // Swept upwards with `up` = x: the section's height lies along x.
    part.add(&bar(&section, Vec3::Y * 0.04, Vec3::Y * EAVES, Vec3::X));
    part.add(&beveled_box(Vec3::new(-0.6, -0.03, -0.42), Vec3::new(0.5, 0.12, 0.42), 0.02));
    part.add(&block(Vec3::new(-0.45, 0.1, -0.3), Vec3::new(0.42, 0.155, 0.3)));
    for (x, z) in [(-0.38, -0.22), (-0.38, 0.22), (0.36, -0.22), (0.36, 0.22)] {
        part.add(&bolt(Vec3::new(x, 0.155, z), Vec3::Y, 0.07));
    }
    for y in [0.5, 3.2, 6.2, 8.8] {
        for z in [-0.085, 0.085] {
            part.add(&block(Vec3::new(-0.275, y, z - 0.07), Vec3::new(0.275, y + 0.015, z + 0.07)));
        }
    }
    // The bracket: a tapering plate with a flange on top.
    let reach = COLUMN - RAIL[0] + 0.22;
    let top = RAIL[1] - 0.87;
    let plate = [[-0.29, top - 0.9], [-0.29, top], [-reach, top], [-reach, top - 0.3]].map(Vec2::from_array);
    part.add_at(&extrude(&plate, &[], 0.03), &at(0.0, 0.0, -0.015));
    part.add(&block(Vec3::new(-reach, top - 0.01, -0.17), Vec3::new(-0.28, top + 0.03, 0.17)));
    let slope = Vec2::new(-reach + 0.29, 0.6).normalize();
    let flange = bar(
        &[Vec2::new(-0.15, -0.012), Vec2::new(0.15, -0.012), Vec2::new(0.15, 0.012), Vec2::new(-0.15, 0.012)],
        Vec3::new(-0.29, top - 0.9, 0.0),
        Vec3::new(-reach, top - 0.3, 0.0),
        Vec3::new(-slope.y, slope.x, 0.0),
    );
    part.add(&flange);
    part.add(&block(Vec3::new(-0.33, EAVES - 0.02, -0.2), Vec3::new(0.3, EAVES + 0.02, 0.2)));
    part
}

/// A parallel truss across the hall about z = 0, of double angles with gussets.
fn truss() -> Part {
    let mut part = Part::default();
    let chord = angle_section(0.14, 0.014);
    let strut = angle_section(0.09, 0.01);
    let (low, high) = (EAVES + 0.12, EAVES + TRUSS);
    let node = |k: usize, y: f32| Vec3::new(-COLUMN + 2.0 * COLUMN * k as f32 / PANELS as f32, y, 0.0);
    let mut pair = |section: &[Vec2], from: Vec3, to: Vec3, up: Vec3| {
        let mirrored: Vec<Vec2> = section.iter().rev().map(|p| Vec2::new(-p.x, p.y)).collect();
        let gap = Vec3::Z * 0.012;
        // Travelling towards +x with y up, the section's +x is +z.
        part.add(&bar(section, from + gap, to + gap, up));
        part.add(&bar(&mirrored, from - gap, to - gap, up));
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
        let lower = [[-w, 0.0], [w, 0.0], [0.7 * w, 0.3], [-0.7 * w, 0.3]].map(Vec2::from_array);
        part.add_at(&extrude(&lower, &[], 0.016), &at(node(k, 0.0).x, low, -0.008));
        let upper = lower.map(|p| Vec2::new(p.x, -p.y));
        part.add_at(&extrude(&upper, &[], 0.016), &at(node(k, 0.0).x, high, -0.008));
        part.add(&bolt(Vec3::new(node(k, 0.0).x, low + 0.2, 0.02), Vec3::Z, 0.045));
    }
    part
}

fn crane_girder(steel: &mut Part, rails: &mut Part, side: &Affine3A) {
    let [x, top] = RAIL;
    let section = i_section(0.75, 0.3, 0.028, 0.016);
    let (near, far) = (Vec3::new(x, top - 0.465, -0.1), Vec3::new(x, top - 0.465, END + 0.1));
    steel.add_at(&bar(&section, near, far, Vec3::Y), side);
    for k in 0..BAYS * 2 {
        let z = -1.2 - BAY * 0.5 * k as f32;
        for across in [-0.078, 0.078] {
            let low = Vec3::new(x + across - 0.068, top - 0.81, z);
            steel.add_at(&block(low, low + Vec3::new(0.136, 0.69, 0.012)), side);
        }
    }
    let rail = [
        [-0.07, -0.1],
        [0.07, -0.1],
        [0.07, -0.085],
        [0.014, -0.07],
        [0.014, -0.035],
        [0.035, -0.025],
        [0.035, -0.004],
        [0.028, 0.0],
        [-0.028, 0.0],
        [-0.035, -0.004],
        [-0.035, -0.025],
        [-0.014, -0.035],
        [-0.014, -0.07],
        [-0.07, -0.085],
    ]
    .map(Vec2::from_array);
    rails.add_at(&bar(&rail, Vec3::new(x, top, -0.1), Vec3::new(x, top, END + 0.1), Vec3::Y), side);
}

/// Channels along the wall that carry the cladding.
fn sheeting_rails(steel: &mut Part, side: &Affine3A) {
    let section = channel_section(0.18, 0.07, 0.008);
    for y in [2.55, 4.3, 6.0, 7.7, 9.2] {
        let x = HALF - 0.2;
        steel.add_at(&bar(&section, Vec3::new(x, y, -0.05), Vec3::new(x, y, END + 0.05), Vec3::Y), side);
    }
}

fn bracing(steel: &mut Part, bay: usize, side: &Affine3A) {
    let x = COLUMN + 0.05;
    let (near, far) = (line_z(bay) - 0.2, line_z(bay + 1) + 0.2);
    for (a, b) in [(0.4, 6.3), (6.3, 0.4)] {
        // The two bars pass each other.
        let x = if a < b { x } else { x + 0.06 };
        steel.add_at(&rod(Vec3::new(x, a, near), Vec3::new(x, b, far), 0.022, 8), side);
    }
    for (y, z) in [(0.4, near), (0.4, far), (6.3, near), (6.3, far)] {
        let low = Vec3::new(x - 0.012, y - 0.15, z - 0.15);
        steel.add_at(&block(low, low + Vec3::new(0.012, 0.3, 0.3)), side);
    }
    steel.add_at(
        &frustum(
            Vec3::new(x - 0.02, 3.25, 0.5 * (near + far) - 0.12),
            Vec3::new(x + 0.09, 3.45, 0.5 * (near + far) + 0.12),
            Vec2::ONE,
        ),
        side,
    );
}

/// Rafters under the slopes and purlins across them.
fn rafters(steel: &mut Part) {
    let rafter = i_section(0.2, 0.1, 0.012, 0.008);
    let purlin = channel_section(0.12, 0.05, 0.006);
    for bay in 0..BAYS {
        let foot = Vec3::new(0.0, ROOF[0] - 0.3, line_z(bay) - 0.1);
        let head = Vec3::new(0.0, ROOF[1] - 0.3, line_z(bay + 1) + 0.12);
        let up = (head - foot).cross(Vec3::X).normalize();
        let up = if up.y < 0.0 { -up } else { up };
        for k in 0..=6 {
            let x = Vec3::X * (-COLUMN + 2.0 * COLUMN * k as f32 / 6.0);
            steel.add(&bar(&rafter, foot + x, head + x, up));
        }
        for k in 0..4 {
            let middle = foot.lerp(head, 0.12 + 0.25 * k as f32) + up * 0.15;
            let end = Vec3::X * (HALF - 0.05);
            steel.add(&bar(&purlin, middle - end, middle + end, up));
        }
    }
}
