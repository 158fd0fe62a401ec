//! Pews, an altar with its cross, a pulpit and a font: parts "wood", "furniture_stone", "cloth".

use crate::shapes::*;
use glam::{Affine3A, Vec3};

const STONE: &str = "furniture_stone";

#[rustfmt::skip]
mod section {
    /// Side of a pew in (z, y).
    pub const PEW_END: [[f32; 2]; 17] = [[-0.26, -0.02], [0.5, -0.02], [0.5, 0.16], [0.42, 0.3], [0.38, 0.6],
        [0.34, 0.86], [0.33, 1.0], [0.28, 1.06], [0.21, 1.07], [0.16, 1.02], [0.15, 0.92], [0.12, 0.72],
        [0.05, 0.6], [-0.08, 0.56], [-0.22, 0.58], [-0.27, 0.52], [-0.26, 0.4]];
    pub const ALTAR_LEG: [[f32; 2]; 6] = [[0.1, 0.1], [0.1, 0.16], [0.06, 0.22], [0.06, 0.8], [0.1, 0.88], [0.1, 0.95]];
    pub const PULPIT: [[f32; 2]; 9] = [[0.5, 0.0], [0.5, 0.15], [0.3, 0.22], [0.2, 0.4], [0.2, 0.95], [0.26, 1.1],
        [0.5, 1.3], [0.76, 1.42], [0.0, 1.42]];
    pub const FONT: [[f32; 2]; 16] = [[0.75, 0.0], [0.75, 0.16], [0.5, 0.17], [0.5, 0.3], [0.34, 0.4], [0.26, 0.5],
        [0.26, 0.68], [0.36, 0.78], [0.58, 0.86], [0.6, 0.9], [0.6, 1.2], [0.64, 1.24], [0.64, 1.32], [0.5, 1.32],
        [0.46, 1.14], [0.0, 1.08]];
}

/// Pew from x = `near` to `far`, its seat at z = 0, looking along -z.
pub fn pew(near: f32, far: f32) -> Assembly {
    let mut pew = Assembly::new();
    pew.add("wood", &block([near, 0.43, -0.22], [far, 0.47, 0.2]));
    // The back leans a little, under a moulded rail.
    let lean = |p: Vec3| Vec3::new(p.x, p.y, p.z + 0.14 * (p.y - 0.45));
    pew.add("wood", &block([near, 0.12, 0.2], [far, 0.88, 0.225]).mapped(lean));
    let rail = beveled_box([near - 0.02, 0.86, 0.17], [far + 0.02, 0.92, 0.25], 0.02);
    pew.add("wood", &rail.mapped(lean));
    pew.add("wood", &block([near, 0.6, 0.33], [far, 0.63, 0.47]));
    pew.add("wood", &block([near, 0.12, 0.46], [far, 0.16, 0.62]));
    // The outline's depth becomes x.
    let end = extrude(&section::PEW_END, &[], 0.06).mapped(|p| Vec3::new(p.z, p.y, p.x)).flipped();
    pew.add_each("wood", &end, [near - 0.05, far - 0.01].map(|x| at(x, 0.0, 0.0)));
    pew
}

/// Altar at `foot` under a cloth, and a standing cross behind it.
pub fn altar(foot: Vec3) -> Assembly {
    let mut altar = Assembly::framed(at(foot.x, foot.y, foot.z));
    altar.add(STONE, &beveled_box([-1.25, -0.05, -0.5], [1.25, 0.12, 0.5], 0.03));
    altar.add(STONE, &block([-1.1, 0.1, -0.4], [1.1, 0.95, 0.4]));
    altar.add(STONE, &beveled_box([-1.3, 0.93, -0.5], [1.3, 1.05, 0.5], 0.03));
    let legs = [-1.12, -0.4, 0.4, 1.12].map(|x| at(x, 0.0, 0.43));
    altar.add_each(STONE, &lathe(&section::ALTAR_LEG, 10), legs);
    // The cloth lies over the slab and hangs down at both ends, with a few folds.
    altar.add("cloth", &beveled_box([-1.32, 1.035, -0.46], [1.32, 1.062, 0.515], 0.008));
    for side in [-1.0, 1.0] {
        let fall = patch(20, 3, |u, v| {
            let fold = 0.02 * (1.0 - v) * (u * 40.0).sin();
            Vec3::new(side * (1.322 + fold.abs()), 0.35 + 0.7 * v, -0.46 + 0.975 * u)
        });
        altar.add("cloth", &fall.facing(Vec3::new(side * 9.0, 0.7, 0.0)));
    }
    let front = patch(50, 3, |u, v| {
        let fold = 0.015 * (1.0 - v) * (u * 90.0).sin();
        Vec3::new(-1.32 + 2.64 * u, 0.62 + 0.43 * v, 0.517 + fold.abs())
    });
    altar.add("cloth", &front.facing(Vec3::new(0.0, 0.7, 9.0)));
    let mut cross = Assembly::framed(at(foot.x, foot.y, foot.z - 1.0));
    cross.add("wood", &beveled_box([-0.35, -0.05, -0.35], [0.35, 0.2, 0.35], 0.04));
    cross.add("wood", &beveled_box([-0.09, 0.15, -0.07], [0.09, 3.6, 0.07], 0.02));
    cross.add("wood", &beveled_box([-0.85, 2.55, -0.065], [0.85, 2.73, 0.065], 0.02));
    altar.merge(cross);
    altar
}

/// Eight-sided pulpit on a column in the frame `place`, with a panelled parapet.
pub fn pulpit(place: Affine3A) -> Assembly {
    let mut pulpit = Assembly::framed(place);
    pulpit.add(STONE, &lathe(&section::PULPIT, 8).creased(20.0));
    for (inner, outer, height, y) in
        [(0.72, 0.78, 0.95, 1.4), (0.69, 0.86, 0.08, 2.34), (0.7, 0.84, 0.07, 1.4)]
    {
        pulpit.add_at("wood", &ring(inner, outer, 0.0, height, 8).creased(20.0), at(0.0, y, 0.0));
    }
    let panel = beveled_box([-0.2, 1.58, -0.02], [0.2, 2.24, 0.02], 0.015);
    for k in 0..8 {
        let mut side = Assembly::framed(place * turned(45.0 * k as f32 + 22.5, Vec3::ZERO));
        side.add_at("wood", &panel, at(0.0, 0.0, 0.78 * 22.5_f32.to_radians().cos()));
        pulpit.merge(side);
    }
    pulpit.add_at("wood", &cylinder(0.04, 1.3, 8), at(0.55, 1.42, 0.0) * mirror_z());
    pulpit
}

/// Eight-sided font.
pub fn font() -> Shell {
    lathe(&section::FONT, 8).creased(20.0)
}
