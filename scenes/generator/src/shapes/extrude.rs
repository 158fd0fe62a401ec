//! Flat outlines with holes given a thickness: pierced walls, gussets, plates with cut-outs.

use super::{Shell, points};
use earcut::Earcut;
use glam::Vec2;

/// Faces that a prism has.
#[derive(Clone, Copy, Debug)]
pub struct Faces {
    /// Face at the end of the direction of travel.
    pub front: bool,
    /// Face at its start.
    pub back: bool,
    /// Sides along the outline.
    pub rim: bool,
    /// Sides along the holes.
    pub reveals: bool,
}

impl Faces {
    /// Closed prism.
    pub const ALL: Faces = Faces { front: true, back: true, rim: true, reveals: true };
    /// Wall whose outer edges are hidden.
    pub const NO_RIM: Faces = Faces { rim: false, ..Faces::ALL };
    /// Sheet with the reveals of its holes behind it.
    pub const FRONT: Faces = Faces { back: false, rim: false, ..Faces::ALL };
    /// Tube.
    pub const NO_ENDS: Faces = Faces { front: false, back: false, ..Faces::ALL };
}

/// Extrudes `outline` (in x and y) with `holes` from z = 0 to z = `depth`, closed. Either winding will do;
/// outlines may not cross themselves or each other.
pub fn extrude(outline: &[impl Into<Vec2> + Copy], holes: &[Vec<Vec2>], depth: f32) -> Shell {
    extrude_faces(outline, holes, depth, Faces::ALL)
}

/// Extrudes like [`extrude`], with only some of the faces.
pub fn extrude_faces(
    outline: &[impl Into<Vec2> + Copy],
    holes: &[Vec<Vec2>],
    depth: f32,
    faces: Faces,
) -> Shell {
    let mut shell = Shell::new(30.0);
    let outer = oriented(&points(outline), true);
    let inner: Vec<Vec<Vec2>> = holes.iter().map(|h| oriented(h, false)).collect();
    let flat: Vec<Vec2> = outer.iter().chain(inner.iter().flatten()).copied().collect();
    let count = flat.len() as u32;
    for z in [0.0, depth] {
        for p in &flat {
            shell.point(p.extend(z));
        }
    }
    for [a, b, c] in triangulate(&outer, &inner) {
        let uvs = [a, b, c].map(|i| flat[i as usize]);
        if faces.front {
            shell.triangle([count + a, count + b, count + c], uvs);
        }
        if faces.back {
            shell.triangle([a, c, b], [uvs[0], uvs[2], uvs[1]]);
        }
    }
    let mut base = 0;
    for (k, ring) in std::iter::once(&outer).chain(&inner).enumerate() {
        if if k == 0 { faces.rim } else { faces.reveals } {
            sides(&mut shell, ring, base, count, depth);
        }
        base += ring.len() as u32;
    }
    shell
}

fn sides(shell: &mut Shell, ring: &[Vec2], base: u32, count: u32, depth: f32) {
    let mut u = 0.0;
    for i in 0..ring.len() {
        let k = (i + 1) % ring.len();
        let next_u = u + ring[i].distance(ring[k]);
        let (a, b) = (base + i as u32, base + k as u32);
        shell.quad(
            [a, b, count + b, count + a],
            [Vec2::new(u, 0.0), Vec2::new(next_u, 0.0), Vec2::new(next_u, depth), Vec2::new(u, depth)],
        );
        u = next_u;
    }
}

fn oriented(ring: &[Vec2], counter_clockwise: bool) -> Vec<Vec2> {
    let twice_area: f32 = (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum();
    let mut ring = ring.to_vec();
    if (twice_area > 0.0) != counter_clockwise {
        ring.reverse();
    }
    ring
}

/// Triangles over the points of `outline` followed by those of the holes, counter-clockwise for either
/// winding of the input.
pub(super) fn triangulate(outline: &[Vec2], holes: &[Vec<Vec2>]) -> Vec<[u32; 3]> {
    let points: Vec<Vec2> = outline.iter().chain(holes.iter().flatten()).copied().collect();
    let mut starts = Vec::with_capacity(holes.len());
    let mut start = outline.len() as u32;
    for hole in holes {
        starts.push(start);
        start += hole.len() as u32;
    }
    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut(points.iter().map(|p| [p.x, p.y]), &starts, &mut indices);
    indices
        .chunks_exact(3)
        .map(|t| {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| points[i as usize]);
            if (b - a).perp_dot(c - a) >= 0.0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] }
        })
        .collect()
}
