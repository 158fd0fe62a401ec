//! Attenuation of light inside glass, as files state it: the colour that white light turns into over a distance.

use base::math::Rgb;

/// Minimum share of the light that is left over the distance, so that the coefficient stays finite.
const MIN_COLOUR: f32 = 1e-30;

/// Returns the absorption coefficient by length; `None` if nothing is absorbed.
///
/// The coefficient is -ln(colour) / distance (`KHR_materials_volume`). An infinite distance absorbs nothing. Channels
/// above 1 count as 1.
pub(super) fn absorption(colour: Rgb, distance: f64) -> Option<Rgb> {
    let per_length = |channel: f32| {
        let left = f64::from(channel.clamp(MIN_COLOUR, 1.0));
        (-left.ln() / distance).clamp(0.0, f32::MAX.into()) as f32
    };
    let coefficient = Rgb::from(colour.to_array().map(per_length));
    (coefficient != Rgb::ZERO).then_some(coefficient)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_has_the_colour_after_the_distance() {
        let colour = Rgb::new(0.5, 0.8, 0.25);
        for distance in [0.1, 1.0, 7.0] {
            let coefficient = absorption(colour, distance).expect("it absorbs");
            let left = (coefficient * -(distance as f32)).exp();
            assert!((left - colour).abs().max_element() < 1e-5, "{left}");
        }
        let black = absorption(Rgb::ZERO, 1e-30).expect("it absorbs");
        assert!(black.is_finite() && (black * -0.1).exp() == Rgb::ZERO);
        assert_eq!((absorption(Rgb::ONE, 1.0), absorption(colour, f64::INFINITY)), (None, None));
        assert_eq!(absorption(Rgb::splat(1.5), 1.0), None);
    }
}
