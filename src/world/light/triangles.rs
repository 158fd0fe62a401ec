//! Points on emitting triangles in sixteen lanes.
//!
//! Lanes that have chosen one light, or one of its triangles, are set together by masks.

use super::area::{AreaLight, TriangleShape};
use super::direct::DirectSamples16;
use base::math::{F32x16, LANES, Mask16, U32x16, V3, Vec2x16, Vec3x16, lanes_in, lanes_with};
use base::sampling::uniform_triangle;
use glam::Vec2;

/// Maximum number of triangles of a light that are tried one after the other for all lanes.
const MAX_TRIED: usize = 8;

/// Points on emitting triangles, one per lane. Lanes of other emitters have zero area.
#[derive(Default)]
pub(super) struct Triangles16 {
    corner: Vec3x16,
    edges: [Vec3x16; 2],
    normal: Vec3x16,
    radiance: Vec3x16,
    /// Area of the whole emitter.
    area: F32x16,
    two_sided: U32x16,
    /// Triangles of the emitters' meshes.
    pub index: U32x16,
    /// Random numbers until [`Triangles16::sample`], then barycentric weights.
    pub barycentric: Vec2x16,
}

impl Triangles16 {
    /// Chooses triangles of a light in the lanes of a mask, by the random numbers `u`.
    #[inline]
    pub fn choose(&mut self, lanes: u16, light: &AreaLight, u: &Vec2x16) {
        if light.shapes().len() > MAX_TRIED || lanes.is_power_of_two() {
            lanes_in(lanes).for_each(|lane| self.set(lane, light, u.get(lane)));
            return;
        }
        let (index, rest) = light.choose_triangles16(&u.x);
        let mask = Mask16::of(lanes);
        mask.put_u32(&mut self.index, &index);
        mask.put(&mut self.barycentric.x, &rest);
        mask.put(&mut self.barycentric.y, &u.y);
        mask.put(&mut self.area, &[light.area; LANES]);
        mask.put_u32(&mut self.two_sided, &[u32::from(light.emission.two_sided); LANES]);
        self.radiance.put(mask, V3::splat(light.emission.radiance));
        let mut left = lanes;
        while left != 0 {
            let triangle = index[left.trailing_zeros() as usize];
            let here = left & lanes_with(&index, triangle);
            left &= !here;
            let TriangleShape { corner, edges: [e1, e2], normal } = light.shapes()[triangle as usize];
            if here == u16::MAX {
                (self.corner, self.normal) = (Vec3x16::splat(corner), Vec3x16::splat(normal));
                self.edges = [Vec3x16::splat(e1), Vec3x16::splat(e2)];
                continue;
            }
            let mask = Mask16::of(here);
            self.corner.put(mask, V3::splat(corner));
            self.edges[0].put(mask, V3::splat(e1));
            self.edges[1].put(mask, V3::splat(e2));
            self.normal.put(mask, V3::splat(normal));
        }
    }

    /// Chooses a triangle of a light for a lane, by the random numbers `u`.
    #[inline]
    fn set(&mut self, lane: usize, light: &AreaLight, u: Vec2) {
        let (triangle, TriangleShape { corner, edges: [e1, e2], normal }, u) = light.choose_triangle(u);
        self.corner.set(lane, corner);
        self.edges[0].set(lane, e1);
        self.edges[1].set(lane, e2);
        self.normal.set(lane, normal);
        self.radiance.set(lane, light.emission.radiance);
        self.area[lane] = light.area;
        self.two_sided[lane] = u32::from(light.emission.two_sided);
        self.index[lane] = triangle;
        self.barycentric.set(lane, u);
    }

    /// Maps the random numbers in `barycentric` to barycentric weights, and samples the light from these points. Writes
    /// all lanes.
    #[inline]
    pub fn sample(&mut self, x: &Vec3x16, choice: &F32x16, s: &mut DirectSamples16) {
        (s.normal, s.radiance) = (self.normal, self.radiance);
        for i in 0..LANES {
            let b = uniform_triangle(self.barycentric.get(i));
            self.barycentric.set(i, b);
            let position = self.corner.get(i) + self.edges[0].get(i) * b.x + self.edges[1].get(i) * b.y;
            let offset = position - x.get(i);
            let dist_sq = offset.length_squared();
            let distance = dist_sq.sqrt();
            let direction = offset / distance;
            let cos = -self.normal.get(i).dot(direction);
            let pdf = choice[i] * dist_sq / (self.area[i] * cos.abs());
            s.direction.set(i, direction);
            s.distance[i] = distance;
            s.pdf[i] = pdf;
            let shines = (cos > 0.0) | (self.two_sided[i] != 0);
            s.useful[i] = u32::from((pdf < f32::INFINITY) & (pdf > 0.0) & shines);
        }
    }
}
