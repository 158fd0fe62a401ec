//! Arithmetic for formulas that run in single precision, in double precision, and in single precision for eight
//! arguments at once.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

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

/// Number of lanes of [`F32x8`].
pub const WIDTH: usize = 8;

/// Eight numbers in single precision; loops over them compile to vector code.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct F32x8(pub [f32; WIDTH]);

impl F32x8 {
    /// Zero in all lanes.
    pub const ZERO: F32x8 = F32x8([0.0; WIDTH]);

    /// Returns the sum of all eight, always added in the same order.
    #[inline]
    pub fn sum(self) -> f32 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}

macro_rules! lanewise {
    ($($operator:ident $function:ident $symbol:tt),*) => {$(
        impl $operator for F32x8 {
            type Output = F32x8;

            #[inline(always)]
            fn $function(mut self, other: F32x8) -> F32x8 {
                // Iterators and `from_fn` are not always inlined, and then the code does not vectorise.
                for i in 0..WIDTH {
                    self.0[i] $symbol other.0[i];
                }
                self
            }
        }
    )*};
}
lanewise!(Add add +=, Sub sub -=, Mul mul *=, Div div /=);

impl Neg for F32x8 {
    type Output = F32x8;

    #[inline(always)]
    fn neg(mut self) -> F32x8 {
        for lane in &mut self.0 {
            *lane = -*lane;
        }
        self
    }
}

impl AddAssign for F32x8 {
    #[inline(always)]
    fn add_assign(&mut self, other: F32x8) {
        *self = *self + other;
    }
}

impl Real for F32x8 {
    #[inline(always)]
    fn of(value: f64) -> F32x8 {
        F32x8([value as f32; WIDTH])
    }

    #[inline(always)]
    fn sqrt(mut self) -> F32x8 {
        for lane in &mut self.0 {
            *lane = lane.sqrt();
        }
        self
    }

    #[inline(always)]
    fn max(mut self, other: F32x8) -> F32x8 {
        for i in 0..WIDTH {
            self.0[i] = self.0[i].max(other.0[i]);
        }
        self
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
        let lanes = formula(F32x8(a), F32x8(b));
        for i in 0..WIDTH {
            assert_eq!(lanes.0[i], formula(a[i], b[i]));
            assert!((f64::from(lanes.0[i]) - formula(f64::from(a[i]), f64::from(b[i]))).abs() < 1e-5);
        }
        assert_eq!(F32x8(from_fn(|i| i as f32)).sum(), 28.0);
    }
}
