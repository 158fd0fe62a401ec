//! Packets of sixteen segments equal the single segments; the engine agrees with Embree, and single rays with
//! the cache with those without.

mod self_shadowing;

use super::*;
use crate::World;
use base::math::Rgb;
use base::sampling::hash;
use embree::{Occluders16, Ray, Rays16, Width};
use glam::Vec3;
use rayon::prelude::*;
use scene::{Material, MaterialId, Mesh, Reflectance, Scene};
use std::f32::consts::{PI, TAU};

/// Number of segments in the long comparison.
const SEGMENTS: u32 = 10_000_000;
/// Number of lights that the cache distinguishes in it.
const KEYS: u32 = 173;

struct Numbers(u32, u32);

impl Numbers {
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(1);
        hash(self.0, self.1)
    }

    fn next(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / (1 << 24) as f32
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - Vec3::ONE
    }

    fn of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.bits() as usize % items.len()]
    }
}

/// Builds a closed box whose walls are grids, so that rays can pass through shared edges; a ball; and loose triangles
/// from large ones to slivers.
fn world() -> World {
    let mut meshes = Vec::new();
    let mut mesh = |positions: Vec<Vec3>, triangles| {
        meshes.push(Mesh {
            name: String::new(),
            positions,
            normals: Vec::new(),
            uvs: Vec::new(),
            tangents: Vec::new(),
            triangles,
            material: MaterialId(0),
            emission: None,
            attributes: Vec::new(),
        });
    };
    let n = 4u32;
    for (axis, side) in [(0, -1.0f32), (0, 1.0), (1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0)] {
        let at = |i: u32| i as f32 / n as f32 * 2.0 - 1.0;
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..=n {
            for j in 0..=n {
                let mut p = Vec3::splat(side);
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (at(i), at(j));
                positions.push(p);
                if i < n && j < n {
                    let a = i * (n + 1) + j;
                    triangles.extend([[a, a + n + 1, a + n + 2], [a, a + n + 2, a + 1]]);
                }
            }
        }
        mesh(positions, triangles);
    }
    let rings = 12u32;
    let ball = |i: u32, j: u32| {
        let [theta, phi] = [i as f32 * PI, j as f32 * TAU].map(|angle| angle / rings as f32);
        0.5 * Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    };
    let positions = (0..=rings).flat_map(|i| (0..rings).map(move |j| ball(i, j))).collect();
    let quads = (0..rings).flat_map(|i| (0..rings).map(move |j| (i, j)));
    let corner = |i: u32, j: u32| i * rings + j % rings;
    let split = |(i, j)| {
        [
            [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)],
            [corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)],
        ]
    };
    mesh(positions, quads.flat_map(split).collect());
    let mut numbers = Numbers(0, 77);
    let mut positions = Vec::new();
    for _ in 0..40 {
        let (a, size) = (0.9 * numbers.point(), numbers.of(&[0.3, 0.05, 1e-3]));
        let (b, thin) = (a + size * numbers.point(), numbers.of(&[1.0, 1e-2, 1e-5, 0.0]));
        positions.extend([a, b, a + (b - a) * numbers.next() + thin * size * numbers.point()]);
    }
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    mesh(positions, triangles);
    let grey = Material {
        name: String::new(),
        two_sided: true,
        diffuse: Reflectance::Constant(Rgb::ONE),
        ..Material::default()
    };
    World::new(Scene { meshes, materials: vec![grey], ..Scene::default() }, 1).unwrap()
}

/// Samples a segment among difficult cases.
fn segment_among(corners: &[[Vec3; 3]], numbers: &mut Numbers) -> Ray {
    let [a, b, c] = numbers.of(corners);
    let inside = |numbers: &mut Numbers| {
        let (u, v) = (numbers.next(), numbers.next());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        a + (b - a) * u + (c - a) * v
    };
    let edge = |numbers: &mut Numbers| a + (b - a) * numbers.next();
    let from = numbers.point();
    let normal = (b - a).cross(c - a).normalize_or_zero();
    match numbers.bits() % 12 {
        // Through the inside, an edge, a corner of a triangle.
        0..4 => Ray::between(from, from + (inside(numbers) - from) * (1.0 + numbers.next())),
        4 => Ray::between(from, from + (edge(numbers) - from) * 1.5),
        5 => Ray::between(from, from + (a - from) * 1.5),
        // Segments that end on the triangle, or start there, offset or not.
        6 => Ray::between(from, inside(numbers)),
        7 => Ray::between(inside(numbers), from),
        8 => segment(inside(numbers), normal, from, Vec3::ZERO),
        // Within the triangle's plane.
        9 => {
            let (p, q) = (inside(numbers), inside(numbers));
            Ray::between(p - (q - p) * numbers.next(), q + (q - p) * numbers.next())
        }
        // Zero length; far away.
        10 => Ray::between(from, from),
        _ => Ray { t_far: f32::INFINITY, ..Ray::between(from, inside(numbers)) },
    }
}

fn all_corners(world: &World) -> Vec<[Vec3; 3]> {
    world.scene.meshes.iter().flat_map(|m| (0..m.triangles.len()).map(|t| m.corners(t))).collect()
}

#[test]
fn the_cache_changes_no_answer() {
    let world = world();
    let corners = all_corners(&world);
    const CHUNK: u32 = 50_000;
    let totals: Vec<ShadowCounts> = (0..SEGMENTS / CHUNK)
        .into_par_iter()
        .map(|chunk| {
            let ways = [1, 2, 4, 8][chunk as usize % 4];
            let cached = Engine::with(&world, true, OccluderCacheSettings { slots: 128, ways });
            let mut numbers = Numbers(0, chunk);
            for _ in 0..CHUNK {
                // Few triangles a light, so that the next rays pass close to the cached ones.
                let key = numbers.bits() % KEYS;
                let few = &corners[key as usize * 3..][..3];
                let ray = segment_among(few, &mut numbers);
                let found = cached.occluder(&ray, key);
                assert_eq!(found.is_some(), world.accel.occluded(&ray), "{ray:?} {found:?}");
            }
            cached.take_counts()
        })
        .collect();
    let mut counts = ShadowCounts::default();
    totals.into_iter().for_each(|c| counts += c);
    let all = counts.single;
    assert_eq!(all.rays, u64::from(SEGMENTS));
    assert!(all.saved * 10 > all.rays && all.occluded < all.rays, "the test saves too little: {all:?}");
}

/// Samples sixteen neighbouring receivers and a light.
fn neighbours(corners: &[[Vec3; 3]], numbers: &mut Numbers) -> Rays16 {
    let (seed, light) = (segment_among(corners, numbers), numbers.point());
    let mut rays = Rays16::default();
    for lane in 0..16 {
        rays.set(lane, &Ray::between(seed.origin + 0.05 * numbers.point(), light));
    }
    rays
}

#[test]
fn packets_of_any_width_agree_with_single_rays() {
    let world = world();
    let corners = all_corners(&world);
    let engine = Engine::new(&world);
    let mut numbers = Numbers(0, 5);
    for _ in 0..20_000 {
        let rays = neighbours(&corners, &mut numbers);
        let valid = numbers.bits() as u16;
        let expected = world.accel.occluded_by(Width::One, &rays, valid, false);
        for width in Width::ALL {
            assert_eq!(world.accel.occluded_by(width, &rays, valid, true), expected, "{width:?}");
        }
        assert_eq!(engine.occluded16(&rays, valid), expected);
        let mut found = Occluders16 { t: [-1.0; 16], ..Occluders16::default() };
        assert_eq!(engine.occluders16(&rays, valid, &mut found), expected);
        for lane in base::math::lanes_in(expected) {
            assert!(found.t[lane] >= 0.0 && found.t[lane] <= 1.0);
        }
        let counts = engine.take_counts();
        let rays = 2 * u64::from(valid.count_ones());
        assert_eq!((counts.packets.queries, counts.packets.rays, counts.single.rays), (2, rays, 0));
    }
}

#[test]
fn the_cache_changes_no_answer_of_packets() {
    let world = world();
    let corners = all_corners(&world);
    let cached = Engine::with(&world, true, OccluderCacheSettings { slots: 128, ways: 4 });
    let mut numbers = Numbers(0, 6);
    for _ in 0..20_000 {
        // Few triangles a light, so that the next rays pass close to the cached ones.
        let key = numbers.bits() % KEYS;
        let rays = neighbours(&corners[key as usize * 3..][..3], &mut numbers);
        let valid = numbers.bits() as u16;
        let expected = world.accel.occluded_by(Width::One, &rays, valid, false);
        assert_eq!(cached.occluded16_cached(&rays, valid, key), expected);
    }
    let counts = cached.take_counts().packets;
    assert!(counts.saved > 0 && counts.saved < counts.occluded, "{counts:?}");
}
