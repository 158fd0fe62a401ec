//! Cache record: irradiance at a point, its derivatives, and the footprint within which it is extrapolated.
//!
//! Paper: Herzog et al. 2009, section 5, Eqs. 5, 6, 11 and 12.
//! Units: irradiance in W/m², gradients in W/m³.
//!
//! Deviations: irradiance is stored as a vector instead of a scalar with a rotational gradient. The product of the
//! vector with a normal is exact until the horizon clips a light. The weight is 1/δ - 1, with δ = 1 at the footprint's
//! edge: Eq. 11 less its value there, so that it is continuous.

use super::footprint::Footprint;
use crate::eye::{PointGeometry, edge_class};
use crate::hsh::Radiance;
use crate::lights::Origin;
use base::math::{Rgb, luminance};
use glam::{Mat3, Vec3};
use serde::{Deserialize, Serialize};

/// Maximum angle between the normal of a record and the normal of a lit point, as √(1 - cos).
const NORMAL_TOLERANCE: f32 = 0.4;

/// Maximum ratio of the extrapolated luminance to the record's own, in either direction.
const EXTRAPOLATION: f32 = 3.0;

/// Lower bound of δ in weights, which limits the weight at the record itself.
const MIN_DELTA: f32 = 1e-3;

/// Irradiance of one layer around a point.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Record {
    /// Position.
    pub position: Vec3,
    /// Unit shading normal.
    pub normal: Vec3,
    /// Coat that the light has passed; 0 without a coat. The record lights only surfaces with the same coat.
    pub coat: u32,
    /// Class of the surfaces that the record lights (see [`edge_class`]).
    pub edge_class: u16,
    /// Bands of its series; 0 without a series. The record lights only surfaces that need no more bands.
    pub bands: u8,
    /// Region in which the record is used.
    pub footprint: Footprint,
    /// Irradiance vector per channel (column). Its product with a unit normal is the irradiance on a surface of that
    /// normal.
    pub vector: Mat3,
    /// Translational gradient of the irradiance per channel (column), in the tangent plane.
    pub gradient: Mat3,
    /// Luminance of the irradiance at `normal`.
    pub luminance: f32,
    /// Figures about its computation.
    pub diagnostics: Diagnostics,
}

/// Figures about a record that only statistics and inspection use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Diagnostics {
    /// Number of clusters in its cut, or of rays in its final gathering.
    pub cut: u32,
    /// Distance of the geometry that sends or blocks light.
    pub distance: f32,
    /// Luminance of the irradiance removed by clamping.
    pub clamped: f32,
    /// Luminance of the irradiance recovered by short rays.
    pub compensated: f32,
}

/// A record with its series, if the surface needs one.
pub struct NewRecord {
    /// Layer of the record.
    pub origin: Origin,
    /// Eye sample of the candidate.
    pub sample: u32,
    /// Record.
    pub record: Record,
    /// Radiance as a series with the bands of the candidate.
    pub series: Option<Radiance>,
}

impl Record {
    /// Returns the distance δ of a point in units of the footprint: 1 at its edge, infinite if the record does not
    /// apply. `bands` is the number of bands that the surface there needs.
    #[inline]
    pub fn delta(&self, p: &PointGeometry, bands: u8) -> f32 {
        let tilt = self.tilt(p);
        let is_alike = self.coat == u32::from(p.coat) && self.edge_class == edge_class(p.edges);
        if !(tilt < 1.0) || !is_alike || self.bands < bands {
            return f32::INFINITY;
        }
        self.footprint.scaled(p.position - self.position, self.normal).length() + tilt
    }

    /// Returns the part of δ due to the angle between the normals.
    #[inline]
    fn tilt(&self, p: &PointGeometry) -> f32 {
        (1.0 - self.normal.dot(p.normal)).max(0.0).sqrt() / NORMAL_TOLERANCE
    }

    /// Returns weight and extrapolated irradiance at a point, or `None` outside the footprint or if the extrapolation
    /// is rejected.
    #[inline]
    pub fn at(&self, p: &PointGeometry, bands: u8) -> Option<(f32, Rgb)> {
        let delta = self.delta(p, bands);
        if !(delta < 1.0) {
            return None;
        }
        let offset = p.position - self.position;
        let irradiance = self.vector.transpose() * p.normal + self.gradient.transpose() * offset;
        let y = luminance(irradiance);
        let believed = y * EXTRAPOLATION >= self.luminance && y <= EXTRAPOLATION * self.luminance;
        let weight = 1.0 / delta.max(MIN_DELTA) - 1.0;
        believed.then_some((weight, irradiance.max(Rgb::ZERO)))
    }

    /// Shrinks the footprint so that it ends at `p`, though not below `min_radius`. The axis is chosen that leaves the
    /// larger area. Returns true if the footprint became smaller.
    pub fn exclude(&mut self, p: &PointGeometry, min_radius: f32) -> bool {
        let edge = (1.0 - self.tilt(p)).max(0.0);
        let s = self.footprint.scaled(p.position - self.position, self.normal);
        let [r0, r1] = self.footprint.radii;
        // Radius along one axis that puts the point on the edge while the other radius is unchanged.
        let shrunk = |radius: f32, along: f32, across: f32| {
            let rest = edge * edge - across * across;
            if rest > 0.0 { radius * along.abs() / rest.sqrt() } else { 0.0 }
        };
        let new0 = shrunk(r0, s.x, (s.y * s.y + s.z * s.z).sqrt()).min(r0).max(min_radius);
        let new1 = shrunk(r1, s.y, (s.x * s.x + s.z * s.z).sqrt()).min(r1).max(min_radius);
        let radii = if new0 * r1 >= r0 * new1 { [new0.min(r0), r1] } else { [r0, new1.min(r1)] };
        let smaller = radii[0] * radii[1] < r0 * r1 * 0.999;
        self.footprint.radii = radii;
        smaller
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{point, record};
    use super::*;
    use std::f32::consts::TAU;

    /// Weight of a record with radii 2 and 1 at an offset from it.
    fn weight(offset: Vec3) -> Option<f32> {
        record(Vec3::ONE, [2.0, 1.0], Rgb::ONE).at(&point(Vec3::ONE + offset), 0).map(|(weight, _)| weight)
    }

    fn assert_near(a: f32, b: f32, tolerance: f32) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a} against {b}");
    }

    #[test]
    fn weights_fall_from_the_record_to_the_edge_as_in_equation_11() {
        assert_near(weight(Vec3::ZERO).unwrap(), 1.0 / MIN_DELTA - 1.0, 1e-6);
        for delta in [0.01f32, 0.25, 0.5, 0.9] {
            for angle in 0..8 {
                let (sin, cos) = (angle as f32 * TAU / 8.0).sin_cos();
                // On the surface, where the ellipse is 2 by 1, and above it, where it is a fifth of the smaller radius.
                let across = Vec3::new(2.0 * cos, sin, 0.0) * delta;
                let above = Vec3::new(2.0 * cos, 0.0, 0.2 * sin.abs()) * delta;
                for offset in [across, above] {
                    assert_near(weight(offset).unwrap(), 1.0 / delta - 1.0, 1e-4);
                }
            }
        }
        assert!(weight(Vec3::X * 1.999).unwrap() < 1e-3);
        assert_eq!((weight(Vec3::X * 2.001), weight(Vec3::Y * 1.001)), (None, None));
        assert_eq!(weight(Vec3::Z * 0.201), None);
    }

    #[test]
    fn weights_fall_with_the_angle_between_normals() {
        let record = record(Vec3::ZERO, [2.0, 1.0], Rgb::ONE);
        let tilted = |delta: f32| {
            // δ = (1 - cos)½ / tolerance
            let cos = 1.0 - (delta * NORMAL_TOLERANCE).powi(2);
            let normal = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            PointGeometry { normal, ..point(Vec3::ZERO) }
        };
        assert_near(record.delta(&tilted(0.5), 0), 0.5, 1e-4);
        let moved = PointGeometry { position: Vec3::Y * 0.3, ..tilted(0.5) };
        assert_near(record.at(&moved, 0).unwrap().0, 1.0 / 0.8 - 1.0, 1e-3);
        assert_eq!(record.delta(&tilted(1.01), 0), f32::INFINITY);
    }

    #[test]
    fn light_is_extrapolated_within_bounds() {
        let mut record = record(Vec3::ZERO, [2.0, 1.0], Rgb::new(1.0, 2.0, 4.0));
        record.vector.x_axis += Vec3::X * 0.5;
        record.gradient.y_axis = Vec3::new(0.25, -1.0, 0.0);
        let normal = Vec3::new(0.28, 0.0, 0.96);
        let at = PointGeometry { normal, ..point(Vec3::new(0.8, 0.2, 0.0)) };
        let (_, irradiance) = record.at(&at, 0).unwrap();
        let expected = Rgb::new(0.96 + 0.5 * 0.28, 2.0 * 0.96 + 0.25 * 0.8 - 0.2, 4.0 * 0.96);
        assert!((irradiance - expected).length() < 1e-5, "{irradiance} against {expected}");
        // The extrapolation is clamped to between a third of the record's own luminance and three times it.
        for (factor, believed) in [(2.98, true), (3.02, false), (0.34, true), (0.33, false)] {
            let change = (factor - 1.0) * record.luminance;
            record.gradient = Mat3::from_cols(Vec3::X, Vec3::X, Vec3::X) * change;
            record.vector.x_axis.x = 0.0;
            assert_eq!(record.at(&point(Vec3::X), 0).is_some(), believed, "{factor}");
        }
    }

    #[test]
    fn records_light_surfaces_of_their_coat_that_need_no_more_bands() {
        for (coat, bands) in (0..3).flat_map(|coat| (0..8).map(move |bands| (coat, bands))) {
            let record = Record { coat, bands, ..record(Vec3::ZERO, [2.0, 1.0], Rgb::ONE) };
            for (other, needed) in (0..3).flat_map(|coat| (0..8).map(move |bands| (coat, bands))) {
                let at = PointGeometry { coat: other, ..point(Vec3::X) };
                assert_eq!(record.at(&at, needed).is_some(), coat == u32::from(other) && bands >= needed);
            }
        }
    }

    #[test]
    fn footprints_end_where_they_are_to_and_keep_the_larger_area() {
        let cos = 0.99f32;
        let tilted = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        for normal in [Vec3::Z, tilted] {
            for angle in 0..16 {
                let (sin, cos) = (angle as f32 * TAU / 16.0 + 0.1).sin_cos();
                let at = PointGeometry { normal, ..point(Vec3::new(0.7 * cos, 0.4 * sin, 0.0)) };
                let mut shrunk = record(Vec3::ZERO, [2.0, 1.0], Rgb::ONE);
                assert!(shrunk.delta(&at, 0) < 1.0 && shrunk.exclude(&at, 0.0));
                assert_near(shrunk.delta(&at, 0), 1.0, 1e-4);
                // Bisection along each axis gives the expected area.
                let area = [0, 1].map(|axis| {
                    let (mut low, mut high) = (0.0, 1.0f32);
                    for _ in 0..40 {
                        let middle = 0.5 * (low + high);
                        let mut other = record(Vec3::ZERO, [2.0, 1.0], Rgb::ONE);
                        other.footprint.radii[axis] *= middle;
                        if other.delta(&at, 0) > 1.0 { low = middle } else { high = middle }
                    }
                    2.0 * low
                });
                let [a, b] = shrunk.footprint.radii;
                assert_near(a * b, area[0].max(area[1]), 1e-3);
            }
        }
    }

    #[test]
    fn footprints_do_not_shrink_below_the_least_radius_nor_for_points_outside() {
        let mut shrunk = record(Vec3::ZERO, [2.0, 1.0], Rgb::ONE);
        assert!(shrunk.exclude(&point(Vec3::X * 0.01), 0.3));
        assert_eq!(shrunk.footprint.radii, [2.0, 0.3]);
        assert!(!shrunk.exclude(&point(Vec3::X * 0.01), 0.3));
        assert!(!shrunk.exclude(&point(Vec3::Y * 1.01), 0.3));
        assert_eq!(shrunk.footprint.radii, [2.0, 0.3]);
    }
}
