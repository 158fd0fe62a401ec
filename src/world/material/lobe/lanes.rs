//! Data of a lobe in sixteen lanes.

use super::Directions;
use base::math::{F32x16, LANES, Rgb, Vec3x16, bits_of, lanes_in, mask_of};
use glam::Vec3;

/// Data of a lobe at sixteen points.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::material) struct LobeLanes {
    /// Factors; zero if nothing is reflected.
    pub scale: Vec3x16,
    /// Masking of `wo`, for lobes of facets.
    pub masking: F32x16,
}

/// Lobe at one point, seen from one direction on the side of the normal.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::material) struct SeenLobe {
    /// Factor on the value that depends on the direction alone.
    pub masking: f32,
    /// Factor on the density that depends on the direction alone, times the probability of the lobe.
    pub density: f32,
}

/// Values and densities in sixteen lanes.
#[derive(Clone, Copy, Debug)]
pub(in crate::material) struct ValuePdf16 {
    pub value: Vec3x16,
    pub pdf: F32x16,
}

/// Directions that lobes sampled, in sixteen lanes.
#[derive(Clone, Copy, Debug)]
pub(in crate::material) struct Sampled16 {
    pub wi: Vec3x16,
    /// Unit normals of the facets that reflect `wo` into `wi`.
    pub half: Vec3x16,
    /// Lanes that have a direction.
    pub found: u16,
}

impl ValuePdf16 {
    /// Zero in all lanes.
    pub const ZERO: ValuePdf16 = ValuePdf16 { value: Vec3x16::ZERO, pdf: [0.0; LANES] };

    /// Adds scale · reflectance · `weight` to the values, and `pdf` to the densities.
    #[inline(always)]
    pub(super) fn add(&mut self, scale: Rgb, reflectance: &Vec3x16, weight: &F32x16, pdf: &F32x16) {
        for l in 0..LANES {
            self.value.x[l] += scale.x * reflectance.x[l] * weight[l];
            self.value.y[l] += scale.y * reflectance.y[l] * weight[l];
            self.value.z[l] += scale.z * reflectance.z[l] * weight[l];
            self.pdf[l] += pdf[l];
        }
    }
}

impl Sampled16 {
    /// No directions.
    pub const NONE: Sampled16 = Sampled16 { wi: Vec3x16::ZERO, half: Vec3x16::ZERO, found: 0 };

    /// Sets the lanes of a mask to the reflections of `wo` on the facets `half`. Lanes whose reflection is below the
    /// surface have no direction.
    #[inline]
    pub(super) fn reflect(&mut self, wo: Vec3, half: &Vec3x16, mask: u16) {
        let mut wi = Vec3x16::ZERO;
        let mut above = [0; LANES];
        for l in 0..LANES {
            let h = half.get(l);
            let reflected = (2.0 * wo.dot(h)) * h - wo;
            wi.set(l, reflected);
            above[l] = u32::from(reflected.z > 0.0);
        }
        let bits = bits_of(mask);
        self.wi.blend(&bits, &wi);
        self.half.blend(&bits, half);
        self.found |= mask_of(&above) & mask;
    }

    /// Sets the lanes of a mask, one by one, to the directions that `sample` returns.
    #[inline]
    pub(super) fn one_by_one(&mut self, mask: u16, sample: impl Fn(usize) -> Option<Directions>) {
        for l in lanes_in(mask) {
            if let Some(directions) = sample(l) {
                self.wi.set(l, directions.wi);
                self.half.set(l, directions.half);
                self.found |= 1 << l;
            }
        }
    }
}

impl LobeLanes {
    /// Adds factor · reflectance · `weight` in all lanes.
    #[inline(always)]
    pub(super) fn add(&self, sum: &mut Vec3x16, reflectance: &Vec3x16, weight: &F32x16) {
        for l in 0..LANES {
            let value: Rgb = self.scale.get(l) * reflectance.get(l) * weight[l];
            sum.set(l, sum.get(l) + value);
        }
    }
}

/// Returns the mean of the channels.
#[inline]
pub(in crate::material) fn mean(c: Rgb) -> f32 {
    (c.x + c.y + c.z) * (1.0 / 3.0)
}
