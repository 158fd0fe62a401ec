//! Points on surfaces, and what cones cover of them.

use super::*;
use crate::testkit::{self, add_material, diffuse, quad, textured};
use base::math::Rgb;
use embree::{Hit, Hits16, TriangleId};
use glam::{Vec2, Vec3};
use scene::{MaterialId, Mesh, Scene};

/// Builds a triangle in the plane z = 2 whose front faces down, and a tiny triangle.
fn world(normals: Vec<Vec3>) -> World {
    let mesh = |positions, normals| Mesh {
        name: String::new(),
        positions,
        normals,
        uvs: Vec::new(),
        tangents: Vec::new(),
        triangles: vec![[0, 1, 2]],
        material: MaterialId(0),
        emission: None,
        attributes: Vec::new(),
    };
    let triangle = vec![Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 3.0, 2.0), Vec3::new(4.0, 0.0, 2.0)];
    let tiny = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|v| v * 1e-20);
    let meshes = vec![mesh(triangle, normals), mesh(tiny.to_vec(), Vec::new())];
    World::new(Scene { meshes, materials: vec![diffuse(Rgb::ONE)], ..Scene::default() }, 1).expect("a world")
}

/// Returns the hit of a ray straight up at (x, y).
fn above(world: &World, x: f32, y: f32) -> Option<Surface> {
    world.intersect(&Ray { origin: Vec3::new(x, y, 0.5), t_near: 0.0, direction: Vec3::Z * 0.5, t_far: 9.0 })
}

#[test]
fn a_hit_is_where_the_ray_meets_the_triangle() {
    let world = world(Vec::new());
    let s = above(&world, 1.0, 1.5).expect("a hit");
    assert!((s.position - Vec3::new(1.0, 1.5, 2.0)).length() < 1e-6);
    assert!((s.barycentric - Vec2::new(0.5, 0.25)).length() < 1e-6);
    assert!((s.t - 3.0).abs() < 1e-6 && (s.mesh, s.triangle) == (0, 0));
    // The front is where the corners go round anticlockwise.
    assert_eq!((s.normal, s.frame.normal), (-Vec3::Z, -Vec3::Z));
    assert!(above(&world, 3.0, 1.5).is_none());
}

#[test]
fn geometric_normals_follow_the_winding_of_the_smallest_triangles_too() {
    let world = world(Vec::new());
    assert_eq!(world.geometric_normal(0, 0), -Vec3::Z);
    assert!((world.geometric_normal(1, 0) + Vec3::Y).length() < 1e-6);
    let (corner, edges) = world.corner_and_edges(TriangleId { geometry: 0, primitive: 0 });
    assert_eq!((corner, edges), (Vec3::Z * 2.0, [Vec3::Y * 3.0, Vec3::X * 4.0]));
}

#[test]
fn shading_normals_are_interpolated_unless_they_cancel() {
    let tilted = world(vec![-Vec3::Z, Vec3::new(0.0, 0.6, -0.8), Vec3::new(0.6, 0.0, -0.8)]);
    let s = above(&tilted, 1.0, 1.5).expect("a hit");
    let expected =
        (-Vec3::Z * 0.25 + Vec3::new(0.0, 0.6, -0.8) * 0.5 + Vec3::new(0.6, 0.0, -0.8) * 0.25).normalize();
    assert!((s.frame.normal - expected).length() < 1e-6 && s.normal == -Vec3::Z);
    let cancelling = world(vec![Vec3::X, -Vec3::X, Vec3::ZERO]);
    let degenerate = Hit { t: 1.0, u: 0.5, v: 0.0, geometry: 0, primitive: 0 };
    assert_eq!(cancelling.surface(&degenerate).frame.normal, -Vec3::Z);
}

#[test]
fn sixteen_surfaces_are_those_of_each_hit() {
    let world = world(vec![Vec3::X, -Vec3::X, Vec3::new(0.6, 0.0, -0.8)]);
    let mut hits = Hits16::default();
    for lane in 0..16 {
        (hits.u[lane], hits.v[lane], hits.t[lane]) = (lane as f32 / 32.0, 0.5 - lane as f32 / 32.0, 1.5);
    }
    let all = world.surfaces(&hits);
    for lane in 0..16 {
        let hit = Hit { t: 1.5, u: hits.u[lane], v: hits.v[lane], geometry: 0, primitive: 0 };
        assert_eq!(format!("{:?}", all.get(lane)), format!("{:?}", world.surface(&hit)));
    }
}

#[test]
fn the_diagonal_is_that_of_all_surfaces() {
    assert!((world(Vec::new()).diagonal - Vec3::new(4.0, 3.0, 2.0).length()).abs() < 1e-5);
    assert_eq!(World::new(Scene::default(), 1).expect("an empty world").diagonal, 1.0);
}

#[test]
fn a_cone_covers_more_at_grazing_angles_up_to_a_limit() {
    let mut scene = testkit::scene(Default::default(), [1, 1]);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    // Four texture coordinates by two over a square of edge 2: u along x counts 2 a unit, v along y 1.
    let square = quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, grey);
    scene.meshes.push(textured(square, Vec2::new(4.0, 2.0)));
    let world = testkit::world(scene);
    let covered = |direction: Vec3| {
        let ray = Ray::new(Vec3::new(0.1, 0.2, 0.0) - direction, direction);
        let surface = world.intersect(&ray).expect("the square");
        assert_eq!(world.covered(0, surface.triangle, Vec3::ZERO), 0.0);
        world.covered(0, surface.triangle, direction * 0.1)
    };
    // An area of .1 by .1, and one of .1 by .1 / .6 at a cosine of .6.
    assert!((covered(-Vec3::Z).powi(2) - 0.02).abs() < 1e-6);
    assert!((covered(Vec3::new(0.8, 0.0, -0.6)).powi(2) - 0.02 / 0.6).abs() < 1e-6);
    let grazing = covered(Vec3::new(1.0, 0.0, -1e-4).normalize());
    assert!((grazing.powi(2) - 0.02 / 0.01).abs() < 1e-4, "{grazing}");
}

#[test]
fn what_has_no_texture_coordinates_covers_none() {
    let mut scene = testkit::scene(Default::default(), [1, 1]);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.push(quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, grey));
    assert_eq!(testkit::world(scene).covered(0, 0, -Vec3::Z), 0.0);
}
