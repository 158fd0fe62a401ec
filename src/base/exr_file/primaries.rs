//! Primaries of the colours of a file, and conversion to those of Rec. 709.

use crate::math::Rgb;
use ::exr::meta::attribute::Chromaticities;
use ::exr::prelude::Vec2;
use glam::{DMat3, DVec3};

/// Chromaticities of Rec. 709 with the white D65.
pub const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Difference of chromaticities that makes no visible difference.
const TOLERANCE: f32 = 1e-3;

/// Bradford matrix from XYZ to cone responses (Lam 1985; ICC.1:2010, annex E).
const BRADFORD: DMat3 = DMat3::from_cols(
    DVec3::new(0.8951, -0.7502, 0.0389),
    DVec3::new(0.2664, 1.7135, -0.0685),
    DVec3::new(-0.1614, 0.0367, 1.0296),
);

/// Meaning of the colours of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    /// Luminance of each primary; the sum is 1.
    pub weights: Rgb,
    /// Matrix to linear Rec. 709; `None` if the colours are Rec. 709 already.
    pub to_rec_709: Option<DMat3>,
}

impl Primaries {
    /// Returns the meaning of colours with the chromaticities of a file, by default those of Rec. 709.
    ///
    /// Whites other than D65 are adapted by the Bradford transform, so that white stays white. `None` if the
    /// chromaticities span no colours.
    pub fn new(chromaticities: Option<Chromaticities>) -> Option<Primaries> {
        let own = chromaticities.unwrap_or(REC_709);
        let to_xyz = to_xyz(&own)?;
        // Luminances are the second row.
        let weights = to_xyz.row(1);
        let weights = (weights / weights.element_sum()).as_vec3();
        let differs = |a: Vec2<f32>, b: Vec2<f32>| !((a.0 - b.0).abs().max((a.1 - b.1).abs()) <= TOLERANCE);
        let is_rec_709 = !(differs(own.red, REC_709.red)
            || differs(own.green, REC_709.green)
            || differs(own.blue, REC_709.blue)
            || differs(own.white, REC_709.white));
        if is_rec_709 {
            return Some(Primaries { weights, to_rec_709: None });
        }
        let [from, to] = [own.white, REC_709.white].map(|white| BRADFORD * white_xyz(white));
        let adapt = BRADFORD.inverse() * DMat3::from_diagonal(to / from) * BRADFORD;
        let matrix = self::to_xyz(&REC_709)?.inverse() * adapt * to_xyz;
        matrix.is_finite().then_some(Primaries { weights, to_rec_709: Some(matrix) })
    }

    /// Returns a colour of the file in linear Rec. 709. Colours outside its gamut are clipped at 0.
    pub fn rec_709(&self, colour: Rgb) -> Rgb {
        match self.to_rec_709 {
            Some(matrix) => (matrix * colour.as_dvec3()).as_vec3().max(colour.min(Rgb::ZERO)),
            None => colour,
        }
    }
}

/// Returns the colour of a white of luminance 1.
fn white_xyz(white: Vec2<f32>) -> DVec3 {
    let (x, y) = (f64::from(white.0), f64::from(white.1));
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// Returns the matrix to XYZ, with white of luminance 1; `None` if the primaries span no colours.
fn to_xyz(of: &Chromaticities) -> Option<DMat3> {
    let column = |at: Vec2<f32>| {
        let (x, y) = (f64::from(at.0), f64::from(at.1));
        DVec3::new(x, y, 1.0 - x - y)
    };
    let primaries = DMat3::from_cols(column(of.red), column(of.green), column(of.blue));
    let shares = primaries.inverse() * white_xyz(of.white);
    let matrix = primaries * DMat3::from_diagonal(shares);
    (primaries.determinant().abs() > 1e-9 && matrix.is_finite() && matrix.row(1).min_element() > 0.0)
        .then_some(matrix)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rec_709_stays_and_its_weights_are_the_standards() {
        let own = Primaries::new(None).unwrap();
        assert!((own.weights - crate::math::LUMINANCE).abs().max_element() < 1e-4, "{}", own.weights);
        assert_eq!(own.rec_709(Rgb::new(-1.0, 0.5, 7.0)), Rgb::new(-1.0, 0.5, 7.0));
    }

    #[test]
    fn colours_of_wider_primaries_become_those_of_rec_709() {
        // Rec. 2020 to Rec. 709 by ITU-R BT.2087, which rounds to four digits.
        let wide = Chromaticities {
            red: Vec2(0.708, 0.292),
            green: Vec2(0.170, 0.797),
            blue: Vec2(0.131, 0.046),
            white: Vec2(0.3127, 0.3290),
        };
        let own = Primaries::new(Some(wide)).unwrap();
        let rows = own.to_rec_709.unwrap().transpose();
        for (row, right) in [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().zip([
            DVec3::new(1.6605, -0.5876, -0.0728),
            DVec3::new(-0.1246, 1.1329, -0.0083),
            DVec3::new(-0.0182, -0.1006, 1.1187),
        ]) {
            assert!((row - right).abs().max_element() < 1e-4, "{row} instead of {right}");
        }
        assert!((own.rec_709(Rgb::ONE) - Rgb::ONE).abs().max_element() < 1e-6);
        // Green outside the gamut is clipped.
        assert_eq!(own.rec_709(Rgb::Y).min_element(), 0.0);
    }

    #[test]
    fn other_whites_stay_white_and_primaries_on_a_line_are_none() {
        let d60 = Chromaticities { white: Vec2(0.32168, 0.33767), ..REC_709 };
        let white = Primaries::new(Some(d60)).unwrap().rec_709(Rgb::ONE);
        assert!((white - Rgb::ONE).abs().max_element() < 1e-6, "{white}");
        assert_eq!(Primaries::new(Some(Chromaticities { blue: REC_709.red, ..REC_709 })), None);
        assert_eq!(Primaries::new(Some(Chromaticities { white: Vec2(0.3, 0.0), ..REC_709 })), None);
        assert_eq!(Primaries::new(Some(Chromaticities { green: Vec2(f32::NAN, 1.0), ..REC_709 })), None);
    }
}
