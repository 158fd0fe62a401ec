//! Materials at many points in little memory: the factors of their lobes are in one array, and normals behind them.
//!
//! Most materials have no lobe or one. Slots for all lobes would take three quarters of a material at a point.

use super::lobe::MAX_LOBES;
use super::model::{Bsdf, Model};
use base::math::Rgb;

/// Material at one point, without the factors of its lobes: 24 bytes.
#[derive(Clone, Copy, Debug)]
pub struct PackedBsdf<'m> {
    model: &'m Model,
    base: Rgb,
    /// Index of the first factor.
    first: u32,
}

impl<'m> PackedBsdf<'m> {
    /// Packs a material, and appends the factors of its lobes to `factors`.
    #[inline]
    pub fn new(bsdf: &Bsdf<'m>, factors: &mut Vec<Rgb>) -> PackedBsdf<'m> {
        let (used, beyond) = bsdf.scales.split_at(bsdf.model.lobes.len());
        debug_assert!(beyond.iter().all(|scale| *scale == Rgb::ZERO));
        let first = factors.len() as u32;
        factors.extend_from_slice(used);
        factors.extend(bsdf.model.shadows.then_some(bsdf.level_normal));
        PackedBsdf { model: bsdf.model, base: bsdf.base, first }
    }

    /// Returns the material, with factors from the array that it was packed with.
    #[inline]
    pub fn unpack(&self, factors: &[Rgb]) -> Bsdf<'m> {
        let mut scales = [Rgb::ZERO; MAX_LOBES];
        let (first, count) = (self.first as usize, self.model.lobes.len());
        let level_normal = if self.model.shadows { factors[first + count] } else { Rgb::Z };
        scales[..count].copy_from_slice(&factors[first..first + count]);
        Bsdf { model: self.model, base: self.base, scales, level_normal }
    }

    /// Returns the number of its list of lobes. Materials with the same number differ in factors only.
    #[inline]
    pub fn lobe_list(&self) -> u32 {
        self.model.lobe_list
    }

    /// Returns the packed material for an array with `more` factors before its own.
    #[inline]
    pub fn behind(self, more: usize) -> PackedBsdf<'m> {
        PackedBsdf { first: self.first + more as u32, ..self }
    }
}
