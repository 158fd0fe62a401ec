//! Cones around the directions into which emitters emit.

use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, PI};

/// Directions into which a set of emitters emits: within the angle `emission` of normals that lie within `normals` of
/// the axis.
#[derive(Clone, Copy, Debug)]
pub struct EmissionCone {
    /// Unit axis of the normals.
    pub axis: Vec3,
    /// Maximum angle between the axis and a normal, radians; π for all directions.
    pub normals: f32,
    /// Maximum angle between a normal and emitted light, radians.
    pub emission: f32,
}

/// Returns the angle between unit vectors in radians. It is precise at small angles, unlike the arc cosine.
pub fn angle_between(a: Vec3, b: Vec3) -> f32 {
    a.cross(b).length().atan2(a.dot(b))
}

impl EmissionCone {
    /// All directions.
    pub const ALL: EmissionCone = EmissionCone { axis: Vec3::Z, normals: PI, emission: FRAC_PI_2 };

    /// Returns a cone around both cones (Conty Estevez & Kulla 2018, algorithm 1).
    pub fn union(&self, other: &EmissionCone) -> EmissionCone {
        let (a, b) = if self.normals >= other.normals { (self, other) } else { (other, self) };
        let emission = a.emission.max(b.emission);
        let between = angle_between(a.axis, b.axis);
        if (between + b.normals).min(PI) <= a.normals {
            return EmissionCone { emission, ..*a };
        }
        let normals = 0.5 * (a.normals + between + b.normals);
        let sideways = (b.axis - a.axis * a.axis.dot(b.axis)).normalize_or_zero();
        if normals >= PI || sideways == Vec3::ZERO {
            return EmissionCone { emission, ..EmissionCone::ALL };
        }
        let (sin, cos) = (normals - a.normals).sin_cos();
        EmissionCone { axis: (a.axis * cos + sideways * sin).normalize(), normals, emission }
    }

    /// Returns the measure of the directions, weighted by the cosine outside the cone of normals (ibid., section 4.1).
    pub fn measure(&self) -> f32 {
        let o = self.normals;
        let w = (o + self.emission).min(PI);
        let (sin_o, cos_o) = o.sin_cos();
        let rim = 2.0 * w * sin_o - (o - 2.0 * w).cos() - 2.0 * o * sin_o + cos_o;
        2.0 * PI * (1.0 - cos_o) + FRAC_PI_2 * rim
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::{Sampler, uniform_sphere};

    #[test]
    fn a_union_contains_both_and_is_no_wider_than_needed() {
        let mut sampler = Sampler::new(3, 0);
        for _ in 0..1000 {
            let mut cone = || EmissionCone {
                axis: uniform_sphere(sampler.next_2d()),
                normals: sampler.next_1d() * 1.5,
                emission: FRAC_PI_2,
            };
            let (a, b) = (cone(), cone());
            let union = a.union(&b);
            for part in [a, b] {
                assert!(angle_between(union.axis, part.axis) + part.normals <= union.normals + 1e-5);
            }
            let needed = 0.5 * (a.normals + b.normals + angle_between(a.axis, b.axis));
            let needed = needed.max(a.normals).max(b.normals);
            assert!(union.normals <= needed + 1e-5 || union.normals == PI);
        }
    }

    #[test]
    fn measures_of_a_flat_emitter_a_hemisphere_of_normals_and_all_directions() {
        let cone = |normals| EmissionCone { axis: Vec3::X, normals, emission: FRAC_PI_2 };
        assert!((cone(0.0).measure() - PI).abs() < 1e-5);
        assert!((cone(PI).measure() - 4.0 * PI).abs() < 1e-5);
        assert!(cone(1.0).measure() > PI && cone(1.0).measure() < 4.0 * PI);
    }
}
