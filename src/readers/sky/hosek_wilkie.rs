//! Radiance of a clear sky and of the sun, by height of the sun, turbidity of the air and albedo of the ground.
//!
//! Papers: L. Hosek & A. Wilkie, *An Analytic Model for Full Spectral Sky-Dome Radiance*, SIGGRAPH 2012 (Eq. 8);
//! *Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model*, IEEE CG&A 33(3), 2013. The coefficients are
//! the authors' for linear Rec. 709 (`hosek_wilkie.bin`, see LICENSE there), in the units of Mitsuba 3.
//!
//! Deviations: the sun shines evenly, with the mean over its darkened limb. Mitsuba 3.9.1 does so too, but reads it
//! from a table of 30 heights, between which it is linear: up to 2 % off above 7°, far off in blue below. Channels
//! that are negative, because colours of a low sun lie outside Rec. 709, are 0.
//!
//! Units: angles in radians, radiance in W/(sr m²).

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Least and greatest turbidity that the model knows.
pub const TURBIDITIES: [f64; 2] = [1.0, 10.0];

/// Diameter of the sun, degrees.
pub const SUN_ANGLE: f64 = 0.5358;

static TABLES: &[u8] = include_bytes!("hosek_wilkie.bin");
const CHANNELS: usize = 3;
const PARAMETERS: usize = 9;
const CONTROL_POINTS: usize = 6;
const ALBEDOS: usize = 2;
const SUN_SEGMENTS: usize = 45;
const SUN_POWERS: usize = 4;
/// First entries of the tables of radiance and of the sun.
const RADIANCE: usize = 10 * ALBEDOS * CONTROL_POINTS * CHANNELS * PARAMETERS;
const SUN: usize = RADIANCE + 10 * ALBEDOS * CONTROL_POINTS * CHANNELS;

/// Factor from the model's units to luminous watts, and that of the sun's to the sky's, as in Mitsuba 3.
const PER_LUMEN: f64 = 1.0 / 106.750_259_4;
const SUN_UNITS: f64 = 467.069_280_386;

/// The sky at one height of the sun.
#[derive(Clone, Debug)]
pub struct ClearSky {
    /// Parameters A to I of Eq. 8, by channel.
    parameters: [[f64; PARAMETERS]; CHANNELS],
    /// Mean radiance.
    radiance: DVec3,
}

impl ClearSky {
    /// The sky of a sun `elevation` above the horizon, for a turbidity in [`TURBIDITIES`].
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

    /// Radiance from a direction above the horizon of cosine `cos_theta` to the zenith and at `gamma` from the sun.
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

/// Mean radiance over the disc of the sun, [`SUN_ANGLE`] wide, at `elevation`.
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

/// Levels of turbidity around one, and their weights.
fn turbidity_weights(turbidity: f64) -> [(usize, f64); 2] {
    let at = turbidity.clamp(TURBIDITIES[0], TURBIDITIES[1]) - 1.0;
    let level = (at as usize).min(8);
    let f = at - level as f64;
    [(level, 1.0 - f), (level + 1, f)]
}

/// Entry of the tables.
fn table(index: usize) -> f64 {
    let bytes = TABLES.get(4 * index..4 * index + 4).and_then(|bytes| bytes.try_into().ok());
    f64::from(f32::from_le_bytes(bytes.unwrap_or_default()))
}
