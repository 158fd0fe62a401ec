//! Light arriving from one direction, and its derivatives as the receiver moves.

use crate::math::Real;

/// Light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence<T> {
    /// Unit direction it comes from.
    pub direction: [T; 3],
    /// 1 / distance, the rate at which the direction turns as the receiver moves; 0 at infinite distance.
    pub inv_dist: T,
    /// Irradiance on a surface that faces the light: the emitter's cosine over the squared distance, or 1.
    pub factor: T,
    /// Derivatives of `factor` along u and v.
    pub gradient: [T; 2],
}

/// Irradiance as a vector: its scalar product with a normal is the irradiance of that surface, as long as all the
/// light is above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceVector<T> {
    /// In the record's frame; z is the irradiance of the surface itself.
    pub value: [T; 3],
    /// Derivatives of `value` along u and v.
    pub gradient: [[T; 3]; 2],
}

impl<T: Real + PartialOrd> Incidence<T> {
    /// Returns `share` of the same light with zero gradient: a clamped contribution does not change with the
    /// receiver.
    #[inline]
    pub fn held(self, share: T) -> Incidence<T> {
        let zero = T::of(0.0);
        Incidence { inv_dist: zero, gradient: [zero; 2], factor: self.factor * share, ..self }
    }

    /// Returns the light behind an attenuation `share`, whose derivatives along u and v are `slope`.
    #[inline]
    pub fn attenuated(self, share: T, slope: [T; 2]) -> Incidence<T> {
        let along = |axis: usize| self.gradient[axis] * share + self.factor * slope[axis];
        Incidence { factor: self.factor * share, gradient: [along(0), along(1)], ..self }
    }

    /// Derivative of the direction as the receiver moves along u (axis 0) or v (axis 1).
    #[inline]
    pub fn turning(&self, axis: usize) -> [T; 3] {
        let omega = self.direction;
        let along = omega[axis];
        let mut turning = omega.map(|c| c * along * self.inv_dist);
        turning[axis] = turning[axis] - self.inv_dist;
        turning
    }

    /// The irradiance vector; zero if the light comes from below.
    #[inline]
    pub fn irradiance(&self) -> IrradianceVector<T> {
        let zero = T::of(0.0);
        if !(self.direction[2] > zero) {
            return IrradianceVector { value: [zero; 3], gradient: [[zero; 3]; 2] };
        }
        let along = |axis: usize| {
            let turning = self.turning(axis);
            std::array::from_fn(|i| self.gradient[axis] * self.direction[i] + self.factor * turning[i])
        };
        IrradianceVector { value: self.direction.map(|c| c * self.factor), gradient: [along(0), along(1)] }
    }
}
