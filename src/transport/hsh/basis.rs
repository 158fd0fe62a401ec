//! Basis functions and their derivatives as the receiver moves.
//!
//! With ω = (x, y, z), t = 2z - 1 and σ² = 4z / (1 + z), H_l^m = N Q_l^m(t) · {Re, Im} (σ(x + iy))^|m|, Q_l^m
//! = dᵐP_l / dtᵐ, N² = (2l + 1)(l - m)! / (2π(l + m)!), twice that for m ≠ 0. Q is computed by the recurrence
//! in l of its normalised form. Its derivative is Q of the next order.
//!
//! The direction ω of a source at distance |q| changes as the receiver moves. The derivative by motion along the
//! tangent u is, with C = {Re, Im} (x + iy)^m and |∂ω| = 1 / |q|,
//! |q| ∂_u H = N { ω_u σᵐ C [ mQ + 2zQ' + mQ / (2(1 + z)) ] - σᵐ Q ∂C/∂u }.
//!
//! Paper: Gautron et al. 2004, equations 3 and 4.
//! Deviations: the paper uses angles, which are singular at the pole and, differentiated, at the horizon. Here the
//! functions are polynomials in x and y, which are finite everywhere with their derivatives.

use base::math::Lane;
use std::f64::consts::PI;

/// Number of colour channels.
pub const CHANNELS: usize = 3;

/// Maximum number of bands of an expansion.
pub const MAX_BANDS: usize = 8;

/// Number of functions in [`MAX_BANDS`] bands.
pub const MAX_FUNCTIONS: usize = MAX_BANDS * MAX_BANDS;

/// Index of the function of degree `l` and order `m`, |m| <= l.
#[inline]
pub const fn index(l: usize, m: isize) -> usize {
    (l * l + l).wrapping_add_signed(m)
}

/// Constants of the recurrence by `[l][m]`.
struct Recurrence {
    /// Constant N Q_m^m.
    start: [f64; MAX_BANDS],
    /// Factor of t times the function one degree lower.
    first: [[f64; MAX_BANDS]; MAX_BANDS],
    /// Factor of the function two degrees lower, which is subtracted.
    second: [[f64; MAX_BANDS]; MAX_BANDS],
    /// N Q' in units of the normalised function of the next order.
    derivative: [[f64; MAX_BANDS]; MAX_BANDS],
}

const RECURRENCE: Recurrence = {
    let mut r = Recurrence {
        start: [0.0; MAX_BANDS],
        first: [[0.0; MAX_BANDS]; MAX_BANDS],
        second: [[0.0; MAX_BANDS]; MAX_BANDS],
        derivative: [[0.0; MAX_BANDS]; MAX_BANDS],
    };
    let mut m = 0;
    while m < MAX_BANDS {
        let m_f = m as f64;
        // N Q_m^m = (2m - 1)!! N: its square grows by (2m + 1) / 2m with each order, and twice for the first.
        let mut square = 1.0 / (2.0 * PI);
        let mut i = 1;
        while i <= m {
            let doubled = if i == 1 { 2.0 } else { 1.0 };
            square *= doubled * (2 * i + 1) as f64 / (2 * i) as f64;
            i += 1;
        }
        r.start[m] = sqrt(square);
        let mut l = m;
        while l < MAX_BANDS {
            let l_f = l as f64;
            if l > m {
                let difference = l_f * l_f - m_f * m_f;
                r.first[l][m] = sqrt((4.0 * l_f * l_f - 1.0) / difference);
                let below = (l_f - 1.0) * (l_f - 1.0) - m_f * m_f;
                r.second[l][m] = sqrt((2.0 * l_f + 1.0) * below / ((2.0 * l_f - 3.0) * difference));
            }
            let halved = if m == 0 { 0.5 } else { 1.0 };
            r.derivative[l][m] = sqrt(halved * (l_f - m_f) * (l_f + m_f + 1.0));
            l += 1;
        }
        m += 1;
    }
    r
};

/// Computes a square root at compile time, by Newton's method from above.
const fn sqrt(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let mut root = if x > 1.0 { x } else { 1.0 };
    let mut i = 0;
    while i < 64 {
        root = 0.5 * (root + x / root);
        i += 1;
    }
    root
}

/// Calls `f(k, H, |q| ∂_u H, |q| ∂_v H)` for each function of the first `BANDS` bands at the direction ω.
///
/// Directions slightly below the horizon, which rounding produces, are moved to it. The compiler removes arguments that
/// `f` does not use.
#[inline(always)]
pub fn for_each<L: Lane, const BANDS: usize>(omega: [L; 3], mut f: impl FnMut(usize, L, L, L)) {
    const { assert!(BANDS >= 1 && BANDS <= MAX_BANDS) };
    let [x, y, z] = omega;
    let z = z.positive();
    let above = L::from(1.0) + z;
    let sigma = (L::from(4.0) * z / above).sqrt();
    let (scaled_x, scaled_y) = (sigma * x, sigma * y);
    // (σ(x + iy))^m
    let mut power = [(L::from(1.0), L::from(0.0)); MAX_BANDS];
    for m in 1..BANDS {
        let (re, im) = power[m - 1];
        power[m] = (scaled_x * re - scaled_y * im, scaled_x * im + scaled_y * re);
    }
    let t = z + z - L::from(1.0);
    let half_inverse = L::from(0.5) / above;
    let mut next_order = [L::from(0.0); MAX_BANDS];
    for m in (0..BANDS).rev() {
        let order = L::from(m as f32);
        let (re, im) = power[m];
        // σᵐ times the derivatives of (x + iy)^m by x
        let (re_x, im_x) = match m {
            0 => (L::from(0.0), L::from(0.0)),
            _ => (order * sigma * power[m - 1].0, order * sigma * power[m - 1].1),
        };
        let scaling = order + order * half_inverse;
        let mut column = [L::from(0.0); MAX_BANDS];
        for l in m..BANDS {
            let q = match l - m {
                0 => L::from(RECURRENCE.start[m] as f32),
                1 => L::from(RECURRENCE.first[l][m] as f32) * (t * column[l - 1]),
                _ => {
                    L::from(RECURRENCE.first[l][m] as f32) * (t * column[l - 1])
                        - L::from(RECURRENCE.second[l][m] as f32) * column[l - 2]
                }
            };
            column[l] = q;
            let slope = L::from(RECURRENCE.derivative[l][m] as f32) * next_order[l];
            let radial = scaling * q + (z + z) * slope;
            // The derivatives by y are the exchanged derivatives by x (Cauchy-Riemann equations).
            let (along, across) = (re * radial, im * radial);
            f(index(l, m as isize), q * re, x * along - q * re_x, y * along + q * im_x);
            if m > 0 {
                f(index(l, -(m as isize)), q * im, x * across - q * im_x, y * across - q * re_x);
            }
        }
        next_order = column;
    }
}

/// Evaluates the first `bands`² functions at ω, `bands` in 1..=8; other values are 0.
pub fn evaluate(bands: usize, omega: [f32; 3]) -> [f32; MAX_FUNCTIONS] {
    let mut values = [0.0; MAX_FUNCTIONS];
    for_each::<f32, MAX_BANDS>(omega, |k, h, _, _| values[k] = h);
    values[bands.min(MAX_BANDS).pow(2)..].fill(0.0);
    values
}
