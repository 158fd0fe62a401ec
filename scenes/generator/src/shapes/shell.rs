//! An indexed surface before it has normals: corners that belong together share a point, so that whether
//! a shell is closed can be asked of its topology and creases can be found by angle.

use glam::{Affine3A, Mat3, Vec2, Vec3};

/// Surface with a texture coordinate at every triangle corner.
#[derive(Clone, Debug, Default)]
pub struct Shell {
    /// Points, shared between the triangles that meet there.
    pub points: Vec<Vec3>,
    /// Point indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates by triangle corner, in metres.
    pub uvs: Vec<[Vec2; 3]>,
    /// Faces that meet at more than this many degrees are shaded with a crease between them; 0 is flat.
    pub crease_degrees: f32,
}

impl Shell {
    /// Empty shell with the given crease angle.
    pub fn new(crease_degrees: f32) -> Self {
        Shell { crease_degrees, ..Shell::default() }
    }

    /// Appends a point and returns its index.
    pub fn point(&mut self, position: Vec3) -> u32 {
        self.points.push(position);
        self.points.len() as u32 - 1
    }

    /// Appends a triangle, unless two of its corners are the same point.
    pub fn triangle(&mut self, corners: [u32; 3], uvs: [Vec2; 3]) {
        let [a, b, c] = corners;
        if a != b && b != c && c != a {
            self.triangles.push(corners);
            self.uvs.push(uvs);
        }
    }

    /// Appends the quadrilateral `corners` as two triangles, or one where it has collapsed.
    pub fn quad(&mut self, corners: [u32; 4], uvs: [Vec2; 4]) {
        let [a, b, c, d] = corners;
        let [ta, tb, tc, td] = uvs;
        self.triangle([a, b, c], [ta, tb, tc]);
        self.triangle([a, c, d], [ta, tc, td]);
    }

    /// Shell with another crease angle.
    pub fn creased(mut self, degrees: f32) -> Self {
        self.crease_degrees = degrees;
        self
    }

    /// Shell moved by `transform`; a mirroring transform keeps the outside outside.
    pub fn transformed(mut self, transform: Affine3A) -> Self {
        for point in &mut self.points {
            *point = transform.transform_point3(*point);
        }
        if Mat3::from(transform.matrix3).determinant() < 0.0 { self.flipped() } else { self }
    }

    /// Shell with inside and outside exchanged.
    pub fn flipped(mut self) -> Self {
        for (triangle, uvs) in self.triangles.iter_mut().zip(&mut self.uvs) {
            triangle.swap(1, 2);
            uvs.swap(1, 2);
        }
        self
    }

    /// Shell without the flat faces that look along the unit vector `direction`, for things whose back
    /// touches a wall; it is then no longer closed.
    pub fn without_faces(mut self, direction: Vec3) -> Self {
        let points = &self.points;
        let looks_along = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            (b - a).cross(c - a).normalize_or_zero().dot(direction) > 0.999
        };
        let kept = self.triangles.iter().zip(&self.uvs).filter(|(t, _)| !looks_along(t));
        (self.triangles, self.uvs) = kept.map(|(t, uvs)| (*t, *uvs)).unzip();
        self
    }

    /// Shell with its outside turned towards `point`, judged by the mean of its faces; for open sheets.
    pub fn facing(self, point: Vec3) -> Self {
        let towards: f64 = self
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| self.points[i as usize].as_dvec3());
                (b - a).cross(c - a).dot(point.as_dvec3() - (a + b + c) / 3.0)
            })
            .sum();
        if towards < 0.0 { self.flipped() } else { self }
    }

    /// Shell with every point moved by `f`, for bending and tapering.
    pub fn mapped(mut self, f: impl Fn(Vec3) -> Vec3) -> Self {
        for point in &mut self.points {
            *point = f(*point);
        }
        self
    }

    /// Both shells as one; the crease angle is `self`'s.
    pub fn joined(mut self, other: &Shell) -> Self {
        let base = self.points.len() as u32;
        self.points.extend_from_slice(&other.points);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| base + i)));
        self.uvs.extend_from_slice(&other.uvs);
        self
    }
}
