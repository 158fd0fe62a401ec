//! The shading points of one frame, as far as records light them.

use super::series::Glossy;
use crate::eye::{EyeIndex, PointGeometry, ShadingPoints};
use crate::math::Rgb;
use std::ops::Range;

/// Shading points that records are splatted onto.
pub struct Targets<'a> {
    /// The points, in the order of the index.
    pub points: &'a ShadingPoints<'a>,
    /// The hierarchy over them.
    pub index: &'a EyeIndex,
    /// Lobes that series light, if there are any.
    pub glossy: Option<&'a Glossy>,
    /// Bands of the series that each point needs; 0 where irradiance is enough.
    pub bands: Vec<u8>,
    /// True if records can light the point: it has a base, or a lobe broad enough for a series.
    pub cacheable: Vec<bool>,
}

impl<'a> Targets<'a> {
    /// All `points`; lobes are lit by series where `glossy` has enough bands for them.
    pub fn new(points: &'a ShadingPoints, index: &'a EyeIndex, glossy: Option<&'a Glossy>) -> Targets<'a> {
        let bands = |surface| glossy.map_or(0, |glossy: &Glossy| glossy.bands(surface));
        let bands: Vec<u8> = points.surfaces.iter().map(bands).collect();
        let cacheable = points
            .surfaces
            .iter()
            .zip(&bands)
            .map(|(surface, &bands)| bands > 0 || surface.bsdf.split_base(1.0).0 != Rgb::ZERO)
            .collect();
        Targets { points, index, glossy, bands, cacheable }
    }

    /// Geometry of a range of points, and the bands that they need.
    #[inline]
    pub fn geometry(&self, range: Range<usize>) -> impl Iterator<Item = (&PointGeometry, u8)> {
        self.points.geometry[range.clone()].iter().zip(self.bands[range].iter().copied())
    }
}
