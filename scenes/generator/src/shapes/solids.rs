//! Boxes: plain, with bevelled edges, and tapering.

use super::{Shell, grid, rectangle};
use glam::{Vec2, Vec3};

/// Box between `low` and `high`, flat shaded.
pub fn block(low: impl Into<Vec3>, high: impl Into<Vec3>) -> Shell {
    frustum(low, high, Vec2::ONE)
}

/// Box whose top is its bottom scaled by `taper` in x and z about the middle (a wedge, a hopper, a plinth).
pub fn frustum(low: impl Into<Vec3>, high: impl Into<Vec3>, taper: Vec2) -> Shell {
    let (low, high) = (low.into(), high.into());
    let mut shell = Shell::new(0.0);
    let middle = 0.5 * (low + high);
    let corners: Vec<u32> = (0..8)
        .map(|bits| {
            let mut p = pick(low, high, bits);
            if bits & 2 != 0 {
                p.x = middle.x + (p.x - middle.x) * taper.x;
                p.z = middle.z + (p.z - middle.z) * taper.y;
            }
            shell.point(p)
        })
        .collect();
    // Bits: 1 = x, 2 = y, 4 = z. Each face counter-clockwise seen from outside.
    for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
        flat_polygon(&mut shell, &face.map(|k| corners[k]));
    }
    shell
}

/// Box between `low` and `high` with edges cut at 45° by `bevel` metres (limited to what fits).
pub fn beveled_box(low: impl Into<Vec3>, high: impl Into<Vec3>, bevel: f32) -> Shell {
    let (low, high) = (low.into(), high.into());
    let cut = bevel.min(0.49 * (high - low).min_element());
    if cut <= 0.0 {
        return block(low, high);
    }
    let mut shell = Shell::new(0.0);
    // Three points a corner, one on each of the faces that meet there: index 3·bits + axis of that face.
    for bits in 0..8 {
        for axis in 0..3 {
            let inset = Vec3::from_array([0, 1, 2].map(|k| if k == axis { 0.0 } else { cut }));
            shell.point(pick(low + inset, high - inset, bits));
        }
    }
    let id = |bits: usize, axis: usize| (3 * bits + axis) as u32;
    for axis in 0..3 {
        let (bit, b1, b2) = (1 << axis, 1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let ring = [0, b1, b1 | b2, b2];
        flat_polygon(&mut shell, &ring.map(|r| id(r | bit, axis)));
        let mut back = ring.map(|r| id(r, axis));
        back.reverse();
        flat_polygon(&mut shell, &back);
        // The four edges along `axis`, each between the faces of the other two axes.
        for r in ring {
            let (other, third) = ((axis + 1) % 3, (axis + 2) % 3);
            let quad = [id(r, other), id(r | bit, other), id(r | bit, third), id(r, third)];
            let outward_first = (r & b1 != 0) == (r & b2 != 0);
            let quad = if outward_first { [quad[3], quad[2], quad[1], quad[0]] } else { quad };
            flat_polygon(&mut shell, &quad);
        }
    }
    for bits in 0..8_usize {
        let triangle = [id(bits, 0), id(bits, 1), id(bits, 2)];
        let outward = bits.count_ones() % 2 == 1;
        flat_polygon(&mut shell, &if outward { triangle } else { [triangle[0], triangle[2], triangle[1]] });
    }
    shell
}

/// Paving slab between two corners in plan (x, z): its top at y = 0 with bevelled edges, and sides down to
/// `-depth`; without underside.
pub fn slab(low: Vec2, high: Vec2, depth: f32, bevel: f32) -> Shell {
    let ring = |inset: f32, y: f32| {
        let (a, b) = (low + Vec2::splat(inset), high - Vec2::splat(inset));
        [(a.x, b.y), (b.x, b.y), (b.x, a.y), (a.x, a.y)].map(|(x, z)| Vec3::new(x, y, z)).to_vec()
    };
    let mut shell = grid(&[ring(0.0, -depth), ring(bevel, 0.0)], true, false, 0.0);
    let top = [4, 5, 6, 7];
    shell.quad(top, top.map(|i: u32| Vec2::new(shell.points[i as usize].x, shell.points[i as usize].z)));
    shell
}

/// Tile of `size` about the origin, without its back; `lay` gives the place of a point of its outline at a height above
/// its bed.
pub fn tile(size: Vec2, thickness: f32, bevel: f32, lay: impl Fn(Vec2, f32) -> Vec3) -> Shell {
    let ring = |inset: f32, height: f32| {
        let h = 0.5 * size - inset;
        rectangle(-h, h).iter().map(|&p| lay(p, height)).collect::<Vec<Vec3>>()
    };
    let mut shell = grid(&[ring(0.0, 0.0), ring(bevel, thickness)], true, false, 10.0);
    shell.quad([4, 5, 6, 7], [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|p| p * size));
    shell
}

fn pick(low: Vec3, high: Vec3, bits: usize) -> Vec3 {
    Vec3::new(
        if bits & 1 == 0 { low.x } else { high.x },
        if bits & 2 == 0 { low.y } else { high.y },
        if bits & 4 == 0 { low.z } else { high.z },
    )
}

/// Appends a convex flat polygon with texture coordinates by the axis it faces.
fn flat_polygon(shell: &mut Shell, corners: &[u32]) {
    let at = |k: usize| shell.points[corners[k] as usize];
    let normal = (at(1) - at(0)).cross(at(2) - at(0)).abs();
    let uv = |i: u32| {
        let p = shell.points[i as usize];
        if normal.y >= normal.x && normal.y >= normal.z {
            Vec2::new(p.x, p.z)
        } else if normal.x >= normal.z {
            Vec2::new(p.z, p.y)
        } else {
            Vec2::new(p.x, p.y)
        }
    };
    let uvs: Vec<Vec2> = corners.iter().map(|&i| uv(i)).collect();
    for k in 1..corners.len() - 1 {
        shell.triangle([corners[0], corners[k], corners[k + 1]], [uvs[0], uvs[k], uvs[k + 1]]);
    }
}
