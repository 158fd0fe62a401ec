//! Random triangles, and brute-force answers to the same queries without Embree.

use super::super::*;
use glam::{DVec3, Vec3};

/// A generator of uniform numbers in [0, 1) (splitmix64).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Returns a uniform point of the cube from -1 to 1.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - Vec3::ONE
    }
}

impl From<TriangleId> for (u32, u32) {
    fn from(id: TriangleId) -> (u32, u32) {
        (id.geometry, id.primitive)
    }
}

/// Three meshes of unconnected triangles in a cube; the middle one is empty.
pub struct Soup {
    meshes: [(Vec<Vec3>, Vec<[u32; 3]>); 3],
}

/// Brute-force answer for a ray.
pub enum Verdict {
    /// Rounding decides: the ray passes an edge, two triangles, or an end of the segment.
    Close,
    /// No rounding can change the answer.
    Certain(Option<Met>),
}

#[derive(Clone, Copy, Debug)]
pub struct Met {
    pub id: TriangleId,
    pub t: f64,
}

/// Distance in barycentric coordinates, or relative distance in t, within which single precision decides.
const ROUNDING: f64 = 1e-4;

impl Soup {
    pub fn random(count: u32, seed: u64) -> Soup {
        let mut random = Random(seed);
        let mut mesh = |count: u32| {
            let positions = (0..count)
                .flat_map(|_| {
                    let centre = random.point();
                    [(); 3].map(|()| centre + 0.3 * random.point())
                })
                .collect();
            (positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
        };
        Soup { meshes: [mesh(count / 2), mesh(0), mesh(count - count / 2)] }
    }

    /// Returns segments of all lengths in and around the triangles. One in four is a half-line.
    pub fn rays(&self, count: usize, seed: u64) -> Vec<Ray> {
        let mut random = Random(seed);
        (0..count)
            .map(|i| {
                let mut ray = Ray::new(1.5 * random.point(), random.point());
                if i % 4 != 0 {
                    ray.t_near = 0.3 * random.next();
                    ray.t_far = ray.t_near + 2.0 * random.next();
                }
                ray
            })
            .collect()
    }

    pub fn build(&self, device: &Device) -> Accel {
        let meshes: Vec<_> = self
            .meshes
            .iter()
            .map(|(positions, triangles)| TriangleMesh { positions, triangles, occludes: true })
            .collect();
        Accel::build(device, &meshes).unwrap()
    }

    pub fn corners(&self, id: TriangleId) -> [Vec3; 3] {
        let (positions, triangles) = &self.meshes[id.geometry as usize];
        triangles[id.primitive as usize].map(|i| positions[i as usize])
    }

    fn ids(&self) -> impl Iterator<Item = TriangleId> {
        (0..3u32).flat_map(|geometry| {
            let count = self.meshes[geometry as usize].1.len() as u32;
            (0..count).map(move |primitive| TriangleId { geometry, primitive })
        })
    }

    /// Returns the distance of one triangle along the ray, with the tolerance [`ROUNDING`] at its edges.
    pub fn distance(&self, ray: &Ray, id: TriangleId) -> Option<f64> {
        let (t, margin) = moeller_trumbore(ray, self.corners(id))?;
        (margin > -ROUNDING && t >= near(ray) - ROUNDING && t <= far(ray) + ROUNDING).then_some(t)
    }

    /// Returns the triangles that the ray crosses, and those for which rounding decides.
    pub fn crossed(&self, ray: &Ray) -> (Vec<TriangleId>, Vec<TriangleId>) {
        let (mut certain, mut close) = (Vec::new(), Vec::new());
        for id in self.ids() {
            let Some((t, margin)) = moeller_trumbore(ray, self.corners(id)) else { continue };
            match margin.min(t - near(ray)).min(far(ray) - t) {
                inside if inside >= ROUNDING => certain.push(id),
                inside if inside > -ROUNDING => close.push(id),
                _ => {}
            }
        }
        (certain, close)
    }

    pub fn closest(&self, ray: &Ray) -> Verdict {
        let mut met: Vec<Met> = Vec::new();
        for id in self.ids() {
            let Some((t, margin)) = moeller_trumbore(ray, self.corners(id)) else { continue };
            if margin < -ROUNDING || t < near(ray) - ROUNDING || t > far(ray) + ROUNDING {
                continue;
            }
            if margin < ROUNDING || (t - near(ray)).abs() < ROUNDING || (t - far(ray)).abs() < ROUNDING {
                return Verdict::Close;
            }
            met.push(Met { id, t });
        }
        met.sort_by(|a, b| a.t.total_cmp(&b.t));
        if let [first, second, ..] = met[..]
            && second.t - first.t < ROUNDING
        {
            return Verdict::Close;
        }
        Verdict::Certain(met.first().copied())
    }
}

fn near(ray: &Ray) -> f64 {
    ray.t_near.into()
}

fn far(ray: &Ray) -> f64 {
    ray.t_far.into()
}

/// Computes t of the triangle's plane, and the minimum barycentric coordinate there (Möller and Trumbore 1997).
fn moeller_trumbore(ray: &Ray, corners: [Vec3; 3]) -> Option<(f64, f64)> {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let (origin, direction): (DVec3, DVec3) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-12 {
        return None;
    }
    let u = (origin - a).dot(p) / determinant;
    let q = (origin - a).cross(ab);
    let v = direction.dot(q) / determinant;
    Some((ac.dot(q) / determinant, u.min(v).min(1.0 - u - v)))
}
