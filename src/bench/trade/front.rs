//! The Pareto front, and the effect of each knob in a designed sample.

use super::errors::error_of;
use crate::study::{Answer, Group, Shot};
use base::setting::JudgedBy;
use render::verify::NORMAL_975;
use serde::Serialize;

/// Returns true if no other image of the default method is faster and no worse than an image of it. Errors of whole
/// pixels and of eye samples are not comparable.
pub fn is_on_front(answer: &Answer, shot: &Shot, error: JudgedBy) -> bool {
    let place = |shot: &Shot| {
        let is_own = !matches!(shot.candidate.group, Group::Other | Group::DenoisedPath);
        let is_judged = is_own && (shot.candidate.whole_pixels() || error == JudgedBy::Flip);
        Some((shot.seconds(), error_of(shot, error).filter(|_| is_judged)?))
    };
    place(shot).is_some_and(|point| is_unbeaten(point, answer.shots.iter().filter_map(place)))
}

/// Returns true if no other point beats a point in both figures.
fn is_unbeaten((x, y): (f64, f64), mut others: impl Iterator<Item = (f64, f64)>) -> bool {
    !others.any(|other| other.0 <= x && other.1 <= y && (other.0 < x || other.1 < y))
}

/// Factor by which a figure changes from a knob's coarsest to its finest level while all others vary.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// The factor.
    pub factor: f64,
    /// Confidence interval of the factor, 95 %.
    pub range: [f64; 2],
}

/// Minimum number of points for a confidence interval.
const MIN_POINTS: usize = 6;

/// Fits the logarithm of `values` over `places`, a knob's levels from 0 to 1, by least squares. `None` for too few
/// points, or if the knob does not vary.
pub fn effect(places: &[f64], values: &[f64]) -> Option<Effect> {
    let points: Vec<(f64, f64)> =
        places.iter().zip(values).filter(|(_, v)| **v > 0.0).map(|(p, v)| (*p, v.ln())).collect();
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    if points.len() < MIN_POINTS || xx <= 0.0 {
        return None;
    }
    let slope = xy / xx;
    let rest: f64 = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).powi(2)).sum();
    let error = student_975(n - 2.0) * (rest / (n - 2.0) / xx).sqrt();
    Some(Effect { factor: slope.exp(), range: [(slope - error).exp(), (slope + error).exp()] })
}

/// Returns the 97.5 % quantile of Student's distribution for at least four degrees of freedom, to .5 %.
///
/// Source: Abramowitz and Stegun, *Handbook of Mathematical Functions*, 26.7.5.
fn student_975(freedom: f64) -> f64 {
    let z = NORMAL_975;
    let [z3, z5, z7] = [3, 5, 7].map(|n| z.powi(n));
    let first = (z3 + z) / 4.0;
    let second = (5.0 * z5 + 16.0 * z3 + 3.0 * z) / 96.0;
    let third = (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / 384.0;
    z + (first + (second + third / freedom) / freedom) / freedom
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::hash;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, expected) in [(4.0, 2.776), (10.0, 2.228), (30.0, 2.042), (1e6, 1.960)] {
            assert!((student_975(freedom) / expected - 1.0).abs() < 0.005, "{freedom}");
        }
    }

    #[test]
    fn knobs_without_effect_are_found_to_have_one_in_five_of_a_hundred_cases() {
        let uniform = |a: u32, b: u32| f64::from(hash(a, b)) / 4294967296.0;
        for points in [6, 24] {
            let trials = 2000;
            let claimed = (0..trials).filter(|&trial| {
                let places: Vec<f64> = (0..points).map(|i| uniform(i, 2 * trial)).collect();
                // Sums of four uniform numbers are nearly normal.
                let noise = |i: u32| (0..4).map(|k| uniform(4 * i + k, 2 * trial + 1)).sum::<f64>();
                let values: Vec<f64> = (0..points).map(|i| noise(i).exp()).collect();
                effect(&places, &values).is_some_and(|e| e.range[0] > 1.0 || e.range[1] < 1.0)
            });
            let share = claimed.count() as f64 / f64::from(trials);
            assert!((0.035..0.065).contains(&share), "{points}: {share}");
        }
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [(1.0, 4.0), (2.0, 2.0), (2.0, 3.0), (4.0, 1.0), (5.0, 1.0), (2.0, 2.0)];
        let front = points.map(|point| is_unbeaten(point, points.into_iter()));
        assert_eq!(front, [true, true, false, true, false, true]);
    }

    #[test]
    fn an_effect_is_the_factor_over_the_knobs_range() {
        let places = [0.0, 0.5, 1.0, 0.25, 0.75, 0.1];
        let found = effect(&places, &places.map(|p: f64| 3.0 * 16f64.powf(p))).unwrap();
        assert!((found.factor - 16.0).abs() < 1e-9 && (found.range[1] - 16.0).abs() < 1e-6, "{found:?}");
        assert_eq!(effect(&[0.5; 6], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), None);
        assert_eq!(effect(&places[1..], &[1.0, 2.0, 3.0, 4.0, 5.0]), None, "too few");
    }
}
