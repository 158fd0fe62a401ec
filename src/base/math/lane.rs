//! Numbers for formulas that are written once: [`Lane`] is `f32`, or sixteen numbers in vector registers.
//!
//! A condition is a mask with one truth value per lane, and [`Lane::pick`] takes the place of `if`. A condition that
//! holds in no lane, or in all, may be a branch ([`Mask::any`]).
//!
//! Units: relative errors of the functions are below 3e-7.

use super::lanes::{F32x16, LANES, U32x16};
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};
use wide::{i32x16, u32x16};

pub use wide::f32x16;

/// ln 2 in two parts; the first has so few digits that its products with small whole numbers are exact.
const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];

/// Factors 1/n! of the series of eˣ, from the highest power down.
const EXP_SERIES: [f32; 6] = [1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];

/// One truth value, or one per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Returns a mask with the same truth value in all lanes.
    fn all(value: bool) -> Self;
    /// Returns true if the mask is true in a lane.
    fn any(self) -> bool;
    /// Returns the truth value of a lane.
    fn lane(self, lane: usize) -> bool;
}

/// A number, or sixteen.
pub trait Lane:
    Copy
    + From<f32>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f32, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// One truth value per lane.
    type Mask: Mask;

    /// Number of lanes.
    const COUNT: usize;

    /// Returns self · `a` + `b`; the product is rounded only on processors that cannot avoid it.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Returns the larger number; `other` if one is NaN.
    fn max(self, other: Self) -> Self;
    /// Returns the smaller number; `other` if one is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns the absolute value.
    fn abs(self) -> Self;
    /// Returns the root of a number >= 0.
    fn sqrt(self) -> Self;
    /// Returns the natural logarithm of a positive number.
    fn ln(self) -> Self;
    /// Returns the nearest whole number.
    fn round(self) -> Self;
    /// Returns 2ⁿ for a whole number n from -126 to 127.
    fn exp2_whole(self) -> Self;
    /// Returns true where self > `other`.
    fn gt(self, other: Self) -> Self::Mask;
    /// Returns `yes` where the mask is true, else `no`.
    fn pick(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Returns numbers from a function of the lane's index: look-ups.
    fn from_fn(f: impl FnMut(usize) -> f32) -> Self;
    /// Returns the number in a lane.
    fn lane(&self, lane: usize) -> f32;

    /// Returns a function of each number, one by one: look-ups.
    #[inline(always)]
    fn each(self, f: impl Fn(f32) -> f32) -> Self {
        Self::from_fn(|lane| f(self.lane(lane)))
    }

    /// Returns the reciprocal of a number other than 0.
    #[inline(always)]
    fn recip(self) -> Self {
        Self::from(1.0) / self
    }

    /// Returns the reciprocal of the root of a positive number.
    #[inline(always)]
    fn rsqrt(self) -> Self {
        self.sqrt().recip()
    }

    /// Returns eˣ for -87 <= x <= 88.
    #[inline(always)]
    fn exp(self) -> Self {
        let power = (self * std::f32::consts::LOG2_E).round();
        let r = power.mul_add(Self::from(-LN_2[1]), power.mul_add(Self::from(-LN_2[0]), self));
        let mut series = Self::from(1.0 / 720.0);
        for factor in EXP_SERIES {
            series = series.mul_add(r, Self::from(factor));
        }
        series * power.exp2_whole()
    }

    /// Returns the positive part; 0 for NaN.
    #[inline(always)]
    fn positive(self) -> Self {
        self.max(Self::from(0.0))
    }

    /// Returns true where self > 0.
    #[inline(always)]
    fn is_positive(self) -> Self::Mask {
        self.gt(Self::from(0.0))
    }

    /// Returns the number where the mask is true, else 0.
    #[inline(always)]
    fn keep(self, mask: Self::Mask) -> Self {
        Self::pick(mask, self, Self::from(0.0))
    }

    /// Returns 1 - self.
    #[inline(always)]
    fn rest(self) -> Self {
        Self::from(1.0) - self
    }

    /// Returns the square.
    #[inline(always)]
    fn sq(self) -> Self {
        self * self
    }
}

impl Mask for bool {
    #[inline(always)]
    fn all(value: bool) -> bool {
        value
    }

    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn lane(self, _: usize) -> bool {
        self
    }
}

impl Lane for f32 {
    type Mask = bool;

    const COUNT: usize = 1;

    #[inline(always)]
    fn mul_add(self, a: f32, b: f32) -> f32 {
        if cfg!(target_feature = "fma") { f32::mul_add(self, a, b) } else { self * a + b }
    }

    #[inline(always)]
    fn max(self, other: f32) -> f32 {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn min(self, other: f32) -> f32 {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn abs(self) -> f32 {
        f32::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }

    #[inline(always)]
    fn ln(self) -> f32 {
        f32::ln(self)
    }

    #[inline(always)]
    fn round(self) -> f32 {
        f32::round_ties_even(self)
    }

    #[inline(always)]
    fn exp2_whole(self) -> f32 {
        f32::from_bits(((self as i32 + 127) as u32) << 23)
    }

    #[inline(always)]
    fn gt(self, other: f32) -> bool {
        self > other
    }

    #[inline(always)]
    fn pick(mask: bool, yes: f32, no: f32) -> f32 {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> f32) -> f32 {
        f(0)
    }

    #[inline(always)]
    fn lane(&self, _: usize) -> f32 {
        *self
    }
}

/// Sixteen truth values: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct Mask16(f32x16);

impl Mask16 {
    /// Returns the mask of the lanes whose bit is set.
    #[inline(always)]
    pub fn of(bits: u16) -> Mask16 {
        const BIT: [u32; LANES] = {
            let mut bit = [0; LANES];
            let mut lane = 0;
            while lane < LANES {
                bit[lane] = 1 << lane;
                lane += 1;
            }
            bit
        };
        let bit = u32x16::new(BIT);
        let is_set = (u32x16::splat(u32::from(bits)) & bit).simd_eq(bit);
        Mask16(bytemuck::cast(is_set))
    }

    /// Returns one bit per lane.
    #[inline(always)]
    pub fn bits(self) -> u16 {
        self.0.to_bitmask() as u16
    }

    /// Sets the lanes of the mask to other numbers.
    #[inline(always)]
    pub fn put(self, row: &mut F32x16, values: &F32x16) {
        *row = f32x16::pick(self, f32x16::new(*values), f32x16::new(*row)).to_array();
    }

    /// Sets the lanes of the mask to other whole numbers.
    #[inline(always)]
    pub fn put_u32(self, row: &mut U32x16, values: &U32x16) {
        let mask: u32x16 = bytemuck::cast(self.0);
        *row = mask.select(u32x16::new(*values), u32x16::new(*row)).to_array();
    }
}

macro_rules! logic {
    ($($operator:ident $function:ident),*) => {$(
        impl $operator for Mask16 {
            type Output = Mask16;

            #[inline(always)]
            fn $function(self, other: Mask16) -> Mask16 {
                Mask16($operator::$function(self.0, other.0))
            }
        }
    )*};
}
logic!(BitAnd bitand, BitOr bitor);

impl Not for Mask16 {
    type Output = Mask16;

    #[inline(always)]
    fn not(self) -> Mask16 {
        Mask16(!self.0)
    }
}

impl Mask for Mask16 {
    #[inline(always)]
    fn all(value: bool) -> Mask16 {
        Mask16::of(if value { u16::MAX } else { 0 })
    }

    #[inline(always)]
    fn any(self) -> bool {
        self.0.any()
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        self.bits() >> lane & 1 != 0
    }
}

impl Lane for f32x16 {
    type Mask = Mask16;

    const COUNT: usize = LANES;

    #[inline(always)]
    fn mul_add(self, a: f32x16, b: f32x16) -> f32x16 {
        f32x16::mul_add(self, a, b)
    }

    #[inline(always)]
    fn max(self, other: f32x16) -> f32x16 {
        self.fast_max(other)
    }

    #[inline(always)]
    fn min(self, other: f32x16) -> f32x16 {
        self.fast_min(other)
    }

    #[inline(always)]
    fn abs(self) -> f32x16 {
        f32x16::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> f32x16 {
        f32x16::sqrt(self)
    }

    #[inline(always)]
    fn ln(self) -> f32x16 {
        f32x16::ln(self)
    }

    #[inline(always)]
    fn round(self) -> f32x16 {
        self.round_ties_even()
    }

    #[inline(always)]
    fn exp2_whole(self) -> f32x16 {
        bytemuck::cast((self.fast_round_int() + i32x16::splat(127)) << 23u32)
    }

    #[inline(always)]
    fn gt(self, other: f32x16) -> Mask16 {
        Mask16(self.simd_gt(other))
    }

    #[inline(always)]
    fn pick(mask: Mask16, yes: f32x16, no: f32x16) -> f32x16 {
        mask.0.select(yes, no)
    }

    #[inline(always)]
    fn from_fn(mut f: impl FnMut(usize) -> f32) -> f32x16 {
        let mut numbers: F32x16 = [0.0; LANES];
        for lane in 0..LANES {
            numbers[lane] = f(lane);
        }
        f32x16::new(numbers)
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> f32 {
        self.as_array()[lane]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_function_is_that_of_the_library_in_every_lane() {
        for i in -87_000..=88_000 {
            let x = i as f32 / 1000.0;
            let exact = f64::from(x).exp();
            let all = f32x16::from(x).exp();
            for value in [Lane::exp(x), all.lane(0), all.lane(15)] {
                assert!((f64::from(value) / exact - 1.0).abs() < 3e-7, "{x}: {value} {exact}");
            }
        }
        assert_eq!(Lane::exp(0.0f32), 1.0);
    }

    #[test]
    fn sixteen_lanes_are_sixteen_scalar_computations() {
        fn formula<L: Lane>(a: L, b: L) -> L {
            let larger = (a * b - a / b).max(L::from(0.25)).min(a.abs() * 9.0).sqrt();
            L::pick(a.gt(b) & !b.is_positive(), larger.mul_add(a, b.ln()), larger - (-b).positive().rest())
        }
        let a = f32x16::from_fn(|i| 0.3 + i as f32);
        let b = f32x16::from_fn(|i| 2.5 - 0.7 * i as f32);
        let lanes = formula(a, b);
        for i in 0..LANES {
            let scalar = formula(a.lane(i), b.lane(i));
            assert!(lanes.lane(i) == scalar || lanes.lane(i).is_nan() && scalar.is_nan(), "{i}");
        }
        for x in [1e-30f32, 0.7, 1.0, 5.0, 1e30] {
            assert!((f32x16::from(x).ln().lane(3) - x.ln()).abs() <= 1e-6 * x.ln().abs().max(0.1));
        }
    }

    #[test]
    fn masks_are_their_bits() {
        for bits in [0, 1, 0x8000, 0b1000_0100_0000_1001, 0xffff] {
            let mask = Mask16::of(bits);
            assert_eq!((mask.bits(), (!mask).bits(), mask.any()), (bits, !bits, bits != 0));
            let row = f32x16::pick(mask, f32x16::from(1.0), f32x16::from(f32::NAN));
            (0..LANES).for_each(|i| assert_eq!(row.lane(i) == 1.0, bits >> i & 1 != 0));
            let (mut numbers, mut counts) = ([f32::NAN; LANES], [5; LANES]);
            mask.put(&mut numbers, &[1.0; LANES]);
            mask.put_u32(&mut counts, &[8; LANES]);
            assert!((0..LANES).all(|i| numbers[i].is_nan() == row.lane(i).is_nan()));
            assert_eq!(counts.map(|count| count == 8), numbers.map(|number| number == 1.0));
        }
        // A comparison with NaN holds in no lane.
        assert!(!f32x16::from(f32::NAN).is_positive().any());
        assert_eq!(f32x16::from(f32::NAN).positive().lane(7), 0.0);
    }
}
