//! Shading points of one frame as targets of records.

use super::glossy::Glossy;
use crate::eye::{PointGeometry, PointSurface, ShadingPoints};
use base::kd_tree::KdTree;
use base::math::{Rgb, luminance};
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::PI;
use std::ops::Range;
use world::SurfacePoint;
use world::material::Bsdf;

/// Number of parts into which a range of points is divided to find its darkest one.
const PARTS: usize = 8;

/// Minimum sine of the angle above a surface at which a point rises from it.
const RISE: f32 = 0.05;

/// Shading points that records are splatted onto.
pub struct Targets<'a> {
    /// Points, in the order of the index.
    pub points: &'a ShadingPoints<'a>,
    /// Hierarchy over the points.
    pub index: &'a KdTree,
    /// Lobes that series light, if there are any.
    pub glossy: Option<&'a Glossy>,
    /// Bands of the series that each point needs; 0 if irradiance is enough.
    pub bands: Vec<u8>,
    /// True if records can light the point: it has a base, or a lobe broad enough for a series.
    pub cacheable: Vec<bool>,
    /// Known light per point, expressed as the luminance of irradiance; empty if none is known.
    baseline: Vec<f32>,
    /// Just visible difference of luminance per point, if known: of radiance on glossy surfaces lit by series, of
    /// irradiance elsewhere. Empty if unknown for all points.
    visible: Vec<Option<f32>>,
}

impl<'a> Targets<'a> {
    /// Returns targets for all `points`. Series light a lobe if `glossy` has enough bands for it.
    pub fn new(points: &'a ShadingPoints, index: &'a KdTree, glossy: Option<&'a Glossy>) -> Targets<'a> {
        let of_surface = |surface: &PointSurface| {
            let bands = glossy.map_or(0, |glossy: &Glossy| glossy.bands(surface));
            (bands, bands > 0 || surface.bsdf.split_base(1.0).0 != Rgb::ZERO)
        };
        let (bands, cacheable) = points.surfaces.map(of_surface).into_iter().unzip();
        Targets { points, index, glossy, bands, cacheable, baseline: Vec::new(), visible: Vec::new() }
    }

    /// Sets the luminance that each point reflects from other sources. Errors of records are judged relative to all
    /// light.
    pub fn with_baseline(mut self, luminance_of: impl Fn(usize) -> f32 + Sync) -> Targets<'a> {
        let irradiance = |point: usize| {
            let irradiance = self.irradiance(point, luminance_of(point));
            if irradiance < f32::INFINITY { irradiance } else { 0.0 }
        };
        self.baseline = (0..self.points.len()).into_par_iter().map(irradiance).collect();
        self
    }

    /// Sets the just visible difference of luminance at each position; `None` if it is unknown there.
    pub fn with_visible(mut self, difference_at: impl Fn(Vec3) -> Option<f32> + Sync) -> Targets<'a> {
        let visible = |point: usize| {
            let difference = difference_at(self.points.geometry[point].position)?;
            let is_glossy = self.split_for_series(point).is_some();
            let limit = if is_glossy { difference } else { self.irradiance(point, difference) };
            limit.is_finite().then_some(limit)
        };
        self.visible = (0..self.points.len()).into_par_iter().map(visible).collect();
        self
    }

    /// Returns the distance, up to `reach`, from a point of surface to the nearest target that rises from the surface;
    /// infinite if there is none. Points of the same curved surface do not rise from it.
    pub fn clearance(&self, from: &SurfacePoint, reach: f32) -> f32 {
        let (mut nearest, mut nearest_sq) = (f32::INFINITY, reach * reach);
        self.index.leaves_near(from.position, reach, |leaf| {
            for point in &self.points.geometry[self.index.leaf(leaf)] {
                let offset = point.position - from.position;
                let distance_sq = offset.length_squared();
                if !(distance_sq < nearest_sq) {
                    continue;
                }
                // A chord of an arc rises from the tangent plane at its end, but not from the one at its middle.
                let height = offset.dot(from.normal).min(0.5 * offset.dot(from.normal + point.normal));
                let distance = distance_sq.sqrt();
                if height > RISE * distance {
                    (nearest, nearest_sq) = (distance, distance_sq);
                }
            }
        });
        nearest
    }

    /// Returns the just visible difference of luminance at a point, if known.
    #[inline]
    pub fn visible(&self, point: usize) -> Option<f32> {
        self.visible.get(point).copied().flatten()
    }

    /// Splits the BSDF of a point into its base and its lobe, if series light the lobe; `None` otherwise.
    pub fn split_for_series(&self, point: usize) -> Option<(Rgb, Bsdf<'_>)> {
        self.glossy.filter(|_| self.bands[point] > 0)?;
        let surface = self.points.surfaces.get(point);
        let (base, lobe) = surface.bsdf.split_base(surface.out.dot(self.points.geometry[point].normal));
        Some((base, lobe?))
    }

    /// Returns the luminance of the irradiance of which a point reflects the luminance `radiance`.
    fn irradiance(&self, point: usize, radiance: f32) -> f32 {
        let surface = self.points.surfaces.get(point);
        let cos = surface.out.dot(self.points.geometry[point].normal);
        PI * radiance / luminance(surface.bsdf.albedo_at(cos))
    }

    /// Divides a range of points into parts and returns the least of the parts' mean known irradiances.
    ///
    /// Points that the eye sees by mirrors give little of their pixels' light, so that they allow large errors. They
    /// count only where no other points are, by the mean error relative to their pixels.
    pub fn darkest_baseline(&self, range: Range<usize>) -> f32 {
        let Some(baseline) = self.baseline.get(range.clone()).filter(|baseline| !baseline.is_empty()) else {
            return 0.0;
        };
        let length = baseline.len().div_ceil(PARTS);
        let points = self.points.geometry[range].chunks(length);
        let mean = |(part, points): (&[f32], &[PointGeometry])| {
            let (mut sum, mut count) = (0.0, 0.0);
            for (known, _) in part.iter().zip(points).filter(|(_, point)| !point.is_chained) {
                sum += known;
                count += 1.0;
            }
            match count > 0.0 {
                true => sum / count,
                false => part.len() as f32 / part.iter().map(|known| known.recip()).sum::<f32>(),
            }
        };
        baseline.chunks(length).zip(points).map(mean).fold(f32::INFINITY, f32::min)
    }

    /// Iterates over the geometry of a range of points and the bands that they need.
    #[inline]
    pub fn geometry(&self, range: Range<usize>) -> impl Iterator<Item = (&PointGeometry, u8)> {
        self.points.geometry[range.clone()].iter().zip(self.bands[range].iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::Floor;
    use super::*;

    fn clearance(positions: &[Vec3], normals: impl Fn(Vec3) -> Vec3, from: Vec3, reach: f32) -> f32 {
        let mut floor = Floor::new(positions);
        for point in &mut floor.points.geometry {
            point.normal = normals(point.position);
        }
        let normal = normals(from);
        floor.targets().clearance(&SurfacePoint { position: from, normal, geometric_normal: normal }, reach)
    }

    #[test]
    fn a_ledge_is_near_and_neither_the_floor_nor_what_lies_deeper_is() {
        let grid = (0..1024).map(|i| Vec3::new((i % 32) as f32, (i / 32) as f32, 0.0) / 32.0);
        let raised =
            |by: f32| grid.clone().map(|p| p + Vec3::Z * if p.x < 0.25 { by } else { 0.0 }).collect();
        let from = Vec3::new(0.5, 0.5, 0.0);
        let of = |points: Vec<Vec3>, reach| clearance(&points, |_| Vec3::Z, from, reach);
        // The last column of the ledge is at 7/32.
        let distance = Vec3::new(9.0 / 32.0, 0.0, 0.05).length();
        assert!((of(raised(0.05), 1.0) - distance).abs() < 1e-6);
        for (by, reach) in [(0.05, 0.25), (0.0, 1.0), (-0.05, 1.0)] {
            assert_eq!(of(raised(by), reach), f32::INFINITY, "{by} {reach}");
        }
    }

    #[test]
    fn a_hollow_does_not_rise_from_itself() {
        let at = |angle: f32| Vec3::new(angle.sin(), 0.0, 1.0 - angle.cos());
        let points: Vec<Vec3> = (-20..=20).map(|i| at(0.05 * i as f32)).collect();
        let centre = Vec3::Z;
        let inwards = |p: Vec3| (centre - p).normalize();
        assert_eq!(clearance(&points, inwards, at(0.0), 10.0), f32::INFINITY);
        assert!(clearance(&points, |_| Vec3::Z, at(0.0), 10.0) < 0.2);
    }
}
