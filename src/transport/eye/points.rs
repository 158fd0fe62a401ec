//! Shading points, and the visibility samples that carry their radiance to pixels.
//!
//! A shading point is shaded once; any number of visibility samples add its radiance to pixels. A shading point does
//! not depend on camera or pixels, so that points can be merged and records can be reused for other views.
//!
//! Units: positions relative to the scene's centre; weights per pixel (they include 1/spp).

use super::surfaces::{PointSurface, PointSurfaces};
use base::math::Rgb;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;
use world::Surface;
use world::material::Bsdf;

/// Geometry of a shading point: all data that splatting reads, in half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct PointGeometry {
    /// Position.
    pub position: Vec3,
    /// Root of the area that the pixel covers on the surface: the approximate distance to the next point.
    pub spacing: f32,
    /// Unit shading normal on the side of the eye.
    pub normal: Vec3,
    /// Coat that light has to pass to reach the base (see [`Bsdf::coat`]); 0 without a coat. Coats beyond the largest
    /// number count as one.
    pub coat: u8,
    /// True if the eye sees the point by mirrors, glass or sharp lobes, or through gaps.
    pub is_chained: bool,
    /// Maximum number of edges that light may take to the point; `u16::MAX` if light passes no sheets.
    pub edges: u16,
}

/// Number of edges from which on a limit hardly matters.
const MANY_EDGES: u16 = 16;

/// Returns the class of points to which light may take `edges` edges. Points of one class may share light.
#[inline]
pub fn edge_class(edges: u16) -> u16 {
    edges.min(MANY_EDGES)
}

/// Returns the shading point at a surface seen along `out`, or `None` if it cannot be lit. `spacing` is the distance
/// to the next ray on a surface that faces the eye. Light may take at most `edges` edges to the point.
#[inline]
pub fn shading_point<'w>(
    surface: &Surface,
    bsdf: Bsdf<'w>,
    out: Vec3,
    spacing: f32,
    edges: u32,
) -> Option<(PointGeometry, PointSurface<'w>)> {
    let front = surface.frame.normal.dot(out) > 0.0;
    if !front && !bsdf.two_sided() {
        return None;
    }
    let normal = if front { surface.frame.normal } else { -surface.frame.normal };
    // Foreshortening is limited, so that grazing samples do not stand for whole floors.
    let spacing = spacing / normal.dot(out).max(0.05).sqrt();
    let coat = u8::try_from(bsdf.coat()).unwrap_or(u8::MAX);
    let edges = u16::try_from(edges).unwrap_or(u16::MAX);
    let geometry =
        PointGeometry { position: surface.position, spacing, normal, coat, is_chained: false, edges };
    let finite = surface.position.is_finite() && spacing.is_finite();
    finite.then_some((geometry, PointSurface { bsdf, geometric_normal: surface.normal, out }))
}

/// Points whose reflected radiance is needed, as a structure of arrays.
#[derive(Clone, Debug, Default)]
pub struct ShadingPoints<'w> {
    /// Geometry per point.
    pub geometry: Vec<PointGeometry>,
    /// Surface per point.
    pub surfaces: PointSurfaces<'w>,
}

impl ShadingPoints<'_> {
    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.geometry.len()
    }
}

/// Share of a shading point's radiance that reaches a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilitySample {
    /// Index of the pixel in the window, in rows.
    pub pixel: u32,
    /// Weight, in the pixel's colour, of the radiance leaving the point along its `out`.
    pub weight: Rgb,
}

/// Visibility samples of a frame, grouped by shading point, so that the point is implied: 16 bytes per sample and 4
/// per point.
///
/// The samples are in the order of points, not of pixels, because radiances are added to pixels as points are lit. The
/// order of those sums determines the last bits of an image.
#[derive(Clone, Debug)]
pub struct VisibilitySamples {
    /// Index of each point's first sample, followed by the number of samples.
    first: Vec<u32>,
    samples: Vec<VisibilitySample>,
}

impl VisibilitySamples {
    /// Returns one sample per point, in the order of the points.
    pub fn one_each(samples: Vec<VisibilitySample>) -> VisibilitySamples {
        VisibilitySamples { first: (0..=samples.len() as u32).into_par_iter().collect(), samples }
    }

    /// Returns the samples of a shading point.
    #[inline]
    pub fn at_point(&self, point: usize) -> &[VisibilitySample] {
        &self.samples[self.range(point)]
    }

    #[inline]
    fn range(&self, point: usize) -> Range<usize> {
        self.first[point] as usize..self.first[point + 1] as usize
    }
}
