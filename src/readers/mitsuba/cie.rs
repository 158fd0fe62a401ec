//! Linear Rec. 709 colours of sampled spectra.
//!
//! Sources: CIE 015:2018, tables 1 and 6: colour-matching functions of the 2° observer of 1931, and illuminant D65.
//! Values are linear between the table's wavelengths, every 5 nm.
//!
//! Units: wavelengths in nm.

use crate::colour_profile::XYZ_TO_RGB;
use glam::DVec3;

/// First wavelength of the tables.
const FIRST: f64 = 360.0;

/// Distance between wavelengths of the tables.
const SPACING: f64 = 5.0;

/// Number of wavelengths at which a spectrum is evaluated, as in Mitsuba.
const STEPS: usize = 1000;

/// Returns the colour of a spectrum. `samples` are wavelengths in ascending order and values, linear between them and
/// zero outside.
///
/// A reflectance is seen under D65, so that 1 everywhere is white. Emitted light is not weighted.
pub(super) fn rgb_of_samples(samples: &[(f64, f64)], is_reflectance: bool) -> DVec3 {
    let last = FIRST + SPACING * (XYZ.len() - 1) as f64;
    let (mut sum, mut white) = (DVec3::ZERO, 0.0);
    for step in 0..STEPS {
        let wavelength = FIRST + (last - FIRST) * step as f64 / (STEPS - 1) as f64;
        let at = (wavelength - FIRST) / SPACING;
        let row = (at as usize).min(XYZ.len() - 2);
        let f = at - row as f64;
        let xyz = DVec3::from(XYZ[row]).lerp(DVec3::from(XYZ[row + 1]), f);
        let light = if is_reflectance { D65[row] + (D65[row + 1] - D65[row]) * f } else { 1.0 };
        white += xyz.y * light;
        sum += xyz * light * value(samples, wavelength);
    }
    XYZ_TO_RGB * (sum / white)
}

/// Returns the radiance of a black body in W/(sr m² nm) by wavelength; `temperature` is in kelvin.
///
/// Source: Planck's law, with the constants of the SI.
pub(super) fn blackbody(temperature: f64) -> Vec<(f64, f64)> {
    const PLANCK: f64 = 6.62607015e-34;
    const LIGHT_SPEED: f64 = 299_792_458.0;
    const BOLTZMANN: f64 = 1.380649e-23;
    let at = |row: usize| {
        let wavelength = FIRST + SPACING * row as f64;
        let metres = wavelength * 1e-9;
        let exponent = PLANCK * LIGHT_SPEED / (metres * BOLTZMANN * temperature);
        (wavelength, 2e-9 * PLANCK * LIGHT_SPEED * LIGHT_SPEED / (metres.powi(5) * exponent.exp_m1()))
    };
    (0..XYZ.len()).map(at).collect()
}

fn value(samples: &[(f64, f64)], wavelength: f64) -> f64 {
    let next = samples.partition_point(|sample| sample.0 <= wavelength);
    match (next.checked_sub(1).map(|i| samples[i]), samples.get(next)) {
        (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (wavelength - x0) / (x1 - x0),
        (Some((x0, y0)), None) if x0 == wavelength => y0,
        _ => 0.0,
    }
}

/// Colour-matching functions x, y and z.
#[rustfmt::skip]
const XYZ: [[f64; 3]; 95] = [
    [0.0001299, 3.917e-6, 0.0006061], [0.0002321, 6.965e-6, 0.001086], [0.0004149, 1.239e-5, 0.001946],
    [0.0007416, 2.202e-5, 0.003486], [0.001368, 3.9e-5, 0.00645], [0.002236, 6.4e-5, 0.01055],
    [0.004243, 0.00012, 0.02005], [0.00765, 0.000217, 0.03621], [0.01431, 0.000396, 0.06785],
    [0.02319, 0.00064, 0.1102], [0.04351, 0.00121, 0.2074], [0.07763, 0.00218, 0.3713],
    [0.13438, 0.004, 0.6456], [0.21477, 0.0073, 1.03905], [0.2839, 0.0116, 1.3856],
    [0.3285, 0.01684, 1.62296], [0.34828, 0.023, 1.74706], [0.34806, 0.0298, 1.7826],
    [0.3362, 0.038, 1.77211], [0.3187, 0.048, 1.7441], [0.2908, 0.06, 1.6692],
    [0.2511, 0.0739, 1.5281], [0.19536, 0.09098, 1.28764], [0.1421, 0.1126, 1.0419],
    [0.09564, 0.13902, 0.81295], [0.05795, 0.1693, 0.6162], [0.03201, 0.20802, 0.46518],
    [0.0147, 0.2586, 0.3533], [0.0049, 0.323, 0.272], [0.0024, 0.4073, 0.2123],
    [0.0093, 0.503, 0.1582], [0.0291, 0.6082, 0.1117], [0.06327, 0.71, 0.07825],
    [0.1096, 0.7932, 0.05725], [0.1655, 0.862, 0.04216], [0.22575, 0.91485, 0.02984],
    [0.2904, 0.954, 0.0203], [0.3597, 0.9803, 0.0134], [0.43345, 0.99495, 0.00875],
    [0.51205, 1.0, 0.00575], [0.5945, 0.995, 0.0039], [0.6784, 0.9786, 0.00275],
    [0.7621, 0.952, 0.0021], [0.8425, 0.9154, 0.0018], [0.9163, 0.87, 0.00165],
    [0.9786, 0.8163, 0.0014], [1.0263, 0.757, 0.0011], [1.0567, 0.6949, 0.001],
    [1.0622, 0.631, 0.0008], [1.0456, 0.5668, 0.0006], [1.0026, 0.503, 0.00034],
    [0.9384, 0.4412, 0.00024], [0.85445, 0.381, 0.00019], [0.7514, 0.321, 0.0001],
    [0.6424, 0.265, 5.0e-5], [0.5419, 0.217, 3.0e-5], [0.4479, 0.175, 2.0e-5],
    [0.3608, 0.1382, 1.0e-5], [0.2835, 0.107, 0.0], [0.2187, 0.0816, 0.0],
    [0.1649, 0.061, 0.0], [0.1212, 0.04458, 0.0], [0.0874, 0.032, 0.0],
    [0.0636, 0.0232, 0.0], [0.04677, 0.017, 0.0], [0.0329, 0.01192, 0.0],
    [0.0227, 0.00821, 0.0], [0.01584, 0.005723, 0.0], [0.0113592, 0.004102, 0.0],
    [0.00811092, 0.002929, 0.0], [0.00579035, 0.002091, 0.0], [0.00410946, 0.001484, 0.0],
    [0.00289933, 0.001047, 0.0], [0.00204919, 0.00074, 0.0], [0.00143997, 0.00052, 0.0],
    [0.000999949, 0.0003611, 0.0], [0.000690079, 0.0002492, 0.0], [0.000476021, 0.0001719, 0.0],
    [0.000332301, 0.00012, 0.0], [0.000234826, 8.48e-5, 0.0], [0.00016615, 6.0e-5, 0.0],
    [0.000117413, 4.24e-5, 0.0], [8.30753e-5, 3.0e-5, 0.0], [5.87065e-5, 2.12e-5, 0.0],
    [4.15099e-5, 1.499e-5, 0.0], [2.93533e-5, 1.06e-5, 0.0], [2.06738e-5, 7.4657e-6, 0.0],
    [1.45598e-5, 5.2578e-6, 0.0], [1.0254e-5, 3.7029e-6, 0.0], [7.22146e-6, 2.6078e-6, 0.0],
    [5.08587e-6, 1.8366e-6, 0.0], [3.58165e-6, 1.2934e-6, 0.0], [2.52252e-6, 9.1093e-7, 0.0],
    [1.77651e-6, 6.4153e-7, 0.0], [1.25114e-6, 4.5181e-7, 0.0],
];

/// D65, relative to its power at 560 nm.
#[rustfmt::skip]
const D65: [f64; 95] = [
    0.466383, 0.493637, 0.520891, 0.510323, 0.499755, 0.523118, 0.546482, 0.687015, 0.827549, 0.871204,
    0.91486, 0.924589, 0.934318, 0.90057, 0.866823, 0.957736, 1.04865, 1.10936, 1.17008, 1.1741,
    1.17812, 1.16336, 1.14861, 1.15392, 1.15923, 1.12367, 1.08811, 1.09082, 1.09354, 1.08578,
    1.07802, 1.06296, 1.0479, 1.06239, 1.07689, 1.06047, 1.04405, 1.04225, 1.04046, 1.02023,
    1.0, 0.981671, 0.963342, 0.960611, 0.95788, 0.922368, 0.886856, 0.893459, 0.900062, 0.898026,
    0.895991, 0.886489, 0.876987, 0.854936, 0.832886, 0.834939, 0.836992, 0.81863, 0.800268, 0.801207,
    0.802146, 0.812462, 0.822778, 0.80281, 0.782842, 0.740027, 0.697213, 0.706652, 0.716091, 0.72979,
    0.74349, 0.679765, 0.61604, 0.657448, 0.698856, 0.724863, 0.75087, 0.693398, 0.635927, 0.550054,
    0.464182, 0.566118, 0.668054, 0.650941, 0.633828, 0.638434, 0.64304, 0.618779, 0.594519, 0.557054,
    0.51959, 0.546998, 0.574406, 0.588765, 0.603125,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_mitsubas() {
        // Computed by Mitsuba 3.9.1, scalar_rgb.
        let samples = [(400.0, 0.2), (500.0, 0.3), (600.0, 0.8), (700.0, 0.6)];
        let reflectance = rgb_of_samples(&samples, true);
        assert!((reflectance - DVec3::new(0.871727, 0.510388, 0.212802)).length() < 2e-3, "{reflectance}");
        let strong = [(400.0, 0.2), (500.0, 0.3), (600.0, 8.0), (700.0, 0.6)];
        let light = rgb_of_samples(&strong, false);
        assert!((light - DVec3::new(9.31634, 3.46937, -0.308329)).length() < 2e-2, "{light}");
        // Computed by scalar_spectral, whose noise is 0.5 %.
        for (temperature, expected) in [
            (3000.0, DVec3::new(732.9, 350.0, 110.6)),
            (5000.0, DVec3::new(15233.0, 12106.0, 9457.5)),
            (6500.0, DVec3::new(43801.0, 41497.0, 43015.0)),
        ] {
            let radiance = rgb_of_samples(&blackbody(temperature), false);
            assert!((radiance / expected - 1.0).abs().max_element() < 0.02, "{radiance} {expected}");
        }
        assert!((rgb_of_samples(&[(300.0, 1.0), (900.0, 1.0)], true) - DVec3::ONE).length() < 2e-3);
    }
}
