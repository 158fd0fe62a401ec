//! Vectors and colours of [`Lane`]s.

use super::lane::{Lane, Mask16, f32x16};
use super::lanes::Vec3x16;
use glam::Vec3;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// A vector or colour, or sixteen.
#[derive(Clone, Copy, Debug)]
pub struct V3<L> {
    /// First coordinate.
    pub x: L,
    /// Second coordinate.
    pub y: L,
    /// Third coordinate.
    pub z: L,
}

impl<L: Lane> V3<L> {
    /// Returns the vector of three coordinates.
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> V3<L> {
        V3 { x, y, z }
    }

    /// Returns one vector in all lanes.
    #[inline(always)]
    pub fn splat(v: Vec3) -> V3<L> {
        V3::new(v.x.into(), v.y.into(), v.z.into())
    }

    /// Returns vectors from a function of the lane's index: look-ups.
    #[inline(always)]
    pub fn from_fn(mut f: impl FnMut(usize) -> Vec3) -> V3<L> {
        let mut vectors = Vec3x16::ZERO;
        for lane in 0..L::COUNT {
            vectors.set(lane, f(lane));
        }
        let Vec3x16 { x, y, z } = &vectors;
        V3::new(L::from_fn(|lane| x[lane]), L::from_fn(|lane| y[lane]), L::from_fn(|lane| z[lane]))
    }

    /// Returns one number in all coordinates.
    #[inline(always)]
    pub fn grey(value: L) -> V3<L> {
        V3::new(value, value, value)
    }

    /// Returns the zero vector.
    #[inline(always)]
    pub fn zero() -> V3<L> {
        V3::grey(L::from(0.0))
    }

    /// Returns the vector in a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x.lane(lane), self.y.lane(lane), self.z.lane(lane))
    }

    /// Returns the vector in all lanes of a wider type.
    #[inline(always)]
    pub fn widen<D: Lane + From<L>>(self) -> V3<D> {
        V3::new(D::from(self.x), D::from(self.y), D::from(self.z))
    }

    /// Returns the dot product.
    #[inline(always)]
    pub fn dot(self, other: V3<L>) -> L {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    /// Returns the dot product with one vector.
    #[inline(always)]
    pub fn along(self, other: Vec3) -> L {
        self.dot(V3::splat(other))
    }

    /// Returns the squared length.
    #[inline(always)]
    pub fn length_sq(self) -> L {
        self.dot(self)
    }

    /// Returns a function of each coordinate.
    #[inline(always)]
    pub fn map(self, f: impl Fn(L) -> L) -> V3<L> {
        V3::new(f(self.x), f(self.y), f(self.z))
    }

    /// Returns the absolute values.
    #[inline(always)]
    pub fn abs(self) -> V3<L> {
        self.map(L::abs)
    }

    /// Returns the larger of each coordinate.
    #[inline(always)]
    pub fn max(self, other: V3<L>) -> V3<L> {
        V3::new(self.x.max(other.x), self.y.max(other.y), self.z.max(other.z))
    }

    /// Returns the vector times a number.
    #[inline(always)]
    pub fn times(self, scale: L) -> V3<L> {
        self.map(|coordinate| coordinate * scale)
    }

    /// Returns the vector where the mask is true, else 0.
    #[inline(always)]
    pub fn keep(self, mask: L::Mask) -> V3<L> {
        self.map(|coordinate| coordinate.keep(mask))
    }

    /// Returns `yes` where the mask is true, else `no`.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: V3<L>, no: V3<L>) -> V3<L> {
        let either = |yes, no| L::pick(mask, yes, no);
        V3::new(either(yes.x, no.x), either(yes.y, no.y), either(yes.z, no.z))
    }
}

macro_rules! by_coordinate {
    ($($operator:ident $function:ident),*) => {$(
        impl<L: Lane> $operator for V3<L> {
            type Output = V3<L>;

            #[inline(always)]
            fn $function(self, other: V3<L>) -> V3<L> {
                let f = $operator::$function;
                V3::new(f(self.x, other.x), f(self.y, other.y), f(self.z, other.z))
            }
        }
    )*};
}
by_coordinate!(Add add, Sub sub, Mul mul);

impl<L: Lane> AddAssign for V3<L> {
    #[inline(always)]
    fn add_assign(&mut self, other: V3<L>) {
        *self = *self + other;
    }
}

impl<L: Lane> Neg for V3<L> {
    type Output = V3<L>;

    #[inline(always)]
    fn neg(self) -> V3<L> {
        self.map(|coordinate| -coordinate)
    }
}

impl From<V3<f32>> for Vec3 {
    #[inline(always)]
    fn from(v: V3<f32>) -> Vec3 {
        Vec3::new(v.x, v.y, v.z)
    }
}

impl Vec3x16 {
    /// Loads all lanes.
    #[inline(always)]
    pub fn load(&self) -> V3<f32x16> {
        V3::new(f32x16::new(self.x), f32x16::new(self.y), f32x16::new(self.z))
    }

    /// Sets the lanes of a mask.
    #[inline(always)]
    pub fn put(&mut self, mask: Mask16, v: V3<f32x16>) {
        *self = V3::select(mask, v, self.load()).into();
    }
}

impl From<V3<f32x16>> for Vec3x16 {
    #[inline(always)]
    fn from(v: V3<f32x16>) -> Vec3x16 {
        Vec3x16 { x: v.x.to_array(), y: v.y.to_array(), z: v.z.to_array() }
    }
}
