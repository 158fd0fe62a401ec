//! The sink: a rounded basin let into the worktop, its rim, drain and a swan-neck tap.

use super::WORKTOP;
use crate::shapes::*;
use glam::{Vec2, Vec3};

/// Size of the basin's opening.
const BASIN: Vec2 = Vec2::new(0.56, 0.38);
const CORNER: f32 = 0.06;
const STEPS: usize = 5;

/// Inset from the opening and height over the worktop, from the outer edge of the rim over the lip and down to the
/// drain.
#[rustfmt::skip]
const LEVELS: [[f32; 2]; 9] = [[-0.016, 0.001], [-0.015, 0.003], [-0.004, 0.004], [0.002, 0.0], [0.006, -0.02],
    [0.014, -0.15], [0.022, -0.168], [0.04, -0.176], [0.15, -0.18]];

/// Hole the worktop needs for a sink about (x, depth).
pub fn cut_out(centre: Vec2) -> Vec<Vec2> {
    rounded_rectangle(BASIN, CORNER, STEPS).iter().map(|p| centre + *p).collect()
}

/// Sink about the origin of (x, depth), hanging from the worktop's height; the wall is towards -z.
pub fn sink() -> Assembly {
    let mut sink = Assembly::new();
    let rings: Vec<Vec<Vec3>> = LEVELS
        .iter()
        .map(|&[inset, y]| {
            let outline = rounded_rectangle(BASIN - 2.0 * inset, CORNER - inset.min(0.05), STEPS);
            outline.iter().map(|p| Vec3::new(p.x, WORKTOP + y, -p.y)).collect()
        })
        .collect();
    sink.add("sink", &loft(&rings, false, true, 50.0));
    sink.add_at("tap", &ring(0.03, 0.045, -0.001, 0.003, 24), at(0.0, WORKTOP - 0.18, 0.0));
    tap(&mut sink);
    sink
}

fn tap(sink: &mut Assembly) {
    let foot = Vec3::new(0.0, WORKTOP, -0.225);
    let base = [[0.028, 0.0], [0.028, 0.008], [0.02, 0.016], [0.018, 0.07], [0.0, 0.075]];
    sink.add_at("tap", &lathe(&base, 24), at(foot.x, foot.y, foot.z));
    let neck = [[0.0, 0.05, 0.0], [0.0, 0.33, 0.0], [0.0, 0.33, 0.19], [0.0, 0.22, 0.19]];
    let path: Vec<Vec3> = neck.iter().map(|p| foot + Vec3::from_array(*p)).collect();
    sink.add("tap", &pipe(&fillet(&path, 0.09, 9.0), 0.0115, 14));
    let spout = foot + Vec3::new(0.0, 0.22, 0.19);
    sink.add("tap", &rod(spout + Vec3::Y * 0.03, spout - Vec3::Y * 0.012, 0.0145, 16));
    let lever = foot + Vec3::new(0.015, 0.05, 0.0);
    sink.add("tap", &rod(lever, lever + Vec3::new(0.03, 0.004, 0.0), 0.009, 12));
    sink.add("tap", &rod(lever + Vec3::X * 0.026, lever + Vec3::new(0.05, 0.075, 0.0), 0.0045, 10));
}
