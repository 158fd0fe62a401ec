//! Sum of the light of many directions as coefficients, sixteen directions at a time.
//!
//! Paper: Herzog et al. 2009, equations 5 and 6.
//! Deviations: the receiver's cosine is part of the reflection, not of the light, so the series represents radiance.
//! Units: intensity times [`Incidence::factor`].

use super::basis::{CHANNELS, MAX_BANDS, MAX_FUNCTIONS, for_each};
use super::radiance::{BLOCKS, Radiance};
use crate::gradient::Incidence;
use base::math::{LANES, Rgb, f32x16};

/// Coefficients under construction. Rounding depends on the order in which light is added, so callers must add it in a
/// fixed order.
pub struct Accumulator {
    bands: usize,
    batch: IncidentLanes,
    /// Number of the batch's lanes in use.
    filled: usize,
    /// Value and derivatives along u and v by function, three channels each. Lanes are summed at the end.
    sums: Box<[[f32x16; BLOCKS]; MAX_FUNCTIONS]>,
}

/// Light from sixteen directions.
#[derive(Clone, Copy)]
struct IncidentLanes {
    direction: [f32x16; 3],
    inv_dist: f32x16,
    factor: f32x16,
    gradient: [f32x16; 2],
    intensity: [f32x16; CHANNELS],
}

impl IncidentLanes {
    const EMPTY: IncidentLanes = IncidentLanes {
        direction: [f32x16::ZERO; 3],
        inv_dist: f32x16::ZERO,
        factor: f32x16::ZERO,
        gradient: [f32x16::ZERO; 2],
        intensity: [f32x16::ZERO; CHANNELS],
    };
}

impl Accumulator {
    /// Creates an accumulator for series of `bands` bands, which is clamped to 1 to 8.
    pub fn new(bands: usize) -> Accumulator {
        let bands = bands.clamp(1, MAX_BANDS);
        let sums = Box::new([[f32x16::ZERO; BLOCKS]; MAX_FUNCTIONS]);
        Accumulator { bands, batch: IncidentLanes::EMPTY, filled: 0, sums }
    }

    /// Resets the accumulator to a number of bands.
    pub fn reset(&mut self, bands: usize) {
        self.bands = bands.clamp(1, MAX_BANDS);
        self.sums.fill([f32x16::ZERO; BLOCKS]);
        (self.batch, self.filled) = (IncidentLanes::EMPTY, 0);
    }

    /// Adds the light of one direction; light from below the horizon is ignored.
    #[inline]
    pub fn add(&mut self, incidence: &Incidence, intensity: Rgb) {
        if !(incidence.direction[2] > 0.0) {
            return;
        }
        let (lane, batch) = (self.filled, &mut self.batch);
        for i in 0..3 {
            batch.direction[i].as_mut_array()[lane] = incidence.direction[i];
            batch.intensity[i].as_mut_array()[lane] = intensity[i];
        }
        batch.inv_dist.as_mut_array()[lane] = incidence.inv_dist;
        batch.factor.as_mut_array()[lane] = incidence.factor;
        batch.gradient[0].as_mut_array()[lane] = incidence.gradient[0];
        batch.gradient[1].as_mut_array()[lane] = incidence.gradient[1];
        self.filled += 1;
        if self.filled == LANES {
            self.flush();
        }
    }

    /// Returns the sum of the light added since the last call, and resets the sum.
    pub fn finish(&mut self) -> Radiance {
        if self.filled > 0 {
            self.flush();
        }
        let mut radiance = Radiance::black(self.bands);
        for (k, sums) in self.sums.iter_mut().enumerate().take(self.bands * self.bands) {
            for (block, sum) in sums.iter().enumerate() {
                radiance.set(block, k, sum.reduce_add());
            }
            *sums = [f32x16::ZERO; BLOCKS];
        }
        radiance
    }

    fn flush(&mut self) {
        match self.bands {
            1 => self.add_batch::<1>(),
            2 => self.add_batch::<2>(),
            3 => self.add_batch::<3>(),
            4 => self.add_batch::<4>(),
            5 => self.add_batch::<5>(),
            6 => self.add_batch::<6>(),
            7 => self.add_batch::<7>(),
            _ => self.add_batch::<8>(),
        }
        (self.batch, self.filled) = (IncidentLanes::EMPTY, 0);
    }

    #[inline(never)]
    fn add_batch<const BANDS: usize>(&mut self) {
        let IncidentLanes { direction, inv_dist, factor, gradient: [slope_u, slope_v], intensity } =
            self.batch;
        let turning = factor * inv_dist;
        let sums = &mut self.sums;
        for_each::<f32x16, BANDS>(direction, |k, h, h_u, h_v| {
            let (u, v) = (slope_u * h + turning * h_u, slope_v * h + turning * h_v);
            let value = factor * h;
            let sums = &mut sums[k];
            for c in 0..CHANNELS {
                sums[c] += intensity[c] * value;
                sums[CHANNELS + c] += intensity[c] * u;
                sums[2 * CHANNELS + c] += intensity[c] * v;
            }
        });
    }
}
