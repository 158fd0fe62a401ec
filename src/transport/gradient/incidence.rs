//! Light arriving from one direction, and its derivatives as the receiver moves.

/// Light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// Unit direction to the light.
    pub direction: [f32; 3],
    /// Inverse distance, the rate at which the direction turns as the receiver moves; 0 at infinite distance.
    pub inv_dist: f32,
    /// Irradiance on a surface that faces the light: emitter's cosine over squared distance, or 1 at infinite distance.
    pub factor: f32,
    /// Derivatives of `factor` along u and v.
    pub gradient: [f32; 2],
}

impl Incidence {
    /// Returns `share` of the light with zero gradient, since a clamped contribution does not change with the receiver.
    #[inline]
    pub fn held(self, share: f32) -> Incidence {
        Incidence { inv_dist: 0.0, gradient: [0.0; 2], factor: self.factor * share, ..self }
    }

    /// Returns the light times an attenuation `share`, whose derivatives along u and v are `slope`.
    #[inline]
    pub fn attenuated(self, share: f32, slope: [f32; 2]) -> Incidence {
        let along = |axis: usize| self.gradient[axis] * share + self.factor * slope[axis];
        Incidence { factor: self.factor * share, gradient: [along(0), along(1)], ..self }
    }

    /// Returns the derivative of the direction as the receiver moves along u (axis 0) or v (axis 1).
    #[inline]
    pub fn turning(&self, axis: usize) -> [f32; 3] {
        let omega = self.direction;
        let along = omega[axis];
        let mut turning = omega.map(|c| c * along * self.inv_dist);
        turning[axis] -= self.inv_dist;
        turning
    }
}
