//! Shading points of one frame as targets of records.

use super::glossy::Glossy;
use crate::eye::{PointGeometry, PointSurface, ShadingPoints};
use base::kd_tree::KdTree;
use base::math::{Rgb, luminance};
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::PI;
use std::ops::Range;
use world::material::Bsdf;

/// Number of parts into which a range of points is divided to find its darkest one.
const PARTS: usize = 8;

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
