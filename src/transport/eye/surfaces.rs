//! Surfaces of shading points in little memory.

use base::math::Rgb;
use glam::Vec3;
use rayon::prelude::*;
use world::material::{Bsdf, PackedBsdf};

/// Surface of a shading point: the data that shading reads besides the geometry.
#[derive(Clone, Copy, Debug)]
pub struct PointSurface<'w> {
    /// BSDF of the surface, without the lobes that the chain itself follows.
    pub bsdf: Bsdf<'w>,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
    /// Unit vector towards the eye, or towards the last mirror or glass before it.
    pub out: Vec3,
}

/// Surface with a packed BSDF: 48 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct PackedSurface<'w> {
    bsdf: PackedBsdf<'w>,
    geometric_normal: Vec3,
    out: Vec3,
}

/// Surfaces of shading points.
#[derive(Clone, Debug, Default)]
pub struct PointSurfaces<'w> {
    packed: Vec<PackedSurface<'w>>,
    /// Factors of the lobes of all surfaces.
    factors: Vec<Rgb>,
}

impl<'w> PointSurfaces<'w> {
    /// Adds a surface.
    #[inline]
    pub fn push(&mut self, surface: &PointSurface<'w>) {
        let PointSurface { bsdf, geometric_normal, out } = *surface;
        let bsdf = PackedBsdf::new(&bsdf, &mut self.factors);
        self.packed.push(PackedSurface { bsdf, geometric_normal, out });
    }

    /// Returns the surface of a point.
    #[inline]
    pub fn get(&self, point: usize) -> PointSurface<'w> {
        let PackedSurface { bsdf, geometric_normal, out } = self.packed[point];
        PointSurface { bsdf: bsdf.unpack(&self.factors), geometric_normal, out }
    }

    /// Returns the geometric normal of a point.
    #[inline]
    pub fn geometric_normal(&self, point: usize) -> Vec3 {
        self.packed[point].geometric_normal
    }

    /// Returns the number of the list of lobes that a point's material has.
    #[inline]
    pub fn lobe_list(&self, point: usize) -> u32 {
        self.packed[point].bsdf.lobe_list()
    }

    /// Maps all surfaces, on all threads.
    pub fn map<T: Send>(&self, value: impl Fn(&PointSurface<'w>) -> T + Sync) -> Vec<T> {
        (0..self.packed.len()).into_par_iter().map(|point| value(&self.get(point))).collect()
    }

    /// Returns true if a condition holds for any surface.
    pub fn any(&self, condition: impl Fn(&PointSurface<'w>) -> bool + Sync) -> bool {
        (0..self.packed.len()).into_par_iter().any(|point| condition(&self.get(point)))
    }

    /// Removes all surfaces and keeps the memory.
    pub fn clear(&mut self) {
        self.packed.clear();
        self.factors.clear();
    }

    /// Gives memory back that is not needed.
    pub fn shrink_to_fit(&mut self) {
        self.packed.shrink_to_fit();
        self.factors.shrink_to_fit();
    }

    /// Splits the surfaces into an array of constant size per surface, and the factors of their lobes.
    pub(super) fn into_parts(self) -> (Vec<PackedSurface<'w>>, Vec<Rgb>) {
        (self.packed, self.factors)
    }

    /// Joins what [`PointSurfaces::into_parts`] returned, in any order of surfaces.
    pub(super) fn from_parts(packed: Vec<PackedSurface<'w>>, factors: Vec<Rgb>) -> PointSurfaces<'w> {
        PointSurfaces { packed, factors }
    }
}

impl PackedSurface<'_> {
    /// Moves the surface behind `more` factors of other surfaces.
    pub(super) fn move_behind(&mut self, more: usize) {
        self.bsdf = self.bsdf.behind(more);
    }
}
