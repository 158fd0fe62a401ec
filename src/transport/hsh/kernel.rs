//! Reflection kernels as series: BRDF times cosine for one outgoing direction.

use super::basis::{CHANNELS, MAX_BANDS, MAX_FUNCTIONS, index};
use base::math::Rgb;
use std::f32::consts::PI;

/// Number of functions that are even in azimuth, with orders m >= 0.
pub(super) const MAX_EVEN: usize = MAX_BANDS * (MAX_BANDS + 1) / 2;

/// Index of the function of degree `l` and order `m`, 0 <= m <= l, among the even ones.
#[inline]
pub(super) const fn even_index(l: usize, m: usize) -> usize {
    l * (l + 1) / 2 + m
}

/// Coefficients of BRDF · cosine over the incoming directions, for an outgoing direction at azimuth 0. The function is
/// symmetric about the plane of this azimuth, so only even functions occur.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Coefficients by channel and function. Odd functions repeat the coefficients of their even partners, since
    /// turning the kernel distributes a coefficient over both.
    pub(super) coefficients: [[f32; MAX_FUNCTIONS]; CHANNELS],
}

impl Profile {
    /// Returns the reflectance for uniform light from all directions, up to a constant factor.
    #[inline]
    pub fn strength(&self) -> Rgb {
        Rgb::from_array(std::array::from_fn(|c| self.coefficients[c][0]))
    }

    /// Returns the kernel for the azimuth of `(x, y)`, which need not have unit length. At (0, 0) the azimuth is 0.
    #[inline]
    pub fn towards(&self, x: f32, y: f32) -> Kernel {
        let length = (x * x + y * y).sqrt();
        let (cos, sin) = if length > 0.0 { (x / length, y / length) } else { (1.0, 0.0) };
        // The order is sin mφ from the highest order down, then cos mφ up. So the functions of a degree are contiguous
        // around the middle.
        const MIDDLE: usize = MAX_BANDS - 1;
        let mut multiples = [1.0; 2 * MAX_BANDS - 1];
        let (mut cos_m, mut sin_m) = (1.0, 0.0);
        for m in 1..MAX_BANDS {
            (cos_m, sin_m) = (cos * cos_m - sin * sin_m, sin * cos_m + cos * sin_m);
            (multiples[MIDDLE + m], multiples[MIDDLE - m]) = (cos_m, sin_m);
        }
        let mut turn = [0.0; MAX_FUNCTIONS];
        for l in 0..MAX_BANDS {
            turn[l * l..(l + 1) * (l + 1)].copy_from_slice(&multiples[MIDDLE - l..=MIDDLE + l]);
        }
        let mut kernel = Kernel { coefficients: self.coefficients };
        for row in &mut kernel.coefficients {
            for k in 0..MAX_FUNCTIONS {
                row[k] *= turn[k];
            }
        }
        kernel
    }
}

/// Returns the coefficients of even functions, repeated for their odd partners.
pub(super) fn repeated(even: &[f64; MAX_EVEN]) -> [f32; MAX_FUNCTIONS] {
    let mut all = [0.0; MAX_FUNCTIONS];
    for l in 0..MAX_BANDS {
        for m in 0..=l {
            let coefficient = even[even_index(l, m)] as f32;
            all[index(l, m as isize)] = coefficient;
            all[index(l, -(m as isize))] = coefficient;
        }
    }
    all
}

/// Coefficients of BRDF · cosine over the incoming directions, by channel. Their scalar product with the coefficients
/// of the radiance is the reflected radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    pub(super) coefficients: [[f32; MAX_FUNCTIONS]; CHANNELS],
}

impl Kernel {
    /// Creates the kernel of the cosine alone, which converts radiance to irradiance.
    pub fn cosine(bands: usize) -> Kernel {
        let mut row = [0.0; MAX_FUNCTIONS];
        // cos θ = (1 + P_1(2 cos θ - 1)) / 2, and N = sqrt((2l + 1) / 2π).
        row[index(0, 0)] = (PI / 2.0).sqrt();
        if bands > 1 {
            row[index(1, 0)] = (PI / 6.0).sqrt();
        }
        Kernel { coefficients: [row; CHANNELS] }
    }
}
