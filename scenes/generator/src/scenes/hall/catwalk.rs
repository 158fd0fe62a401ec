//! The catwalk along the west side, with its stairs and the bridge at its end.

use super::plan::{CATWALK, END};
use crate::props::industry::{bar, channel_section, grating, i_section, ladder, railing, stairs};
use crate::shapes::*;
use glam::Vec3;

/// Edges across the hall and along it.
const EDGES: [f32; 2] = [-11.0, -9.0];
const SPAN: [f32; 2] = [-8.4, END + 3.0];

pub fn add(scene: &mut Assembly) {
    let [x0, x1] = EDGES;
    let [near, far] = SPAN;
    let (across, along) = (Vec3::X * (x1 - x0), Vec3::Z * (far - near));
    scene.merge(grating("gratings", Vec3::new(x0, CATWALK, near), across, along, 0.045));
    let edge = channel_section(0.2, 0.07, 0.008);
    for (x, from, to) in [(x1, near, far), (x0, far, near)] {
        // Travelling along -z the section's +x is +x; the other way round on the other edge.
        let y = CATWALK - 0.101;
        scene.add("walkway_steel", &bar(&edge, [x, y, from], [x, y, to], Vec3::Y));
    }
    let beam = i_section(0.16, 0.1, 0.01, 0.007);
    let mut z = near - 0.1;
    while z > far {
        let y = CATWALK - 0.13;
        scene.add("walkway_steel", &bar(&beam, [x0 - 0.3, y, z], [x1, y, z], Vec3::Y));
        scene.add("walkway_steel", &rod([x1 - 0.1, y - 0.05, z], [x0 - 0.2, y - 1.2, z], 0.03, 6));
        z -= 2.5;
    }
    let v = |x: f32, z: f32| Vec3::new(x, CATWALK, z);
    scene.merge(railing("railings", &[v(x1 - 0.03, near - 1.1), v(x1 - 0.03, far), v(x0, far)]));
    scene.merge(railing("railings", &[v(x0 + 0.05, far), v(x0 + 0.05, near), v(x1, near)]));
    scene.merge(stairs(v(x1 + 0.04, near - 0.05)));
    scene.merge(ladder("railings", at(-10.2, CATWALK, END + 0.35), 4.6));
}
