//! KernelProjection of reflection kernels onto the basis, by quadrature over the hemisphere in double precision.

use super::basis::{CHANNELS, MAX_BANDS, evaluate, index};
use super::kernel::{MAX_EVEN, even_index};
use base::math::{Rgb, gauss_legendre};
use glam::Vec3;
use std::f64::consts::PI;
use world::material::DullLobe;

/// Number of nodes in height. With this number and [`AZIMUTHS`], coefficients and norms are accurate to 1e-5 of the
/// norm at any inclination, for α >= 0.15.
const HEIGHTS: usize = 48;

/// Number of nodes in azimuth.
const AZIMUTHS: usize = 48;

/// Quadrature rule for half the hemisphere; the other half is its mirror image.
pub(super) struct Quadrature {
    rings: Vec<Ring>,
    azimuths: Vec<Azimuth>,
}

/// Directions of one height.
struct Ring {
    z: f64,
    sin: f64,
    weight: f64,
    /// Values of the even functions at azimuth 0.
    even: [f64; MAX_EVEN],
}

struct Azimuth {
    cos: f64,
    sin: f64,
    weight: f64,
    /// Values of cos mφ.
    multiple: [f64; MAX_BANDS],
}

/// Coefficients of the even functions, and squared norm of the projected function, by channel.
#[derive(Clone, Debug)]
pub(super) struct KernelProjection {
    pub coefficients: [[f64; MAX_EVEN]; CHANNELS],
    pub norm_sq: [f64; CHANNELS],
}

/// Projection of a function of height alone, which has functions of order 0 only.
#[derive(Clone, Debug)]
pub(super) struct ZonalProjection {
    pub coefficients: [f64; MAX_BANDS],
    pub norm_sq: f64,
}

impl KernelProjection {
    /// Returns the sum of projections times factors. Its norm is an upper bound, as if the parts that the coefficients
    /// do not hold were parallel.
    pub fn sum(parts: &[(Rgb, &KernelProjection)]) -> KernelProjection {
        let mut sum =
            KernelProjection { coefficients: [[0.0; MAX_EVEN]; CHANNELS], norm_sq: [0.0; CHANNELS] };
        for c in 0..CHANNELS {
            // Norm of the part that the coefficients do not hold.
            let mut left_out = 0.0;
            for (factor, part) in parts {
                let (factor, row) = (f64::from(factor[c]), &part.coefficients[c]);
                for (total, value) in sum.coefficients[c].iter_mut().zip(row) {
                    *total += factor * value;
                }
                left_out += factor * (part.norm_sq[c] - squares(row)).max(0.0).sqrt();
            }
            sum.norm_sq[c] = squares(&sum.coefficients[c]) + left_out * left_out;
        }
        sum
    }
}

/// Sum of squares.
fn squares(row: &[f64]) -> f64 {
    row.iter().map(|value| value * value).sum()
}

impl Quadrature {
    /// Creates the rule for projections of lobes.
    pub fn standard() -> Quadrature {
        Quadrature::new(HEIGHTS, AZIMUTHS)
    }

    /// Creates a rule with these numbers of nodes.
    pub fn new(heights: usize, azimuths: usize) -> Quadrature {
        // As a function of s = √z, the basis is smooth at the horizon, too.
        let ring = |(s, weight): (f64, f64)| {
            let z = s * s;
            let sin = ((1.0 - z) * (1.0 + z)).sqrt();
            let values = evaluate(MAX_BANDS, [sin as f32, 0.0, z as f32]);
            let mut even = [0.0; MAX_EVEN];
            for l in 0..MAX_BANDS {
                for m in 0..=l {
                    even[even_index(l, m)] = f64::from(values[index(l, m as isize)]);
                }
            }
            Ring { z, sin, weight: 2.0 * s * weight, even }
        };
        // Nodes are denser towards azimuth π, the azimuth of the lobe of a surface seen from azimuth 0.
        let azimuth = |(t, weight): (f64, f64)| {
            let phi = PI * (1.0 - t * t);
            let multiple = std::array::from_fn(|m| (m as f64 * phi).cos());
            Azimuth { cos: phi.cos(), sin: phi.sin(), weight: 4.0 * PI * t * weight, multiple }
        };
        Quadrature {
            rings: gauss_legendre(heights).into_iter().map(ring).collect(),
            azimuths: gauss_legendre(azimuths).into_iter().map(azimuth).collect(),
        }
    }

    /// Projects BRDF · cosine of a lobe for the outgoing direction at cosine `cos_o` and azimuth 0.
    pub fn project(&self, lobe: DullLobe, cos_o: f64) -> KernelProjection {
        let cos_o = cos_o.clamp(1e-5, 1.0);
        let wo = Vec3::new(((1.0 - cos_o) * (1.0 + cos_o)).sqrt() as f32, 0.0, cos_o as f32);
        let mut projection =
            KernelProjection { coefficients: [[0.0; MAX_EVEN]; CHANNELS], norm_sq: [0.0; CHANNELS] };
        for ring in &self.rings {
            let mut by_order = [[0.0; MAX_BANDS]; CHANNELS];
            for azimuth in &self.azimuths {
                let wi = [ring.sin * azimuth.cos, ring.sin * azimuth.sin, ring.z].map(|c| c as f32);
                let value: Rgb = lobe.eval(wo, wi.into());
                for c in 0..CHANNELS {
                    let value = f64::from(value[c]) * ring.z;
                    projection.norm_sq[c] += ring.weight * azimuth.weight * value * value;
                    for m in 0..MAX_BANDS {
                        by_order[c][m] += azimuth.weight * value * azimuth.multiple[m];
                    }
                }
            }
            for c in 0..CHANNELS {
                for l in 0..MAX_BANDS {
                    for m in 0..=l {
                        let k = even_index(l, m);
                        projection.coefficients[c][k] += ring.weight * ring.even[k] * by_order[c][m];
                    }
                }
            }
        }
        projection
    }

    /// Projects a function of the height.
    pub fn project_zonal(&self, f: impl Fn(f64) -> f64) -> ZonalProjection {
        let mut projection = ZonalProjection { coefficients: [0.0; MAX_BANDS], norm_sq: 0.0 };
        for ring in &self.rings {
            let (value, weight) = (f(ring.z), 2.0 * PI * ring.weight);
            projection.norm_sq += weight * value * value;
            for l in 0..MAX_BANDS {
                projection.coefficients[l] += weight * value * ring.even[even_index(l, 0)];
            }
        }
        projection
    }
}
