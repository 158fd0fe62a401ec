//! Shading points and visibility samples: points to be shaded, and their contributions to pixels.
//!
//! A shading point is shaded once; any number of visibility samples add its radiance to pixels. A shading
//! point does not depend on camera or pixels, so that points can be merged and records reused over views.
//!
//! Units: positions relative to the scene's centre; weights are per pixel (they include 1/spp).

use base::math::Rgb;
use glam::Vec3;
use std::ops::Range;
use world::Surface;
use world::material::Bsdf;

/// Geometry of a shading point, all that splatting reads of it: half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct PointGeometry {
    /// Position.
    pub position: Vec3,
    /// Root of the area that the pixel covers on the surface: the distance to the next point, about.
    pub spacing: f32,
    /// Unit shading normal on the side of the eye.
    pub normal: Vec3,
    /// Coat that light has to pass to reach the base (see [`Bsdf::coat`]); 0 for none.
    pub coat: u32,
}

/// Surface of a shading point: the data that shading reads beside the geometry.
#[derive(Clone, Copy, Debug)]
pub struct PointSurface<'w> {
    /// BSDF of the surface, without the lobes that the chain follows itself.
    pub bsdf: Bsdf<'w>,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
    /// Unit vector towards the eye, or towards the last mirror or glass before it.
    pub out: Vec3,
}

/// The shading point at a surface seen along `out`, where the next ray is `spacing` away on a surface that faces the
/// eye; `None` if it cannot be lit.
#[inline]
pub fn shading_point<'w>(
    surface: &Surface,
    bsdf: Bsdf<'w>,
    out: Vec3,
    spacing: f32,
) -> Option<(PointGeometry, PointSurface<'w>)> {
    let front = surface.frame.normal.dot(out) > 0.0;
    if !front && !bsdf.two_sided() {
        return None;
    }
    let normal = if front { surface.frame.normal } else { -surface.frame.normal };
    // Foreshortening is limited, so that grazing samples do not claim whole floors.
    let spacing = spacing / normal.dot(out).max(0.05).sqrt();
    let geometry = PointGeometry { position: surface.position, spacing, normal, coat: bsdf.coat() };
    let finite = surface.position.is_finite() && spacing.is_finite();
    finite.then_some((geometry, PointSurface { bsdf, geometric_normal: surface.normal, out }))
}

/// Points whose reflected radiance is wanted, as a structure of arrays.
#[derive(Clone, Debug, Default)]
pub struct ShadingPoints<'w> {
    /// Geometry by point.
    pub geometry: Vec<PointGeometry>,
    /// Surface by point.
    pub surfaces: Vec<PointSurface<'w>>,
}

impl ShadingPoints<'_> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.geometry.len()
    }
}

/// A share of a shading point's radiance that reaches a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilitySample {
    /// Pixel of the window, in rows.
    pub pixel: u32,
    /// Weight of the radiance leaving the point along its `out` in the pixel's colour.
    pub weight: Rgb,
}

/// The visibility samples of a frame, grouped by shading point, so that the point is implied: 16 bytes a sample and 4
/// a point.
///
/// They are in the order of points, not of pixels, because radiances are added to pixels as points are lit; the
/// order of those sums decides the last bits of a picture.
#[derive(Clone, Debug)]
pub struct VisibilitySamples {
    /// Index of each point's first sample, and at last the number of samples.
    first: Vec<u32>,
    samples: Vec<VisibilitySample>,
}

impl VisibilitySamples {
    /// One sample of each point, in the order of the points.
    pub fn one_each(samples: Vec<VisibilitySample>) -> VisibilitySamples {
        VisibilitySamples { first: (0..=samples.len() as u32).collect(), samples }
    }

    /// The samples of a shading point.
    #[inline]
    pub fn of(&self, point: usize) -> &[VisibilitySample] {
        &self.samples[self.range(point)]
    }

    #[inline]
    fn range(&self, point: usize) -> Range<usize> {
        self.first[point] as usize..self.first[point + 1] as usize
    }
}
