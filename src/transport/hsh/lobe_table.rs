//! Coefficients of a lobe by outgoing direction.
//!
//! Paper: Herzog et al. 2009, section 4, which precomputes them per outgoing direction without stating the number.
//! Deviations: subdivision adds as many directions as linear interpolation needs. The parameter is √(1 - cos θ) = √2
//! sin θ/2, in which coefficients are smooth. As functions of cos θ, coefficients of order 1 would begin like a square
//! root at normal incidence.

use super::basis::{CHANNELS, MAX_BANDS, MAX_FUNCTIONS};
use super::kernel::{even_index, repeated};
use super::projection::{KernelProjection, Quadrature};
use super::radiance::stride;
use rayon::prelude::*;
use world::material::DullLobe;

/// Initial number of intervals.
const COARSEST: usize = 8;

/// Maximum number of halvings of an interval.
const MAX_HALVINGS: usize = 8;

/// Coefficients at some outgoing directions, with linear interpolation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LobeTable {
    /// Floats per channel, a multiple of the vectors' width.
    stride: usize,
    /// Number of channels: 1 if all channels are equal, otherwise 3.
    channels: usize,
    /// Parameters of the tabulated directions, ascending from 0 to 1.
    nodes: Vec<f32>,
    /// Coefficients by node, channel and function, in the layout of [`super::kernel::Profile`].
    coefficients: Vec<f32>,
}

/// Parameter of an outgoing direction: 0 at normal incidence, 1 at grazing.
#[inline]
fn parameter(cos_o: f32) -> f32 {
    (1.0 - cos_o.clamp(0.0, 1.0)).sqrt()
}

impl LobeTable {
    /// Tabulates the first `bands` of a lobe so that the error of the interpolated kernel is at most `tolerance`,
    /// relative to its norm.
    pub fn new(lobe: DullLobe, bands: usize, tolerance: f64, quadrature: &Quadrature) -> LobeTable {
        let bands = bands.clamp(1, MAX_BANDS);
        let used = even_index(bands, 0);
        let project = |node: f64| quadrature.project(lobe, 1.0 - node * node);
        let coarsest = |i: usize| i as f64 / COARSEST as f64;
        let mut samples: Vec<(f64, KernelProjection)> =
            (0..=COARSEST).into_par_iter().map(|i| (coarsest(i), project(coarsest(i)))).collect();
        // Intervals that may have to be split, by the index of their lower end.
        let mut open: Vec<usize> = (0..COARSEST).collect();
        for _ in 0..MAX_HALVINGS {
            let halved: Vec<(f64, KernelProjection, bool)> = open
                .par_iter()
                .map(|&i| {
                    let ((a, below), (b, above)) = (&samples[i], &samples[i + 1]);
                    let middle = 0.5 * (a + b);
                    let projection = project(middle);
                    // The middle is added in any case, and half the interval has a quarter of the error.
                    let split = midpoint_error(below, above, &projection, used) > 4.0 * tolerance;
                    (middle, projection, split)
                })
                .collect();
            let mut refined = Vec::with_capacity(samples.len() + halved.len());
            let mut still_open = Vec::new();
            let mut halves = open.iter().zip(halved).peekable();
            for (i, sample) in samples.into_iter().enumerate() {
                refined.push(sample);
                if let Some((_, (middle, projection, split))) = halves.next_if(|(place, _)| **place == i) {
                    if split {
                        still_open.extend([refined.len() - 1, refined.len()]);
                    }
                    refined.push((middle, projection));
                }
            }
            (samples, open) = (refined, still_open);
            if open.is_empty() {
                break;
            }
        }
        let grey = samples.iter().all(|(_, p)| p.coefficients[1..].iter().all(|c| *c == p.coefficients[0]));
        let channels = if grey { 1 } else { CHANNELS };
        let rows = samples.iter().flat_map(|(_, p)| &p.coefficients[..channels]);
        LobeTable {
            stride: stride(bands),
            channels,
            coefficients: rows.flat_map(|row| cut_off(repeated(row), bands)).collect(),
            nodes: samples.iter().map(|(node, _)| *node as f32).collect(),
        }
    }

    /// Number of outgoing directions that are tabulated.
    #[cfg(test)]
    pub fn directions(&self) -> usize {
        self.nodes.len()
    }

    /// Returns all coefficients at `cos_o`, interpolated.
    #[inline]
    pub fn lookup(&self, cos_o: f32) -> [[f32; MAX_FUNCTIONS]; CHANNELS] {
        let x = parameter(cos_o);
        let above = self.nodes.partition_point(|node| *node <= x).clamp(1, self.nodes.len() - 1);
        let (a, b) = (self.nodes[above - 1], self.nodes[above]);
        let share = (x - a) / (b - a);
        let mut result = [[0.0; MAX_FUNCTIONS]; CHANNELS];
        for c in 0..self.channels {
            let below = &self.coefficients[((above - 1) * self.channels + c) * self.stride..][..self.stride];
            let above = &self.coefficients[(above * self.channels + c) * self.stride..][..self.stride];
            let row = &mut result[c][..self.stride];
            for k in 0..row.len() {
                row[k] = below[k] + share * (above[k] - below[k]);
            }
        }
        if self.channels == 1 {
            result = [result[0]; CHANNELS];
        }
        result
    }
}

/// Returns the functions of the first `bands`, padded with zeros.
fn cut_off(mut row: [f32; MAX_FUNCTIONS], bands: usize) -> impl Iterator<Item = f32> {
    row[bands * bands..].fill(0.0);
    row.into_iter().take(stride(bands))
}

/// Returns the distance between the mean of two kernels and the kernel in the middle, relative to the norm of the
/// latter.
fn midpoint_error(
    below: &KernelProjection,
    above: &KernelProjection,
    middle: &KernelProjection,
    used: usize,
) -> f64 {
    let mut error_sq = 0.0;
    for c in 0..CHANNELS {
        for k in 0..used {
            let mean = 0.5 * (below.coefficients[c][k] + above.coefficients[c][k]);
            error_sq += (middle.coefficients[c][k] - mean).powi(2);
        }
    }
    (error_sq / middle.norm_sq.iter().sum::<f64>().max(f64::MIN_POSITIVE)).sqrt()
}
