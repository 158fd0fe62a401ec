//! The shading points of one frame, as far as records light them.

use super::series::Glossy;
use crate::eye::{PointGeometry, ShadingPoints};
use crate::kd_tree::KdTree;
use crate::math::{Rgb, luminance};
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::PI;
use std::ops::Range;

/// Parts of a range of points of which the darkest counts.
const PARTS: usize = 8;

/// Shading points that records are splatted onto.
pub struct Targets<'a> {
    /// The points, in the order of the index.
    pub points: &'a ShadingPoints<'a>,
    /// The hierarchy over them.
    pub index: &'a KdTree,
    /// Lobes that series light, if there are any.
    pub glossy: Option<&'a Glossy>,
    /// Bands of the series that each point needs; 0 where irradiance is enough.
    pub bands: Vec<u8>,
    /// True if records can light the point: it has a base, or a lobe broad enough for a series.
    pub cacheable: Vec<bool>,
    /// Luminance of the irradiance that gives each point the light which is known besides; empty if none is.
    known: Vec<f32>,
    /// Difference of luminance that is seen at each point, where it is known: of irradiance, or on glossy surfaces that
    /// series light of radiance. Empty if none is known.
    visible: Vec<Option<f32>>,
}

impl<'a> Targets<'a> {
    /// All `points`; lobes are lit by series where `glossy` has enough bands for them.
    pub fn new(points: &'a ShadingPoints, index: &'a KdTree, glossy: Option<&'a Glossy>) -> Targets<'a> {
        let bands = |surface| glossy.map_or(0, |glossy: &Glossy| glossy.bands(surface));
        let bands: Vec<u8> = points.surfaces.iter().map(bands).collect();
        let cacheable = points
            .surfaces
            .iter()
            .zip(&bands)
            .map(|(surface, &bands)| bands > 0 || surface.bsdf.split_base(1.0).0 != Rgb::ZERO)
            .collect();
        Targets { points, index, glossy, bands, cacheable, known: Vec::new(), visible: Vec::new() }
    }

    /// The same, where light of these luminances is reflected besides: records' errors are judged against the whole.
    pub fn with_known(mut self, luminance_of: impl Fn(usize) -> f32 + Sync) -> Targets<'a> {
        let irradiance = |point: usize| {
            let irradiance = self.irradiance(point, luminance_of(point));
            if irradiance < f32::INFINITY { irradiance } else { 0.0 }
        };
        self.known = (0..self.points.len()).into_par_iter().map(irradiance).collect();
        self
    }

    /// The same, where so great differences of the luminance of radiance are seen; `None` where that is not known.
    pub fn with_visible(mut self, difference_at: impl Fn(Vec3) -> Option<f32> + Sync) -> Targets<'a> {
        let visible = |point: usize| {
            let difference = difference_at(self.points.geometry[point].position)?;
            let is_glossy = self.glossy_point(point).is_some();
            let limit = if is_glossy { difference } else { self.irradiance(point, difference) };
            limit.is_finite().then_some(limit)
        };
        self.visible = (0..self.points.len()).into_par_iter().map(visible).collect();
        self
    }

    /// Difference of luminance that is seen at a point, if it is known.
    #[inline]
    pub fn visible(&self, point: usize) -> Option<f32> {
        self.visible.get(point).copied().flatten()
    }

    /// Luminance of the irradiance of which a point reflects radiance of this luminance.
    fn irradiance(&self, point: usize, radiance: f32) -> f32 {
        let surface = &self.points.surfaces[point];
        let cos = surface.out.dot(self.points.geometry[point].normal);
        PI * radiance / luminance(surface.bsdf.albedo_at(cos))
    }

    /// Least of the mean irradiances known in the parts of a range.
    pub fn least_known(&self, range: Range<usize>) -> f32 {
        let Some(known) = self.known.get(range).filter(|known| !known.is_empty()) else { return 0.0 };
        let mean = |part: &[f32]| part.iter().sum::<f32>() / part.len() as f32;
        known.chunks(known.len().div_ceil(PARTS)).map(mean).fold(f32::INFINITY, f32::min)
    }

    /// Geometry of a range of points, and the bands that they need.
    #[inline]
    pub fn geometry(&self, range: Range<usize>) -> impl Iterator<Item = (&PointGeometry, u8)> {
        self.points.geometry[range.clone()].iter().zip(self.bands[range].iter().copied())
    }
}
