//! The basis against its defining properties: orthonormality, the formula in angles, finite differences.

use crate::hsh::basis::*;
use base::math::{Real, f32x8, gauss_legendre};
use std::array::from_fn;
use std::f64::consts::TAU;

/// Unit directions of the whole hemisphere: a grid, and the neighbourhoods of the horizon and of the pole.
fn directions() -> Vec<[f64; 3]> {
    let mut heights: Vec<f64> = (0..=24).map(|i| f64::from(i) / 24.0).collect();
    heights.extend([1e-12, 1e-9, 1e-6, 1e-3, 1.0 - 1e-3, 1.0 - 1e-6, 1.0 - 1e-9, 1.0 - 1e-12, 1.0]);
    let mut all = Vec::new();
    for z in heights {
        for j in 0..16 {
            let (sin, cos) = (f64::from(j) * TAU / 16.0 + 0.1).sin_cos();
            let r = ((1.0 - z) * (1.0 + z)).sqrt();
            all.push([r * cos, r * sin, z]);
        }
    }
    all
}

/// Factorial of `n` as a real number.
fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

/// Coefficients of dᵐP_l / dtᵐ, lowest power first, from Rodrigues' formula.
fn legendre_derivative(l: usize, m: usize) -> Vec<f64> {
    // (t² - 1)^l, differentiated l + m times, over 2^l l!
    let mut powers = vec![0.0; 2 * l + 1];
    for i in 0..=l {
        let sign = if (l - i).is_multiple_of(2) { 1.0 } else { -1.0 };
        powers[2 * i] = sign * factorial(l) / (factorial(i) * factorial(l - i));
    }
    for _ in 0..l + m {
        powers = (1..powers.len()).map(|i| powers[i] * i as f64).collect();
    }
    powers.iter().map(|c| c / (2.0f64.powi(l as i32) * factorial(l))).collect()
}

/// Gautron's formula as printed: associated Legendre functions of 2 cos θ - 1, and angles.
fn printed_formula(l: usize, m: isize, [x, y, z]: [f64; 3]) -> f64 {
    let order = m.unsigned_abs();
    let t = 2.0 * z - 1.0;
    let polynomial = legendre_derivative(l, order).iter().rev().fold(0.0, |sum, c| sum * t + c);
    // (1 - t²)^(m/2), with 1 - z from x and y so that no digits are lost near the pole.
    let sine = (4.0 * z * (x * x + y * y) / (1.0 + z)).sqrt().powi(order as i32);
    let norm = ((2 * l + 1) as f64 * factorial(l - order) / (TAU * factorial(l + order))).sqrt();
    let phi = y.atan2(x);
    let azimuthal = match m {
        0 => 1.0,
        _ if m > 0 => 2.0f64.sqrt() * (m as f64 * phi).cos(),
        _ => 2.0f64.sqrt() * (-m as f64 * phi).sin(),
    };
    norm * polynomial * sine * azimuthal
}

#[test]
fn values_are_those_of_the_printed_formula() {
    for omega in directions() {
        let values = evaluate(MAX_BANDS, omega);
        for l in 0..MAX_BANDS {
            for m in -(l as isize)..=l as isize {
                let (value, expected) = (values[index(l, m)], printed_formula(l, m, omega));
                assert!((value - expected).abs() < 1e-11, "{l} {m} {omega:?}: {value} {expected}");
            }
        }
    }
}

/// Largest deviation of the Gram matrix from the identity, the functions evaluated in `T`.
fn gram_error<T: Real>(back: impl Fn(T) -> f64) -> f64 {
    // In cos θ = s² the integrands are polynomials, of degree 4 · 7 + 1; in φ trigonometric ones of order 14.
    let around = 32;
    let mut gram = vec![0.0f64; MAX_FUNCTIONS * MAX_FUNCTIONS];
    for (s, weight) in gauss_legendre(24) {
        let z = s * s;
        let r = (1.0 - z * z).sqrt();
        for j in 0..around {
            let (sin, cos) = (f64::from(j) * TAU / f64::from(around)).sin_cos();
            let values = evaluate(MAX_BANDS, [T::of(r * cos), T::of(r * sin), T::of(z)]).map(&back);
            let weight = weight * 2.0 * s * TAU / f64::from(around);
            for (i, a) in values.iter().enumerate() {
                for (j, b) in values.iter().enumerate() {
                    gram[i * MAX_FUNCTIONS + j] += weight * a * b;
                }
            }
        }
    }
    let identity = |i: usize| f64::from(u8::from(i.is_multiple_of(MAX_FUNCTIONS + 1)));
    gram.iter().enumerate().map(|(i, g)| (g - identity(i)).abs()).fold(0.0, f64::max)
}

#[test]
fn the_basis_is_orthonormal() {
    let (double, single) = (gram_error::<f64>(|h| h), gram_error::<f32>(f64::from));
    assert!(double < 1e-12, "{double:e}");
    assert!(single < 2e-6, "{single:e}");
}

#[test]
fn fewer_bands_are_the_first_of_them() {
    let omega = [0.48, -0.36, 0.8];
    let all = evaluate(MAX_BANDS, omega);
    for bands in 1..=MAX_BANDS {
        let some = evaluate(bands, omega);
        assert_eq!(some[..bands * bands], all[..bands * bands]);
        assert!(some[bands * bands..].iter().all(|h| *h == 0.0));
    }
    let mut five = [0.0; 25];
    for_each::<f64, 5>(omega, |k, h, _, _| five[k] = h);
    assert_eq!(five, all[..25]);
}

/// Values, and derivatives along u and v, for a source at distance 1.
fn with_derivatives<T: Real>(omega: [T; 3]) -> [[T; 3]; MAX_FUNCTIONS] {
    let mut all = [[T::of(f64::NAN); 3]; MAX_FUNCTIONS];
    for_each::<T, MAX_BANDS>(omega, |k, h, u, v| all[k] = [h, u, v]);
    all
}

#[test]
fn derivatives_agree_with_finite_differences() {
    // Fourth order in the step, so that rounding and truncation both stay below 1e-9.
    let step = 2e-4;
    for omega in directions() {
        let exact = with_derivatives(omega);
        for axis in 0..2 {
            let moved = |by: f64| {
                let mut q = omega;
                q[axis] -= by * step; // the receiver moves one way, the source appears to move the other
                let length = q.iter().map(|c| c * c).sum::<f64>().sqrt();
                evaluate(MAX_BANDS, q.map(|c| c / length))
            };
            let samples = [moved(-2.0), moved(-1.0), moved(1.0), moved(2.0)];
            for k in 0..MAX_FUNCTIONS {
                let [a, b, c, d] = [0, 1, 2, 3].map(|i: usize| samples[i][k]);
                let difference = (a - 8.0 * b + 8.0 * c - d) / (12.0 * step);
                let derivative = exact[k][1 + axis];
                let error = (derivative - difference).abs() / derivative.abs().max(0.1);
                assert!(error < 1e-6, "{k} {axis} {omega:?}: {derivative} {difference} {error:e}");
            }
        }
    }
}

#[test]
fn single_precision_errs_by_little_and_side_by_side_it_is_the_same() {
    let mut error = [0.0f64; 2];
    for omega in directions() {
        // Rounded first, so that only the arithmetic differs.
        let single = omega.map(|c| c as f32);
        let rounded = single.map(f64::from);
        let (exact, values) = (with_derivatives(rounded), with_derivatives(single));
        let lanes = with_derivatives(single.map(|c| f32x8::new(from_fn(|i| if i == 3 { c } else { 0.5 }))));
        for k in 0..MAX_FUNCTIONS {
            for part in 0..3 {
                let e = (f64::from(values[k][part]) - exact[k][part]).abs();
                error[usize::from(part > 0)] = e.max(error[usize::from(part > 0)]);
                assert_eq!(lanes[k][part].as_array()[3], values[k][part]);
            }
        }
    }
    let [value, derivative] = error;
    // Values reach 1.6, derivatives 60.
    assert!(value < 4e-6 && derivative < 1e-5, "{value:e} {derivative:e}");
}

#[test]
fn directions_just_below_the_horizon_count_as_on_it() {
    let (below, on) = (with_derivatives([0.6f32, 0.8, -1e-7]), with_derivatives([0.6f32, 0.8, 0.0]));
    assert_eq!(below, on);
    assert!(below.iter().flatten().all(|h| h.is_finite()));
}
