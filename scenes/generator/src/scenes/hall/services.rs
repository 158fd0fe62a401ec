//! Services along the walls: a rack of pipes, a ventilation duct with outlets, cable trays and cabinets.

use super::plan::{BAY, BAYS, COLUMN, END, line_z};
use crate::props::industry::{bar, cabinet, flange, hanger, i_section, joint, valve};
use crate::shapes::*;
use glam::Vec3;

pub fn add(scene: &mut Assembly) {
    rack(scene);
    duct(scene);
    cables(scene);
    for (k, z) in [-3.2, -4.25, -5.3, -6.35].into_iter().enumerate() {
        scene.merge(cabinet(at(11.42, -0.01, z), 3 + k % 2));
    }
}

/// Pipes along the east wall on brackets from the columns, with drops to the floor.
fn rack(scene: &mut Assembly) {
    let beam = i_section(0.14, 0.1, 0.01, 0.007);
    for line in 1..BAYS {
        for y in [3.4, 4.6] {
            let z = line_z(line) + 0.24;
            scene.add("brackets", &bar(&beam, [11.7, y, z], [9.9, y, z], Vec3::Y));
            scene.add("brackets", &rod([10.1, y - 0.05, z], [11.3, y - 0.9, z], 0.025, 6));
        }
    }
    // x, height of the bracket, radius.
    let lower = [(10.15, 3.4, 0.1), (10.45, 3.4, 0.08), (10.75, 3.4, 0.12)];
    let upper = [(10.2, 4.6, 0.16), (10.65, 4.6, 0.13), (10.95, 4.6, 0.06)];
    for (k, (x, y, r)) in lower.into_iter().chain(upper).enumerate() {
        let y = y + 0.07 + r;
        let (near, far) = (-2.6 - 0.35 * k as f32, END + 1.4 + 0.3 * k as f32);
        let part = if k % 3 == 1 { "rack_pipes_bright" } else { "rack_pipes" };
        let path = [[x, -0.05, near], [x, y, near], [x, y, far], [x, -0.05, far]];
        scene.add(part, &pipe(&fillet(&path, 3.0 * r, 18.0), r, 12));
        for bay in [2, 5] {
            let middle = Vec3::new(x, y, line_z(bay) - 1.3 - 0.25 * k as f32);
            scene.merge(joint(part, middle, Vec3::Z, r));
        }
        scene.merge(flange(part, Vec3::new(x, 0.02, near), Vec3::Y, r));
        let middle = Vec3::new(x, 1.15 + 0.12 * (k % 2) as f32, near);
        let stem = Vec3::new(-0.4, 0.0, 1.0).normalize();
        scene.merge(valve(part, "rack_handwheels", middle, Vec3::Y, stem, r));
        // A drop in some bays, with a valve at hand height.
        for bay in [2, 4, 6] {
            if (bay + k) % 3 == 0 {
                let (z, out) = (line_z(bay) - 1.0 - 0.5 * k as f32, x - 0.55);
                let drop = [[x, y, z], [out, y, z], [out, -0.05, z]];
                scene.add(part, &pipe(&fillet(&drop, 0.2, 18.0), 0.6 * r, 14));
                let middle = Vec3::new(out, 1.3, z);
                scene.merge(valve(part, "rack_handwheels", middle, Vec3::Y, Vec3::NEG_X, 0.6 * r));
            }
        }
    }
}

/// Round duct under the crane girder of the west side, with seams, elbows and outlets.
fn duct(scene: &mut Assembly) {
    let (x, y, r) = (-9.6, 5.9, 0.42);
    let (near, far) = (-1.5, END + 2.2);
    let path = [[x - 1.7, y, near], [x, y, near], [x, y, far], [x, 9.2, far]];
    scene.add("duct", &pipe(&fillet(&path, 0.9, 12.0), r, 24));
    let seam = lathe(&[[r - 0.01, -0.03], [r + 0.02, -0.012], [r + 0.02, 0.012], [r - 0.01, 0.03]], 24);
    let mut z = near - 1.1;
    while z > far + 1.2 {
        scene.add_at("duct", &seam, standing_on([x, y, z], [x, y, z - 1.0]));
        z -= 1.1;
    }
    let outlet = [[0.16, 0.0], [0.16, 0.3], [0.3, 0.5], [0.31, 0.5], [0.17, 0.29], [0.15, 0.0]];
    for bay in 0..BAYS {
        let z = line_z(bay) - 0.5 * BAY;
        scene.merge(hanger("brackets", Vec3::new(x, y, z), Vec3::Z, r, 9.5));
        let down = Vec3::new(0.8, -0.6, 0.0);
        let foot = Vec3::new(x, y, z + 0.9) + down * (r - 0.06);
        scene.add_at("duct", &lathe(&outlet, 20), standing_on(foot, foot + down));
    }
}

/// Tray along the east columns with a bundle of cables that sag a little between its rungs.
fn cables(scene: &mut Assembly) {
    let (x, y) = (COLUMN - 0.75, 5.9);
    for side in [-0.2, 0.2] {
        let low = [x + side - 0.008, y, END + 0.5];
        scene.add("brackets", &block(low, [x + side + 0.008, y + 0.1, -0.6]));
    }
    for k in 0..130 {
        let z = -0.8 - 0.3 * k as f32;
        scene.add("brackets", &block([x - 0.195, y + 0.01, z - 0.02], [x + 0.195, y + 0.03, z + 0.02]));
    }
    for line in 0..=BAYS {
        let z = line_z(line).clamp(END + 0.6, -0.7);
        scene.add("brackets", &block([x - 0.3, y - 0.07, z - 0.04], [COLUMN, y + 0.005, z + 0.04]));
    }
    let mut rng = Rng::new(5);
    for k in 0..6 {
        let offset = -0.15 + 0.06 * k as f32;
        let radius = rng.range(0.016, 0.027);
        let mut sagging = |j: usize| {
            let aside = x + offset + rng.jitter(0.008);
            [aside, y + 0.03 + radius + rng.range(0.0, 0.01), -0.7 - 0.9 * j as f32]
        };
        let path: Vec<[f32; 3]> = (0..44).map(&mut sagging).collect();
        scene.add("cables", &pipe(&path, radius, 6));
    }
}
