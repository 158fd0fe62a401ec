//! The Pareto front, and what a designed sample says of each knob.

use serde::Serialize;

/// Which points no other point beats in both figures.
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

/// By what factor something changes as a knob goes from its coarsest to its finest level, all others varied too.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// The factor.
    pub factor: f64,
    /// The same, one standard error less and one more.
    pub range: [f64; 2],
}

/// Least squares of the logarithm of `values` over `places`, a knob's levels from 0 to 1. None of too few points,
/// or if the knob stands still.
pub fn effect(places: &[f64], values: &[f64]) -> Option<Effect> {
    let points: Vec<(f64, f64)> =
        places.iter().zip(values).filter(|(_, v)| **v > 0.0).map(|(p, v)| (*p, v.ln())).collect();
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    if points.len() < 3 || xx <= 0.0 {
        return None;
    }
    let slope = xy / xx;
    let rest: f64 = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).powi(2)).sum();
    let error = (rest / (n - 2.0) / xx).sqrt();
    Some(Effect { factor: slope.exp(), range: [(slope - error).exp(), (slope + error).exp()] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [(1.0, 4.0), (2.0, 2.0), (2.0, 3.0), (4.0, 1.0), (5.0, 1.0), (2.0, 2.0)];
        assert_eq!(front(&points), [true, true, false, true, false, true]);
    }

    #[test]
    fn an_effect_is_the_factor_over_the_knobs_range() {
        let places = [0.0, 0.5, 1.0, 0.25];
        let found = effect(&places, &places.map(|p: f64| 3.0 * 16f64.powf(p))).unwrap();
        assert!((found.factor - 16.0).abs() < 1e-9 && (found.range[1] - 16.0).abs() < 1e-6, "{found:?}");
        assert_eq!(effect(&[0.5; 4], &[1.0, 2.0, 3.0, 4.0]), None);
    }
}
