//! Gauss-Legendre quadrature on [0, 1], for tables that are computed once per scene.

use std::f64::consts::PI;

/// Returns nodes in (0, 1) and their weights, which sum to 1.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            // Newton's method on P_n from Tricomi's estimate of its i-th root.
            let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut derivative = 1.0;
            for _ in 0..20 {
                let (value, slope) = legendre(n, x);
                derivative = slope;
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            let weight = 1.0 / ((1.0 - x * x) * derivative * derivative);
            (0.5 - 0.5 * x, weight)
        })
        .collect()
}

/// Returns P_n(x) and its derivative.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k);
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in [2, 5, 32, 128] {
            let rule = gauss_legendre(n);
            for degree in [0, 1, 2, 3, 2 * n - 1] {
                let sum: f64 = rule.iter().map(|&(x, w)| x.powi(degree as i32) * w).sum();
                let exact = 1.0 / (degree as f64 + 1.0);
                assert!((sum / exact - 1.0).abs() < 1e-12, "{n} nodes, degree {degree}: {sum} {exact}");
            }
        }
    }
}
