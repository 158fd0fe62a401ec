//! Fits by least squares.

/// Returns intercept and slope of the line through some points; slope 0 if their first coordinates are equal.
pub fn line(points: &[(f64, f64)]) -> [f64; 2] {
    let n = points.len().max(1) as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let [xx, xy] = [mean(&|p| (p.0 - x).powi(2)), mean(&|p| (p.0 - x) * (p.1 - y))];
    let slope = if xx > 1e-9 { xy / xx } else { 0.0 };
    [y - slope * x, slope]
}

/// Returns the factor by which values differ from what is expected of them, as a root mean square of logarithms.
pub fn residual(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let squares: Vec<f64> = pairs.map(|(value, expected)| (value / expected).ln().powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt().exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_factors_are_found_again() {
        let points = [0.0, 1.0, 5.0, 7.0].map(|x| (x, 3.0 - 0.5 * x));
        let [intercept, slope] = line(&points);
        assert!((intercept - 3.0).abs() < 1e-12 && (slope + 0.5).abs() < 1e-12);
        assert_eq!(line(&[(2.0, 1.0), (2.0, 3.0)]), [2.0, 0.0]);
        assert!((residual([(2.0, 1.0), (1.0, 2.0)].into_iter()) - 2.0).abs() < 1e-12);
    }
}
