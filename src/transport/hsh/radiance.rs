//! Radiance that arrives at a point, as a series with its derivatives along the surface, and its reflection.
//!
//! Units: radiance; derivatives are per unit of length of the scene.

#[cfg(test)]
use super::basis::index;
use super::basis::{CHANNELS, MAX_BANDS, MAX_FUNCTIONS};
use super::kernel::Kernel;
use base::math::{LANES, Rgb, f32x16};
use serde::{Deserialize, Serialize};

/// Number of blocks: value and two derivatives, each by channel.
pub(super) const BLOCKS: usize = 3 * CHANNELS;

/// Radiance over the hemisphere, and its derivatives as the receiver moves along u and v.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Radiance {
    bands: u8,
    /// Coefficients of the value by channel, then of the derivatives along u and along v. Each block is padded with
    /// zeros to a multiple of the vectors' width.
    coefficients: Box<[f32]>,
}

/// Radiance that leaves a surface in one direction, and its derivatives as the receiver moves along u and v. It may be
/// negative, since the series is truncated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reflected {
    /// Value at the record.
    pub value: Rgb,
    /// Derivatives along u and v.
    pub gradient: [Rgb; 2],
}

#[cfg(test)]
impl Reflected {
    /// Extrapolates by motion along the tangents; negative values are clamped to 0.
    #[cfg(test)]
    pub fn at(&self, along_u: f32, along_v: f32) -> Rgb {
        (self.value + self.gradient[0] * along_u + self.gradient[1] * along_v).max(Rgb::ZERO)
    }
}

/// Number of floats in a block.
#[inline]
pub(super) const fn stride(bands: usize) -> usize {
    (bands * bands).next_multiple_of(LANES)
}

impl Radiance {
    /// Creates a series without light.
    pub fn black(bands: usize) -> Radiance {
        let bands = bands.clamp(1, MAX_BANDS);
        Radiance { bands: bands as u8, coefficients: vec![0.0; BLOCKS * stride(bands)].into() }
    }

    /// True if the number of coefficients fits the number of bands. It may not if the series was read from damaged
    /// bytes.
    pub fn is_sound(&self) -> bool {
        (1..=MAX_BANDS).contains(&self.bands()) && self.coefficients.len() == BLOCKS * stride(self.bands())
    }

    /// Heap memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.coefficients)
    }

    /// Number of bands of the series.
    pub fn bands(&self) -> usize {
        usize::from(self.bands)
    }

    /// Returns the light without change along the surface.
    pub fn without_gradients(mut self) -> Radiance {
        let values = CHANNELS * stride(self.bands());
        self.coefficients[values..].fill(0.0);
        self
    }

    #[inline]
    pub(super) fn set(&mut self, block: usize, k: usize, coefficient: f32) {
        self.coefficients[block * stride(self.bands()) + k] = coefficient;
    }

    #[cfg(test)]
    fn get(&self, block: usize, k: usize) -> f32 {
        self.coefficients[block * stride(self.bands()) + k]
    }

    /// Coefficient `k` of the radiance.
    #[cfg(test)]
    pub(super) fn coefficient(&self, k: usize) -> Rgb {
        self.part(0, k)
    }

    /// Coefficient `k` of the derivatives along u and v.
    #[cfg(test)]
    pub(super) fn derivatives(&self, k: usize) -> [Rgb; 2] {
        [self.part(1, k), self.part(2, k)]
    }

    #[cfg(test)]
    fn part(&self, part: usize, k: usize) -> Rgb {
        let [r, g, b] = std::array::from_fn(|c| self.get(part * CHANNELS + c, k));
        Rgb::new(r, g, b)
    }

    /// Returns the radiance reflected in the outgoing direction of the kernel, in the smaller number of bands of kernel
    /// and radiance.
    #[inline]
    pub fn reflected(&self, kernel: &Kernel) -> Reflected {
        let stride = stride(self.bands());
        let mut sums = [Rgb::ZERO; 3];
        for c in 0..CHANNELS {
            let kernel = &kernel.coefficients[c][..stride];
            for (part, sum) in sums.iter_mut().enumerate() {
                let start = (part * CHANNELS + c) * stride;
                sum[c] = dot(&self.coefficients[start..start + stride], kernel);
            }
        }
        let [value, along_u, along_v] = sums;
        Reflected { value, gradient: [along_u, along_v] }
    }

    /// Returns the irradiance, which two bands hold exactly.
    #[cfg(test)]
    pub fn irradiance(&self) -> Reflected {
        self.reflected(&Kernel::cosine(self.bands()))
    }

    /// Returns the light in a frame whose tangents are turned by `angle` about the normal, from u towards v.
    #[cfg(test)]
    pub fn turned(&self, angle: f32) -> Radiance {
        let mut turned = self.clone();
        for block in 0..BLOCKS {
            for m in 1..self.bands() {
                let (sin, cos) = (m as f32 * angle).sin_cos();
                for l in m..self.bands() {
                    let (even, odd) = (index(l, m as isize), index(l, -(m as isize)));
                    let (c, s) = (self.get(block, even), self.get(block, odd));
                    turned.set(block, even, cos * c + sin * s);
                    turned.set(block, odd, cos * s - sin * c);
                }
            }
        }
        // The directions of motion turn too.
        let (sin, cos) = angle.sin_cos();
        for c in 0..CHANNELS {
            for k in 0..self.bands() * self.bands() {
                let (along_u, along_v) = (CHANNELS + c, 2 * CHANNELS + c);
                let (u, v) = (turned.get(along_u, k), turned.get(along_v, k));
                turned.set(along_u, k, cos * u + sin * v);
                turned.set(along_v, k, cos * v - sin * u);
            }
        }
        turned
    }
}

/// Sum of products of two rows whose length is a multiple of the vectors' width.
#[inline]
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sum = f32x16::ZERO;
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        sum += f32x16::new(*a) * f32x16::new(*b);
    }
    sum.reduce_add()
}

const _: () = assert!(stride(MAX_BANDS) == MAX_FUNCTIONS);
