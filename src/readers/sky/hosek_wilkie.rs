//! Radiance of a clear sky and of the sun.
//!
//! Parameters are the sun's elevation, the turbidity of the air, and the albedo of the ground.
//!
//! Papers: L. Hosek & A. Wilkie, *An Analytic Model for Full Spectral Sky-Dome Radiance*, SIGGRAPH 2012 (Eq. 8);
//! *Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model*, IEEE CG&A 33(3), 2013. The coefficients are
//! the authors' for linear Rec. 709 (`hosek_wilkie.bin`, see LICENSE there), in the units of Mitsuba 3.
//!
//! Deviations:
//! - The sun is even, with its mean radiance over the darkened limb. Mitsuba 3.9.1 interpolates that mean linearly from
//!   a table of 30 elevations, which is up to 2 % off above 7°.
//! - Negative channels are 0. They occur because colours of a low sun lie outside Rec. 709.
//!
//! Units: angles in radians, radiance in W/(sr m²).

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Minimum and maximum turbidity of the model.
pub const TURBIDITIES: [f64; 2] = [1.0, 10.0];

/// Diameter of the sun, in degrees.
pub const SUN_ANGLE: f64 = 0.5358;

static TABLES: &[u8] = include_bytes!("hosek_wilkie.bin");
const CHANNELS: usize = 3;
const PARAMETERS: usize = 9;
const CONTROL_POINTS: usize = 6;
const ALBEDOS: usize = 2;
const SUN_SEGMENTS: usize = 45;
const SUN_POWERS: usize = 4;
/// First entry of the table of radiance.
const RADIANCE: usize = 10 * ALBEDOS * CONTROL_POINTS * CHANNELS * PARAMETERS;
/// First entry of the table of the sun.
const SUN: usize = RADIANCE + 10 * ALBEDOS * CONTROL_POINTS * CHANNELS;

/// Factor from the model's units to luminous watts, as in Mitsuba 3.
const PER_LUMEN: f64 = 1.0 / 106.750_259_4;
/// Factor from the sun's units to the sky's, as in Mitsuba 3.
const SUN_UNITS: f64 = 467.069_280_386;

/// A sky for one elevation of the sun.
#[derive(Clone, Debug)]
pub struct ClearSky {
    /// Parameters A to I of Eq. 8, per channel.
    parameters: [[f64; PARAMETERS]; CHANNELS],
    /// Mean radiance of the sky.
    radiance: DVec3,
}

impl ClearSky {
    /// Returns the sky for a sun at `elevation` above the horizon and a turbidity in [`TURBIDITIES`].
    pub fn new(turbidity: f64, albedo: DVec3, elevation: f64) -> ClearSky {
        let x = (elevation.clamp(0.0, FRAC_PI_2) / FRAC_PI_2).cbrt();
        let bezier: [f64; CONTROL_POINTS] = std::array::from_fn(|k| {
            [1.0, 5.0, 10.0, 10.0, 5.0, 1.0][k] * x.powi(k as i32) * (1.0 - x).powi(5 - k as i32)
        });
        let weights = turbidity_weights(turbidity);
        let interpolate = |channel: usize, entry: &dyn Fn(usize) -> f64| {
            let mut sum = 0.0;
            for (level, weight) in weights {
                for (ground, share) in [(0, 1.0 - albedo[channel]), (1, albedo[channel])] {
                    for (k, b) in bezier.iter().enumerate() {
                        let row = (level * ALBEDOS + ground) * CONTROL_POINTS + k;
                        sum += weight * share * b * entry(row * CHANNELS + channel);
                    }
                }
            }
            sum
        };
        ClearSky {
            parameters: std::array::from_fn(|channel| {
                std::array::from_fn(|p| interpolate(channel, &|row| table(row * PARAMETERS + p)))
            }),
            radiance: DVec3::from(
                [0, 1, 2].map(|channel| interpolate(channel, &|row| table(RADIANCE + row))),
            ),
        }
    }

    /// Returns the radiance from a direction above the horizon: `cos_theta` is the cosine to the zenith, `gamma` the
    /// angle to the sun.
    pub fn radiance(&self, cos_theta: f64, gamma: f64) -> DVec3 {
        let cos_gamma = gamma.cos();
        let channel = |[a, b, c, d, e, f, g, h, i]: [f64; PARAMETERS]| {
            let chi = (1.0 + cos_gamma * cos_gamma) / (1.0 + i * i - 2.0 * i * cos_gamma).powf(1.5);
            let haze = 1.0 + a * (b / (cos_theta + 0.01)).exp();
            let glow = d * (e * gamma).exp() + f * cos_gamma * cos_gamma + g * chi;
            haze * (c + glow + h * cos_theta.max(0.0).sqrt())
        };
        let relative = DVec3::from(self.parameters.map(channel));
        (relative * self.radiance * PER_LUMEN).max(DVec3::ZERO)
    }
}

/// Returns the mean radiance over the disc of the sun, [`SUN_ANGLE`] wide, at `elevation`.
pub fn sun_radiance(turbidity: f64, elevation: f64) -> DVec3 {
    let elevation = elevation.clamp(0.0, FRAC_PI_2);
    let at = (elevation / FRAC_PI_2).cbrt() * SUN_SEGMENTS as f64;
    let segment = (at as usize).min(SUN_SEGMENTS - 1);
    let x = elevation - 0.5 * PI * (segment as f64 / SUN_SEGMENTS as f64).powi(3);
    let channel = |channel: usize| {
        let polynomial = |(level, weight): (usize, f64)| {
            let row = SUN + ((level * SUN_SEGMENTS + segment) * CHANNELS + channel) * SUN_POWERS;
            (0..SUN_POWERS).map(|k| weight * table(row + k) * x.powi(k as i32)).sum::<f64>()
        };
        turbidity_weights(turbidity).map(polynomial).iter().sum::<f64>()
    };
    (DVec3::from([0, 1, 2].map(channel)) * (PER_LUMEN * SUN_UNITS)).max(DVec3::ZERO)
}

/// Returns the two levels of turbidity around one, and their weights.
fn turbidity_weights(turbidity: f64) -> [(usize, f64); 2] {
    let at = turbidity.clamp(TURBIDITIES[0], TURBIDITIES[1]) - 1.0;
    let level = (at as usize).min(8);
    let f = at - level as f64;
    [(level, 1.0 - f), (level + 1, f)]
}

/// Returns an entry of the tables.
fn table(index: usize) -> f64 {
    let bytes = TABLES.get(4 * index..4 * index + 4).and_then(|bytes| bytes.try_into().ok());
    f64::from(f32::from_le_bytes(bytes.unwrap_or_default()))
}
