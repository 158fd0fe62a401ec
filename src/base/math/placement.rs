//! Affine transforms that place surfaces.

use glam::{Affine3, Mat3, Vec3, Vec4};

/// Transform of surfaces from coordinates of their own to those of the scene. It is not singular.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Placement(pub Affine3);

impl Placement {
    /// Placement that changes nothing.
    pub const IDENTITY: Placement = Placement(Affine3::IDENTITY);

    /// Returns the placed point.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + self.0.translation
    }

    /// Returns the placed difference of two points.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let Mat3 { x_axis, y_axis, z_axis } = self.0.matrix3;
        x_axis * v.x + y_axis * v.y + z_axis * v.z
    }

    /// Returns the placed normal, of unit length or zero. The outside stays outside if the transform mirrors.
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        // Cofactors replace the inverse transpose: they agree up to a factor of the determinant's sign.
        let [x, y, z] = self.cofactors();
        let placed = x * n.x + y * n.y + z * n.z;
        let largest = placed.abs().max_element();
        let unit = (placed / if largest > 0.0 { largest } else { 1.0 }).normalize_or_zero();
        if self.mirrors() { -unit } else { unit }
    }

    /// Returns the placed tangent. The sign of w changes if the transform mirrors.
    #[inline]
    pub fn tangent(&self, t: Vec4) -> Vec4 {
        let along = self.vector(t.truncate()).normalize_or_zero();
        along.extend(if self.mirrors() { -t.w } else { t.w })
    }

    /// True if the transform mirrors.
    #[inline]
    pub fn mirrors(&self) -> bool {
        self.determinant() < 0.0
    }

    /// Returns the factor on areas, averaged over directions of planes.
    pub fn area_scale(&self) -> f64 {
        f64::from(self.determinant().abs()).powf(2.0 / 3.0)
    }

    /// Returns the lowest and the highest corner of the box around a placed box.
    pub fn bounds(&self, [low, high]: [Vec3; 2]) -> [Vec3; 2] {
        let (centre, half) = (self.point(0.5 * (low + high)), 0.5 * (high - low));
        let Mat3 { x_axis, y_axis, z_axis } = self.0.matrix3;
        let reach = x_axis.abs() * half.x + y_axis.abs() * half.y + z_axis.abs() * half.z;
        [centre - reach, centre + reach]
    }

    #[inline]
    fn cofactors(&self) -> [Vec3; 3] {
        let Mat3 { x_axis, y_axis, z_axis } = self.0.matrix3;
        [y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis)]
    }

    /// Returns the determinant of the linear part.
    #[inline]
    pub fn determinant(&self) -> f32 {
        let Mat3 { x_axis, y_axis, z_axis } = self.0.matrix3;
        x_axis.cross(y_axis).dot(z_axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    /// Placements that rotate, stretch, shear and mirror.
    fn placements() -> Vec<Placement> {
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 1.2);
        let at = Vec3::new(3.0, -4.0, 5.0);
        let of = |scale: Vec3| Placement(Affine3::from_scale_rotation_translation(scale, turn, at));
        let stretched = of(Vec3::new(0.5, 2.0, 3.0));
        let sheared = Placement(stretched.0 * Affine3::from_quat(turn));
        let mirrored = Placement(sheared.0 * Affine3::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
        vec![Placement::IDENTITY, of(Vec3::ONE), stretched, sheared, mirrored, of(Vec3::splat(-2.0))]
    }

    #[test]
    fn normals_stay_across_their_planes_and_outside() {
        let (a, b) = (Vec3::new(1.0, 0.3, -0.2), Vec3::new(-0.4, 1.0, 0.7));
        let normal = a.cross(b).normalize();
        for placement in placements() {
            let placed = placement.normal(normal);
            assert!(
                placed.dot(placement.vector(a)).abs() < 1e-5 && placed.dot(placement.vector(b)).abs() < 1e-5
            );
            assert!(placed.dot(placement.vector(normal)) > 0.0 && placed.is_normalized());
        }
        assert_eq!(Placement::IDENTITY.normal(Vec3::ZERO), Vec3::ZERO);
        let tiny = Placement(Affine3::from_scale(Vec3::splat(1e-18)));
        assert!((tiny.normal(normal) - normal).length() < 1e-6);
    }

    #[test]
    fn bitangents_follow_the_surface_through_mirrors() {
        let (u, v) = (Vec3::X, Vec3::Y);
        for placement in placements() {
            let tangent = placement.tangent(u.extend(1.0));
            let bitangent = placement.normal(Vec3::Z).cross(tangent.truncate()) * tangent.w;
            assert!(tangent.truncate().dot(placement.vector(u)) > 0.0);
            assert!(bitangent.dot(placement.vector(v)) > 0.0, "{placement:?}");
        }
    }

    #[test]
    fn boxes_hold_their_corners() {
        let corners = [Vec3::new(-1.0, 0.0, 2.0), Vec3::new(4.0, 0.5, 3.0)];
        for placement in placements() {
            let [low, high] = placement.bounds(corners);
            for i in 0..8 {
                let pick = |axis: usize| corners[i >> axis & 1][axis];
                let p = placement.point(Vec3::new(pick(0), pick(1), pick(2)));
                assert!((low - p).max_element() < 1e-5 && (p - high).max_element() < 1e-5);
            }
        }
    }
}
