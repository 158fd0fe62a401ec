//! Deep windows: bar tracery, a sloping sill, and a sky panel that closes the opening flush with the outer
//! face, so that the thickness of the wall hides it from most of what is below.

use super::plan::Window;
use crate::shapes::*;
use glam::{Affine3A, Vec2, Vec3};

/// Tracery, sill and sky panel of `window` about `middle` in a wall whose local frame is `frame`.
pub fn glazed(window: &Window, middle: f32, thickness: f32, frame: Affine3A) -> Assembly {
    let local = frame * at(middle, 0.0, 0.0);
    let mut glazed = Assembly::framed(local);
    glazed.add("tracery", &tracery(window).mapped(|p| p + Vec3::Z * (0.58 * thickness)));
    let half = window.head.half_span;
    // The sill slopes down towards the inside.
    let (inner, outer) = (-0.04, thickness - 0.02);
    let slope = [
        [inner, window.sill],
        [inner, window.sill + 0.04],
        [outer, window.sill + 0.45],
        [outer, window.sill],
    ];
    let sill = extrude(&slope, &[], 2.0 * half + 0.1)
        .mapped(|p| Vec3::new(p.z - half - 0.05, p.y - 0.01, p.x))
        .flipped();
    glazed.add("sills", &sill);
    glazed.merge(sky_behind(window, thickness, local));
    glazed
}

/// Plate with two lancets and a quatrefoil (one lancet where the window is narrow).
fn tracery(window: &Window) -> Shell {
    let fitted = PointedArch { half_span: window.head.half_span + 0.03, rise: window.head.rise + 0.03 };
    let spring = window.spring;
    let outline = fitted.opening(Vec2::new(0.0, spring), window.sill - spring - 0.02, 6);
    let half = window.head.half_span;
    let bar = 0.1 * half + 0.02;
    let lancet_half = 0.5 * half - 0.95 * bar;
    let lancet = PointedArch { half_span: lancet_half, rise: 1.55 * lancet_half };
    let lancet_spring = spring - 0.12 * window.head.rise;
    let mut holes: Vec<Vec<Vec2>> = [-0.5, 0.5]
        .iter()
        .map(|side| {
            let centre = Vec2::new(side * half, lancet_spring);
            lancet.opening(centre, window.sill - lancet_spring + 0.1, 4)
        })
        .collect();
    let lobe = 0.19 * half;
    let centre = Vec2::new(0.0, spring + 0.53 * window.head.rise);
    holes.push(foil(4, 1.08 * lobe, lobe, 45.0, 4).iter().map(|p| *p + centre).collect());
    extrude_faces(&outline, &holes, 0.18, Faces::NO_RIM)
}

/// Sky panel that closes a window, a little inside the wall's outer face.
pub fn sky_behind(window: &Window, thickness: f32, local: Affine3A) -> Assembly {
    // The edge lies inside the wall, so that there is no gap where the curves are cut differently.
    let hidden = 0.04;
    let sill = window.sill - window.spring - hidden;
    let outline = window.head.offset(hidden).opening(Vec2::new(0.0, window.spring), sill, 8);
    let front = Faces { reveals: false, ..Faces::FRONT };
    let panel = extrude_faces(&outline, &[], thickness - 0.06, front).facing(Vec3::NEG_Z);
    let mut sky = Assembly::framed(local);
    sky.add("sky_panels", &panel.mapped(|p| Vec3::new(p.x, p.y, thickness - 0.06)));
    sky
}
