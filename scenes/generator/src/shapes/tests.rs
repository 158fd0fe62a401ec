//! Solids are closed and as large as they should be, sheets look to their side.

use super::*;
use glam::{Vec2, Vec3};
use proptest::prelude::{prop, prop_assert, proptest};

impl Shell {
    /// Volume inside, positive where the faces look outwards; meaningful for closed shells only.
    pub fn signed_volume(&self) -> f64 {
        let origin = self.points.first().map_or(glam::DVec3::ZERO, |p| p.as_dvec3());
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| self.points[i as usize].as_dvec3() - origin);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    /// True if every edge is shared by exactly two triangles that run along it in opposite directions.
    pub fn is_closed(&self) -> bool {
        let mut edges: Vec<(u32, u32)> =
            self.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        edges.sort_unstable();
        edges.windows(2).all(|pair| pair[0] != pair[1])
            && edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok())
    }
}

fn solids() -> Vec<(&'static str, Shell, f64)> {
    let vase = [[0.0, 0.0], [0.5, 0.1], [0.3, 0.6], [0.4, 1.0], [0.0, 1.1]];
    let square = rectangle(Vec2::splat(-0.5), Vec2::splat(0.5));
    let hole = circle(0.3, 64);
    let bend = fillet(&[Vec3::ZERO, Vec3::X * 4.0, Vec3::new(4.0, 0.0, 4.0)], 1.0, 5.0);
    let loop_path = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0), Vec3::Z].map(|p| p * 4.0);
    let loop_section = Section { points: &square, closed: true, crease_degrees: 30.0 };
    let pi = std::f64::consts::PI;
    vec![
        ("block", block(Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)), 6.0),
        ("beveled box", beveled_box(Vec3::ZERO, Vec3::ONE, 0.001), 1.0),
        ("frustum", frustum(Vec3::ZERO, Vec3::ONE, Vec2::new(0.0001, 0.0001)), 1.0 / 3.0),
        ("cylinder", cylinder(1.0, 2.0, 256), 2.0 * pi),
        ("cone", cone(1.0, 0.0, 3.0, 256), pi),
        ("inverted cone", cone(0.0, 1.0, 3.0, 256), pi),
        ("ring", ring(0.5, 1.0, 0.0, 1.0, 256), 0.75 * pi),
        ("torus", torus(2.0, 0.5, 256, 128), 2.0 * pi * pi * 2.0 * 0.25),
        ("ellipsoid", ellipsoid(Vec3::new(1.0, 2.0, 3.0), 128, 64), 8.0 * pi),
        ("vase", lathe(&vase, 32), f64::NAN),
        ("plate", extrude(&square, std::slice::from_ref(&hole), 2.0), 2.0 * (1.0 - 0.09 * pi)),
        ("pipe", pipe(&bend, 0.1, 64), 0.01 * pi * f64::from(length(&bend))),
        ("mitred bar", sweep(&square, &[Vec3::ZERO, Vec3::X * 3.0, Vec3::new(3.0, 4.0, 0.0)], Vec3::Z), 7.0),
        ("square loop", sweep_along(loop_section, &loop_path, Vec3::Y, true, Faces::ALL), 16.0),
        ("spring", pipe(&helix(1.0, 0.5, 3.0, 32), 0.1, 16), f64::NAN),
    ]
}

fn length(path: &[Vec3]) -> f32 {
    path.windows(2).map(|p| p[0].distance(p[1])).sum()
}

#[test]
fn solids_are_closed_and_hold_their_volume() {
    for (name, shell, volume) in solids() {
        assert!(shell.is_closed(), "{name} has open or doubled edges");
        let found = shell.signed_volume();
        assert!(found > 0.0, "{name} is inside out: {found}");
        if volume.is_finite() {
            assert!((found / volume - 1.0).abs() < 0.01, "{name}: volume {found}, expected {volume}");
        }
    }
}

#[test]
fn an_open_or_flipped_solid_is_found_out() {
    let solid = block(Vec3::ZERO, Vec3::ONE);
    assert!(solid.clone().flipped().signed_volume() < 0.0);
    let mut open = solid.clone();
    open.triangles.pop();
    assert!(!open.is_closed());
    let mut inconsistent = solid;
    inconsistent.triangles[0].swap(0, 1);
    assert!(!inconsistent.is_closed());
}

#[test]
fn no_triangle_is_degenerate_and_normals_agree_with_the_winding() {
    for (name, shell, _) in solids() {
        let part = shell.with_normals();
        for t in &part.triangles {
            let [a, b, c] = t.map(|i| part.positions[i as usize]);
            let geometric = (b - a).cross(c - a);
            assert!(geometric.length() > 1e-9, "{name}: triangle {a} {b} {c} has no area");
            for i in t.map(|i| i as usize) {
                let normal = part.normals[i];
                assert!((normal.length() - 1.0).abs() < 1e-4, "{name}: normal {normal}");
                assert!(normal.dot(geometric) > 0.0, "{name}: normal {normal} against {geometric}");
                assert!(part.uvs[i].is_finite());
            }
        }
    }
}

#[test]
fn smooth_shapes_share_normals_and_creases_split_them() {
    let part = cylinder(1.0, 1.0, 32).with_normals();
    for (p, n) in part.positions.iter().zip(&part.normals) {
        let radial = Vec3::new(p.x, 0.0, p.z);
        assert!(n.dot(Vec3::Y).abs() > 0.999 || n.dot(radial) > 0.999, "normal {n} at {p}");
    }
    assert_eq!(block(Vec3::ZERO, Vec3::ONE).with_normals().positions.len(), 24);
}

#[test]
fn sheets_look_to_the_stated_side() {
    let part = sheet(Vec3::ZERO, Vec3::X, Vec3::Z).with_normals();
    assert_eq!(part.triangles.len(), 2);
    assert!(part.normals.iter().all(|n| n.distance(-Vec3::Y) < 1e-6));
}

#[test]
fn mirroring_keeps_the_outside_outside() {
    let mut part = Part::new("mirrored");
    part.add(&cone(1.0, 0.2, 1.0, 16), at(3.0, 0.0, 0.0) * mirror_x());
    let volume: f32 = part
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| part.positions[i as usize]);
            a.dot(b.cross(c))
        })
        .sum();
    assert!(volume > 0.0);
}

#[test]
fn concentric_arches_keep_their_distance() {
    let inner = PointedArch { half_span: 2.0, rise: 3.0 };
    let outer = inner.offset(0.5);
    let centre = Vec2::new(inner.radius() - inner.half_span, 0.0);
    for k in 0..=8 {
        let t = k as f32 / 8.0;
        assert!((outer.left(t).distance(centre) - inner.radius() - 0.5).abs() < 1e-5);
    }
    assert!(outer.left(1.0).x.abs() < 1e-5, "the offset arch meets on the axis");
}

#[test]
fn the_random_numbers_never_change() {
    let mut rng = Rng::new(1);
    assert_eq!([(); 3].map(|()| rng.next_u32()), [1_245_324_245, 2_328_392_939, 3_370_181_423]);
    let mean: f32 = (0..4096).map(|_| rng.unit()).sum::<f32>() / 4096.0;
    assert!((mean - 0.5).abs() < 0.02, "mean {mean}");
    assert!((0..1000).all(|_| rng.below(7) < 7));
}

proptest! {
    #[test]
    fn boxes_of_any_size_are_closed(size in prop::array::uniform3(0.01_f32..10.0), bevel in 0.0_f32..1.0) {
        let shell = beveled_box(Vec3::ZERO, Vec3::from_array(size), bevel);
        prop_assert!(shell.is_closed());
        let full = f64::from(size[0]) * f64::from(size[1]) * f64::from(size[2]);
        prop_assert!(shell.signed_volume() > 0.0 && shell.signed_volume() <= full * 1.0001);
    }

    #[test]
    fn pipes_around_any_corner_are_closed(x in -3.0_f32..3.0, y in -3.0_f32..3.0, z in 0.5_f32..3.0) {
        let path = fillet(&[Vec3::ZERO, Vec3::Z * 3.0, Vec3::new(x, y, 3.0 + z)], 0.5, 15.0);
        let shell = pipe(&path, 0.05, 8);
        prop_assert!(shell.is_closed());
        let expected = 8.0 * 0.5 * 0.0025 * std::f32::consts::FRAC_PI_4.sin() * length(&path);
        let ratio = shell.signed_volume() as f32 / expected;
        prop_assert!((ratio - 1.0).abs() < 0.05, "volume off by {ratio}");
    }
}
