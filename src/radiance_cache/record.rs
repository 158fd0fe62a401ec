//! A cache record: irradiance at a point, how it changes nearby, and the footprint within which that is believed.
//!
//! Paper: Herzog et al. 2009, section 5, Eqs. 5, 6, 11 and 12.
//! Units: irradiance in W/m², gradients in W/m³.
//!
//! Deviations: the irradiance is kept as a vector, whose product with a normal is exact for every normal until the
//! horizon clips a light, and which stands for the rotational gradient. The weight 1/δ - 1 (δ = 1 at the
//! footprint's edge) is that of Eq. 11 less its value there, so that it does not jump.

use super::footprint::Footprint;
use crate::eye::{PointGeometry, Sharing};
use crate::math::{Rgb, luminance};
use glam::{Mat3, Vec3};

/// A point this much behind the plane of a record, by the sine of the angle, is not lit by it.
const BEHIND: f32 = 0.1;

/// Extrapolated luminance more than this factor from the record's own is not believed.
const EXTRAPOLATION: f32 = 3.0;

/// Least δ, which limits the weight at the record itself.
const LEAST_DELTA: f32 = 1e-3;

/// Irradiance of one layer around a point.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// Where.
    pub position: Vec3,
    /// Unit shading normal.
    pub normal: Vec3,
    /// Samples that it can light.
    pub sharing: Sharing,
    /// The footprint.
    pub footprint: Footprint,
    /// Per channel (column): the vector whose product with a unit normal is the irradiance on a surface of that
    /// normal.
    pub vector: Mat3,
    /// Per channel (column): translational gradient of the irradiance, in the tangent plane.
    pub gradient: Mat3,
    /// Luminance of the irradiance at `normal`.
    pub luminance: f32,
    /// How it came about.
    pub facts: Facts,
}

/// What only statistics and inspection read of a record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facts {
    /// The eye sample it was computed at.
    pub sample: u32,
    /// Clusters in its cut, or rays of its gathering.
    pub cut: u32,
    /// Distance of what casts light and shadow.
    pub distance: f32,
    /// Luminance of the irradiance that clamping took away.
    pub clamped: f32,
    /// Luminance of the irradiance that short rays gave back.
    pub compensated: f32,
}

impl Record {
    /// Distance δ of a point in units of the footprint: 1 at its edge; infinite where the record does not apply at
    /// all.
    #[inline]
    pub fn delta(&self, p: &PointGeometry) -> f32 {
        let offset = p.position - self.position;
        let cos = self.normal.dot(p.normal);
        let tilt = (1.0 - cos).max(0.0).sqrt() * self.footprint.inverse_normal_tolerance;
        if !(tilt < 1.0) || !self.sharing.serves(p.sharing) {
            return f32::INFINITY;
        }
        let delta = self.footprint.scaled(offset, self.normal).length() + tilt;
        let behind = 0.5 * offset.dot(self.normal + p.normal) < -BEHIND * offset.length();
        if behind && delta > LEAST_DELTA { f32::INFINITY } else { delta }
    }

    /// Weight and extrapolated irradiance at a point, or `None` outside the footprint or where it is not believed.
    #[inline]
    pub fn at(&self, p: &PointGeometry) -> Option<(f32, Rgb)> {
        let delta = self.delta(p);
        if !(delta < 1.0) {
            return None;
        }
        let offset = p.position - self.position;
        let irradiance = self.vector.transpose() * p.normal + self.gradient.transpose() * offset;
        let y = luminance(irradiance);
        let believed = y * EXTRAPOLATION >= self.luminance && y <= EXTRAPOLATION * self.luminance;
        let weight = 1.0 / delta.max(LEAST_DELTA) - 1.0;
        believed.then_some((weight, irradiance.max(Rgb::ZERO)))
    }

    /// Shrinks the footprint so that it ends at `p`, along the axis that leaves it the larger area, though not
    /// below `least`. True if it became smaller.
    pub fn exclude(&mut self, p: &PointGeometry, least: f32) -> bool {
        let tilt =
            (1.0 - self.normal.dot(p.normal)).max(0.0).sqrt() * self.footprint.inverse_normal_tolerance;
        let edge = (1.0 - tilt).max(0.0);
        let offset = p.position - self.position;
        let s = self.footprint.scaled(offset, self.normal);
        let [r0, r1] = self.footprint.radii;
        // The radius along one axis at which the point is on the edge, the other radius unchanged.
        let shrunk = |radius: f32, along: f32, across: f32| {
            let rest = edge * edge - across * across;
            if rest > 0.0 { radius * along.abs() / rest.sqrt() } else { 0.0 }
        };
        let new0 = shrunk(r0, s.x, (s.y * s.y + s.z * s.z).sqrt()).min(r0).max(least);
        let new1 = shrunk(r1, s.y, (s.x * s.x + s.z * s.z).sqrt()).min(r1).max(least);
        let radii = if new0 * r1 >= r0 * new1 { [new0.min(r0), r1] } else { [r0, new1.min(r1)] };
        let smaller = radii[0] * radii[1] < r0 * r1 * 0.999;
        self.footprint.radii = radii;
        smaller
    }
}
