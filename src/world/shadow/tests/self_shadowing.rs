//! Shadow rays between points of one convex solid: any occlusion outside is self-shadowing, and any free
//! segment inside is a leak. Both at every scale, and far from the origin.

use crate::shadow;
use base::sampling::{owen_sobol_2d, uniform_sphere};
use embree::{Accel, Device, Hit, Ray, Rays16, TriangleMesh};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// A convex solid and its position.
struct Solid {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    accel: Accel,
    centre: Vec3,
    size: f32,
}

/// A point on the surface, in a renderer's precision: rounded, with the normal of its triangle.
#[derive(Clone, Copy)]
struct Point {
    position: Vec3,
    normal: Vec3,
}

impl Solid {
    /// Returns an octahedron, subdivided onto its sphere of radius `size`.
    fn sphere(size: f32, centre: Vec3) -> Solid {
        let octant = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from);
        let mut faces: Vec<[Vec3; 3]> = Vec::new();
        for signs in 0..8 {
            let flip = |axis: u32| if signs >> axis & 1 == 0 { 1.0 } else { -1.0 };
            let sign = Vec3::new(flip(0), flip(1), flip(2));
            let [a, b, c] = octant.map(|p| p * sign);
            // Counter-clockwise from outside; an odd number of reflections reverses the order.
            faces.push(if sign.element_product() > 0.0 { [a, b, c] } else { [a, c, b] });
        }
        for _ in 0..2 {
            faces = faces
                .into_iter()
                .flat_map(|[a, b, c]| {
                    let [ab, bc, ca] = [a + b, b + c, c + a].map(Vec3::normalize);
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        Solid::new(faces, size, centre)
    }

    /// Returns a box of sides up to `size` and a hundredth of it thick.
    fn slab(size: f32, centre: Vec3) -> Solid {
        let half = Vec3::new(1.0, 0.8, 0.01);
        let mut faces = Vec::new();
        for axis in 0..3 {
            for sign in [1.0f32, -1.0] {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |s: f32, t: f32| {
                    let mut p = Vec3::ZERO;
                    p[axis] = sign;
                    p[u] = s * sign;
                    p[v] = t;
                    p * half
                };
                let [a, b, c, d] =
                    [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        Solid::new(faces, size, centre)
    }

    fn new(faces: Vec<[Vec3; 3]>, size: f32, centre: Vec3) -> Solid {
        let positions: Vec<Vec3> = faces.into_iter().flatten().map(|p| centre + size * p).collect();
        let triangles: Vec<[u32; 3]> =
            (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = TriangleMesh { positions: &positions, triangles: &triangles, occludes: true };
        let accel = Accel::build(&Device::new(1).unwrap(), &[mesh]).unwrap();
        Solid { positions, triangles, accel, centre, size }
    }

    fn point(&self, hit: &Hit) -> Point {
        let [a, b, c] = self.triangles[hit.primitive as usize].map(|i| self.positions[i as usize]);
        let position = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        Point { position, normal: (b - a).cross(c - a).normalize() }
    }

    /// Returns surface points in the given directions, a few of them near edges.
    fn points(&self, directions: &[Vec3]) -> Vec<Point> {
        let seen = |d: &Vec3| {
            let eye = self.centre + 3.0 * self.size * *d;
            self.accel.closest_hit(&Ray::new(eye, self.centre - eye)).map(|hit| self.point(&hit))
        };
        directions.iter().filter_map(seen).collect()
    }

    /// Returns true if `q` lies behind all faces but those of this normal, by more than rounding: closer to an edge,
    /// rays may pass beside it or start beyond it.
    fn holds(&self, q: DVec3, normal: Vec3) -> bool {
        let rounding = 5e-7 * q.abs().max_element();
        self.triangles.iter().all(|triangle| {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize].as_dvec3());
            let other = (b - a).cross(c - a).normalize();
            other.dot(normal.as_dvec3()) > 0.999 || (q - a).dot(other) < -rounding
        })
    }

    /// Returns the point where a ray crosses the plane of the face at `p`.
    fn crossing(p: &Point, ray: &Ray) -> DVec3 {
        let [at, normal, origin, direction] =
            [p.position, p.normal, ray.origin, ray.direction].map(Vec3::as_dvec3);
        origin - direction * ((origin - at).dot(normal) / direction.dot(normal))
    }

    /// Returns the occlusion of segments, and checks that single rays and packets agree.
    fn occluded(&self, rays: &[Ray]) -> Vec<bool> {
        let single: Vec<bool> = rays.iter().map(|ray| self.accel.occluded(ray)).collect();
        for (rays, single) in rays.chunks(16).zip(single.chunks(16)) {
            let mut packet = Rays16::default();
            rays.iter().enumerate().for_each(|(lane, ray)| packet.set(lane, ray));
            let mask = single.iter().rev().fold(0, |mask, &o| mask << 1 | u16::from(o));
            assert_eq!(self.accel.occluded16(&packet, u16::MAX, true), mask);
        }
        single
    }
}

fn count(occluded: &[bool]) -> usize {
    occluded.iter().filter(|&&o| o).count()
}

/// Checks that all rays between mutually visible points are free, and all others are occluded.
fn check(solid: &Solid, directions: &[Vec3]) -> Result<(), TestCaseError> {
    let points = solid.points(directions);
    prop_assert!(points.len() * 10 >= directions.len() * 9, "too few points on the surface");

    // Outside, on the side of each point's own face: the solid is convex, so that there is no occluder.
    let (mut free, mut blocked) = (Vec::new(), Vec::new());
    for (p, d) in points.iter().zip(directions.iter().rev()) {
        let outside = solid.centre + 3.0 * solid.size * *d;
        let height = (outside - p.position).dot(p.normal);
        let ray = shadow::segment(p.position, p.normal, outside, Vec3::ZERO);
        // Rays within a thousandth of the horizon go either way.
        if height > 1e-3 * solid.size {
            free.push(ray);
        } else if height < -1e-3 * solid.size && solid.holds(Solid::crossing(p, &ray), p.normal) {
            blocked.push(ray);
        }
    }
    prop_assert!(free.len() > 20 && blocked.len() > 20);
    prop_assert_eq!(count(&solid.occluded(&free)), 0, "self-shadowing of {} rays", free.len());
    let leaks = blocked.len() - count(&solid.occluded(&blocked));
    prop_assert_eq!(leaks, 0, "of {} rays through the solid", blocked.len());

    // Inside, from surface to surface: both ends must be offset.
    let inner: Vec<Ray> = points
        .iter()
        .zip(points.iter().rev())
        .filter(|(a, b)| {
            let d = b.position - a.position;
            a.normal.dot(d) < -1e-3 * solid.size && b.normal.dot(d) > 1e-3 * solid.size
        })
        .map(|(a, b)| (a, b, shadow::segment(a.position, a.normal, b.position, b.normal)))
        .filter(|(a, b, ray)| {
            let ends = [ray.origin, ray.origin + ray.direction].map(Vec3::as_dvec3);
            solid.holds(ends[0], a.normal) && solid.holds(ends[1], b.normal)
        })
        .map(|(_, _, ray)| ray)
        .collect();
    prop_assert!(inner.len() > 20);
    prop_assert_eq!(count(&solid.occluded(&inner)), 0, "self-shadowing of {} rays inside", inner.len());
    Ok(())
}

fn direction() -> impl Strategy<Value = Vec3> {
    (-1.0f32..1.0, 0.0f32..std::f32::consts::TAU).prop_map(|(z, phi)| {
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * phi.cos(), r * phi.sin(), z)
    })
}

/// Returns directions all around, which follow from one number. If each was a free parameter, failures would shrink to
/// cases of too few points.
fn directions(seed: u32) -> Vec<Vec3> {
    (0..400).map(|i| uniform_sphere(owen_sobol_2d(i, seed))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn surfaces_neither_shadow_themselves_nor_leak(
        exponent in -6.0f32..6.0,
        // The scene's centre is the origin, so that parts of it are at multiples of their own size.
        distance in prop_oneof![Just(0.0f32), 1.0f32..1000.0],
        towards in direction(),
        seed in any::<u32>(),
    ) {
        let size = 10f32.powf(exponent);
        let centre = distance * size * towards;
        check(&Solid::sphere(size, centre), &directions(seed))?;
    }

    #[test]
    fn thin_walls_hold(
        exponent in -6.0f32..6.0,
        distance in prop_oneof![Just(0.0f32), 1.0f32..100.0],
        towards in direction(),
        seed in any::<u32>(),
    ) {
        let size = 10f32.powf(exponent);
        let solid = Solid::slab(size, distance * size * towards);
        check(&solid, &directions(seed))?;
    }
}

/// Tests segments whose end lies near the origin: it is only as precise as the segment is long.
#[test]
fn ends_near_the_origin_are_free_from_afar() {
    let result = check(&Solid::sphere(1.0, Vec3::X), &directions(54_657_067));
    assert!(result.is_ok(), "{result:?}");
}
