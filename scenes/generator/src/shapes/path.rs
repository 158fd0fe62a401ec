//! Polylines to sweep along: rounded corners and helices.

use glam::Vec3;
use std::f32::consts::TAU;

/// `path` with every inner corner replaced by an arc of `radius` in steps of at most `step_degrees`; where
/// the neighbouring segments are too short for the radius, it shrinks to fit.
pub fn fillet(path: &[impl Into<Vec3> + Copy], radius: f32, step_degrees: f32) -> Vec<Vec3> {
    let path: Vec<Vec3> = path.iter().map(|&p| p.into()).collect();
    let mut rounded = vec![path[0]];
    for k in 1..path.len() - 1 {
        let corner = path[k];
        let incoming = (corner - path[k - 1]).normalize();
        let outgoing = (path[k + 1] - corner).normalize();
        let turn = incoming.dot(outgoing).clamp(-1.0, 1.0).acos();
        if turn < 1e-3 {
            rounded.push(corner);
            continue;
        }
        let half_tan = (0.5 * turn).tan();
        let room = 0.49 * corner.distance(path[k - 1]).min(corner.distance(path[k + 1]));
        let reach = (radius * half_tan).min(room);
        let radius = reach / half_tan;
        let inwards = (outgoing - incoming * incoming.dot(outgoing)).normalize();
        let start = corner - incoming * reach;
        let centre = start + inwards * radius;
        let steps = (turn.to_degrees() / step_degrees).ceil().max(1.0) as usize;
        rounded.extend((0..=steps).map(|s| {
            let (sin, cos) = (turn * s as f32 / steps as f32).sin_cos();
            centre - inwards * (radius * cos) + incoming * (radius * sin)
        }));
    }
    rounded.push(path[path.len() - 1]);
    rounded
}

/// Helix about the y axis through the origin, from height 0, in `steps` segments a turn.
pub fn helix(radius: f32, pitch: f32, turns: f32, steps: usize) -> Vec<Vec3> {
    let count = (turns * steps as f32).ceil() as usize;
    (0..=count)
        .map(|k| {
            let t = turns * k as f32 / count as f32;
            let (sin, cos) = (TAU * t).sin_cos();
            Vec3::new(radius * cos, pitch * t, radius * sin)
        })
        .collect()
}
