//! Orthonormal frames around a normal, without branches on the direction.
//!
//! Paper: Duff et al., *Building an Orthonormal Basis, Revisited*, JCGT 2017.

use glam::Vec3;

/// A right-handed orthonormal frame; local z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x in world space, unit length.
    pub tangent: Vec3,
    /// Local y in world space, unit length.
    pub bitangent: Vec3,
    /// Local z in world space, unit length.
    pub normal: Vec3,
}

impl Frame {
    /// Builds a frame whose z axis is the unit vector `normal`.
    #[inline]
    pub fn from_normal(normal: Vec3) -> Frame {
        let sign = 1.0f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Frame {
            tangent: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// Builds a frame whose z axis is the unit vector `normal`.
    ///
    /// The x axis is the component of `tangent` across the normal, or any vector across if that component is zero.
    #[inline]
    pub fn from_normal_and_tangent(normal: Vec3, tangent: Vec3) -> Frame {
        let across = tangent.normalize_or_zero();
        match (across - normal * normal.dot(across)).try_normalize() {
            Some(tangent) => Frame { tangent, bitangent: normal.cross(tangent), normal },
            None => Frame::from_normal(normal),
        }
    }

    /// Transforms a world-space vector to local coordinates.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }

    /// Transforms local coordinates to a world-space vector.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed_at_poles_and_between() {
        for n in [
            Vec3::Z,
            -Vec3::Z,
            Vec3::X,
            -Vec3::Y,
            Vec3::new(1e-4, -1e-4, -1.0).normalize(),
            Vec3::new(0.3, -0.5, 0.8).normalize(),
        ] {
            let f = Frame::from_normal(n);
            assert!((f.tangent.cross(f.bitangent) - n).length() < 1e-6, "{n}");
            assert!(f.tangent.dot(f.bitangent).abs() < 1e-6);
            assert!((f.tangent.length() - 1.0).abs() < 1e-6);
            let v = Vec3::new(0.2, 0.7, -0.4);
            assert!((f.to_world(f.to_local(v)) - v).length() < 1e-6);
        }
    }
}
