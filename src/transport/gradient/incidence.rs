//! Light arriving from one direction, and its derivatives as the receiver moves.

use base::math::Real;

/// Light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence<T> {
    /// Unit direction to the light.
    pub direction: [T; 3],
    /// Inverse distance, the rate at which the direction turns as the receiver moves; 0 at infinite distance.
    pub inv_dist: T,
    /// Irradiance on a surface that faces the light: emitter's cosine over squared distance, or 1 at infinite distance.
    pub factor: T,
    /// Derivatives of `factor` along u and v.
    pub gradient: [T; 2],
}

impl<T: Real + PartialOrd> Incidence<T> {
    /// Returns `share` of the light with zero gradient, since a clamped contribution does not change with the receiver.
    #[inline]
    pub fn held(self, share: T) -> Incidence<T> {
        let zero = T::of(0.0);
        Incidence { inv_dist: zero, gradient: [zero; 2], factor: self.factor * share, ..self }
    }

    /// Returns the light times an attenuation `share`, whose derivatives along u and v are `slope`.
    #[inline]
    pub fn attenuated(self, share: T, slope: [T; 2]) -> Incidence<T> {
        let along = |axis: usize| self.gradient[axis] * share + self.factor * slope[axis];
        Incidence { factor: self.factor * share, gradient: [along(0), along(1)], ..self }
    }

    /// Returns the derivative of the direction as the receiver moves along u (axis 0) or v (axis 1).
    #[inline]
    pub fn turning(&self, axis: usize) -> [T; 3] {
        let omega = self.direction;
        let along = omega[axis];
        let mut turning = omega.map(|c| c * along * self.inv_dist);
        turning[axis] = turning[axis] - self.inv_dist;
        turning
    }
}
