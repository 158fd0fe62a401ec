//! Discrete distributions by cumulative sums.
//!
//! Sampling inverts the sums, which preserves the order of the random numbers (an alias table would not). A guide table
//! narrows the search to a few entries, because every step of a binary search in the large distributions of environment
//! maps is a cache miss.

use base::math::{F32x16, LANES, U32x16};
use std::ops::Range;

/// A discrete distribution over `0..len`, in proportion to non-negative weights.
#[derive(Clone, Debug)]
pub struct DiscreteDistribution {
    /// Sums of the weights before each outcome, over the total. The last entry is 1.
    cumulative: Vec<f32>,
    /// Outcomes at `i / (guide.len() - 1)`, from which searches start.
    guide: Vec<u32>,
    /// Sum of the weights.
    total: f64,
}

/// Mean number of outcomes per entry of the guide table.
const GUIDE_SPACING: usize = 2;

impl DiscreteDistribution {
    /// Builds the distribution, with sums in f64. A total of zero makes an empty distribution, which must not be
    /// sampled.
    pub fn new(weights: impl IntoIterator<Item = f32>) -> DiscreteDistribution {
        let mut sum = 0.0f64;
        let mut sums = vec![0.0f64];
        for w in weights {
            sum += w.max(0.0) as f64;
            sums.push(sum);
        }
        let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        let mut cumulative: Vec<f32> = sums.iter().map(|s| (s * scale) as f32).collect();
        if let Some(last) = cumulative.last_mut() {
            *last = 1.0;
        }
        let outcomes = cumulative.len() - 1;
        let spans = outcomes.div_ceil(GUIDE_SPACING).max(1);
        let at = |i: usize| {
            let u = i as f32 / spans as f32;
            (cumulative.partition_point(|c| *c <= u).clamp(1, outcomes.max(1)) - 1) as u32
        };
        let guide = (0..=spans).map(at).collect();
        DiscreteDistribution { cumulative, guide, total: sum }
    }

    /// Returns the sum of the weights.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Returns the number of outcomes.
    pub fn len(&self) -> usize {
        self.cumulative.len() - 1
    }

    /// Returns true if there is no outcome to sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0 || self.total <= 0.0
    }

    /// Returns the probability of outcome `i`.
    #[inline]
    pub fn probability(&self, i: usize) -> f32 {
        if self.total > 0.0 { self.cumulative[i + 1] - self.cumulative[i] } else { 0.0 }
    }

    /// Returns the probability of the outcomes in `range`.
    #[inline]
    pub fn span(&self, range: &Range<usize>) -> f32 {
        if self.total > 0.0 { self.cumulative[range.end] - self.cumulative[range.start] } else { 0.0 }
    }

    /// Samples among the outcomes in `range` (see [`DiscreteDistribution::sample`]).
    #[inline]
    pub fn sample_between(&self, range: &Range<usize>, u: f32) -> (usize, f32) {
        let u = self.cumulative[range.start] + u * self.span(range);
        let (i, rest) = self.sample(u.min(1.0 - f32::EPSILON));
        (i.clamp(range.start, range.end - 1), rest)
    }

    /// Returns the outcome at `u` in [0, 1), and `u` rescaled to [0, 1) within it.
    ///
    /// Never returns an outcome of probability zero, unless all have it.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32) {
        self.search(u, self.bracket(u))
    }

    /// Returns [`DiscreteDistribution::sample`] of sixteen numbers. All outcomes are tried in turn, so there should be
    /// few.
    #[inline]
    pub(super) fn sample16(&self, u: &F32x16) -> (U32x16, F32x16) {
        let sums = &self.cumulative;
        let (mut outcome, mut low, mut high) = ([0; LANES], [sums[0]; LANES], [sums[1]; LANES]);
        for k in 1..self.len() {
            for i in 0..LANES {
                let passes = sums[k] <= u[i];
                outcome[i] = if passes { k as u32 } else { outcome[i] };
                low[i] = if passes { sums[k] } else { low[i] };
                high[i] = if passes { sums[k + 1] } else { high[i] };
            }
        }
        let mut rest = [0.0; LANES];
        for i in 0..LANES {
            let width = high[i] - low[i];
            let within = if width > 0.0 { (u[i] - low[i]) / width } else { 0.0 };
            rest[i] = within.clamp(0.0, 1.0 - f32::EPSILON);
        }
        (outcome, rest)
    }

    /// Returns a range of outcomes that contains the outcome at `u`. It is a separate step so that several searches can
    /// wait for memory together.
    #[inline]
    pub(super) fn bracket(&self, u: f32) -> Bracket {
        let spans = self.guide.len() - 1;
        let span = ((u * spans as f32) as usize).min(spans - 1);
        // The range has a margin of one entry on both sides, because `u` times the number of spans was rounded.
        let first = self.guide[span.saturating_sub(1)] as usize;
        let last = (self.guide[(span + 2).min(spans)] as usize + 1).min(self.len());
        Bracket { first, last }
    }

    /// Completes [`DiscreteDistribution::sample`] within a bracket.
    #[inline]
    pub(super) fn search(&self, u: f32, b: Bracket) -> (usize, f32) {
        let i = b.first + self.cumulative[b.first..=b.last].partition_point(|c| *c <= u);
        let i = i.clamp(1, self.len().max(1)) - 1;
        let width = self.probability(i);
        let rest = if width > 0.0 { (u - self.cumulative[i]) / width } else { 0.0 };
        (i, rest.clamp(0.0, 1.0 - f32::EPSILON))
    }
}

/// A range of outcomes that contains the sampled one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bracket {
    first: usize,
    last: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_follow_weights_and_zero_is_never_drawn() {
        let d = DiscreteDistribution::new([0.0, 1.0, 0.0, 3.0, 0.0]);
        let n = 4000;
        let mut counts = [0; 5];
        for i in 0..n {
            let (k, rest) = d.sample(i as f32 / n as f32);
            assert!((0.0..1.0).contains(&rest));
            counts[k] += 1;
        }
        assert_eq!(counts, [0, n / 4, 0, 3 * n / 4, 0]);
        assert_eq!(d.probability(3), 0.75);
    }

    #[test]
    fn sixteen_numbers_have_the_outcomes_of_each() {
        let weights = [[3.0, 0.0, 1.0, 0.0], [0.0, 0.0, 2.0, 5.0], [1.0, 1e-9, 1e-3, 7.0]];
        for weights in weights.iter().flat_map(|weights| (1..=4).map(move |count| &weights[..count])) {
            let d = DiscreteDistribution::new(weights.iter().copied());
            for first in (0..4096).step_by(LANES).filter(|_| !d.is_empty()) {
                let u = std::array::from_fn(|i| ((first + i) as f32 / 4095.0).min(1.0 - f32::EPSILON / 2.0));
                let (outcomes, rests) = d.sample16(&u);
                for i in 0..LANES {
                    assert_eq!((outcomes[i] as usize, rests[i]), d.sample(u[i]), "{weights:?} {}", u[i]);
                }
            }
        }
    }

    #[test]
    fn guided_search_is_the_plain_search() {
        let weights: Vec<f32> = (0..1000)
            .map(|i| if i % 7 == 0 { 0.0 } else { ((i * 7919) % 101) as f32 + 1e4 * (i == 500) as u8 as f32 })
            .collect();
        let d = DiscreteDistribution::new(weights);
        for k in 0..100_000 {
            let u = k as f32 / 100_000.0;
            let plain = d.cumulative.partition_point(|c| *c <= u) - 1;
            assert_eq!(d.sample(u).0, plain, "{u}");
        }
        assert_eq!(d.sample(1.0 - f32::EPSILON / 2.0).0, d.cumulative.partition_point(|c| *c < 1.0) - 1);
    }

    #[test]
    fn nothing_to_draw() {
        assert!(DiscreteDistribution::new([]).is_empty());
        assert!(DiscreteDistribution::new([0.0, 0.0]).is_empty());
    }
}
