//! The basis against its defining properties: orthonormality, the formula in angles, finite differences.

use crate::hsh::basis::*;
use base::math::{Lane, f32x16, gauss_legendre};
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

/// All functions by the printed formula.
pub(super) fn printed_functions(omega: [f64; 3]) -> [f64; MAX_FUNCTIONS] {
    let mut values = [0.0; MAX_FUNCTIONS];
    for l in 0..MAX_BANDS {
        for m in -(l as isize)..=l as isize {
            values[index(l, m)] = printed_formula(l, m, omega);
        }
    }
    values
}

#[test]
fn the_basis_is_orthonormal() {
    // In cos θ = s² the integrands are polynomials, of degree 4 · 7 + 1; in φ trigonometric ones of order 14.
    let around = 32;
    let mut gram = vec![0.0f64; MAX_FUNCTIONS * MAX_FUNCTIONS];
    for (s, weight) in gauss_legendre(24) {
        let z = s * s;
        let r = (1.0 - z * z).sqrt();
        for j in 0..around {
            let (sin, cos) = (f64::from(j) * TAU / f64::from(around)).sin_cos();
            let values = evaluate(MAX_BANDS, [r * cos, r * sin, z].map(|c| c as f32)).map(f64::from);
            let weight = weight * 2.0 * s * TAU / f64::from(around);
            for (i, a) in values.iter().enumerate() {
                for (j, b) in values.iter().enumerate() {
                    gram[i * MAX_FUNCTIONS + j] += weight * a * b;
                }
            }
        }
    }
    let identity = |i: usize| f64::from(u8::from(i.is_multiple_of(MAX_FUNCTIONS + 1)));
    let error = gram.iter().enumerate().map(|(i, g)| (g - identity(i)).abs()).fold(0.0, f64::max);
    assert!(error < 2e-6, "{error:e}");
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
    for_each::<f32, 5>(omega, |k, h, _, _| five[k] = h);
    assert_eq!(five, all[..25]);
}

/// Values, and derivatives along u and v, for a source at distance 1.
fn with_derivatives<L: Lane>(omega: [L; 3]) -> [[L; 3]; MAX_FUNCTIONS] {
    let mut all = [[L::from(f32::NAN); 3]; MAX_FUNCTIONS];
    for_each::<L, MAX_BANDS>(omega, |k, h, u, v| all[k] = [h, u, v]);
    all
}

#[test]
fn values_and_derivatives_are_those_of_the_printed_formula() {
    // Fourth order in the step, so that rounding and truncation both stay below 1e-7.
    let step = 2e-4;
    let (mut value, mut derivative) = (0.0f64, 0.0f64);
    for omega in directions() {
        // Rounded first, so that only the arithmetic differs.
        let single = omega.map(|c| c as f32);
        let omega = single.map(f64::from);
        let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let found = with_derivatives(single);
        let exact = printed_functions(omega);
        for k in 0..MAX_FUNCTIONS {
            value = value.max((f64::from(found[k][0]) - exact[k]).abs());
        }
        // The printed formula has a root that is singular at the horizon.
        if omega[2] < 0.01 {
            continue;
        }
        for axis in 0..2 {
            let moved = |by: f64| {
                let mut q = omega;
                q[axis] -= by * step; // the receiver moves one way, the source appears to move the other
                let length = length(q);
                printed_functions(q.map(|c| c / length))
            };
            let samples = [moved(-2.0), moved(-1.0), moved(1.0), moved(2.0)];
            for k in 0..MAX_FUNCTIONS {
                let [a, b, c, d] = [0, 1, 2, 3].map(|i: usize| samples[i][k]);
                let difference = (a - 8.0 * b + 8.0 * c - d) / (12.0 * step);
                derivative = derivative.max((f64::from(found[k][1 + axis]) - difference).abs());
            }
        }
    }
    // Values reach 1.6, derivatives 60.
    assert!(value < 4e-6 && derivative < 1e-5, "{value:e} {derivative:e}");
}

#[test]
fn sixteen_directions_have_the_values_of_each() {
    for omega in directions() {
        let single = omega.map(|c| c as f32);
        let values = with_derivatives(single);
        let lanes = with_derivatives(single.map(|c| f32x16::from_fn(|i| if i == 3 { c } else { 0.5 })));
        for k in 0..MAX_FUNCTIONS {
            assert_eq!(lanes[k].map(|part| part.lane(3)), values[k]);
        }
    }
}

#[test]
fn directions_just_below_the_horizon_count_as_on_it() {
    let (below, on) = (with_derivatives([0.6f32, 0.8, -1e-7]), with_derivatives([0.6f32, 0.8, 0.0]));
    assert_eq!(below, on);
    assert!(below.iter().flatten().all(|h| h.is_finite()));
}
