//! Arithmetic for formulas that run in single precision, in double precision, and in single precision for eight
//! arguments at once.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

pub use wide::f32x8;

/// A number, or several lanes of numbers.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Returns a constant, rounded.
    fn of(value: f64) -> Self;

    /// Returns the square root.
    fn sqrt(self) -> Self;

    /// Returns the larger number; `other` if `self` is NaN.
    fn max(self, other: Self) -> Self;
}

macro_rules! scalar {
    ($($t:ty),*) => {$(
        impl Real for $t {
            #[inline(always)]
            fn of(value: f64) -> $t {
                value as $t
            }

            #[inline(always)]
            fn sqrt(self) -> $t {
                <$t>::sqrt(self)
            }

            #[inline(always)]
            fn max(self, other: $t) -> $t {
                <$t>::max(self, other)
            }
        }
    )*};
}
scalar!(f32, f64);

/// Number of lanes of [`f32x8`].
pub const WIDTH: usize = 8;

impl Real for f32x8 {
    #[inline(always)]
    fn of(value: f64) -> f32x8 {
        f32x8::from(value as f32)
    }

    #[inline(always)]
    fn sqrt(self) -> f32x8 {
        f32x8::sqrt(self)
    }

    #[inline(always)]
    fn max(self, other: f32x8) -> f32x8 {
        self.fast_max(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::array::from_fn;

    fn formula<T: Real>(a: T, b: T) -> T {
        let mut sum = (a * b - a / b).max(T::of(0.25)).sqrt();
        sum += -a + T::of(3.0);
        sum
    }

    #[test]
    fn every_lane_is_the_scalar_computation() {
        let a: [f32; WIDTH] = from_fn(|i| 0.3 + i as f32);
        let b: [f32; WIDTH] = from_fn(|i| 2.5 - 0.7 * i as f32);
        let lanes = formula(f32x8::new(a), f32x8::new(b)).to_array();
        for i in 0..WIDTH {
            assert_eq!(lanes[i], formula(a[i], b[i]));
            assert!((f64::from(lanes[i]) - formula(f64::from(a[i]), f64::from(b[i]))).abs() < 1e-5);
        }
    }
}
