//! Punctual lights (`KHR_lights_punctual`).
//!
//! Units: the extension counts in candela (point, spot) and lux (directional), and surface radiance in cd/m². These
//! numbers are read as W/sr, W/m² and W/(sr m²), so proportions hold. Blender's exporter converts the watts of lights,
//! but not of surfaces, by 683 lm/W; its lights are divided by that factor. Before version 3.4 it wrote the watts of
//! points and spots, and the irradiance of suns. Their intensity is the watts over 4π.

use super::document::GltfFile;
use super::generator::Generator;
use super::transform::Place;
use crate::error::SceneError;
use crate::findings::Findings;
use base::math::{Rgb, unit};
use glam::{DMat3, DVec3, Vec3};
use gltf_json::extensions::scene::khr_lights_punctual::{Light, Type};
use gltf_json::validation::Checked;
use scene::DeltaLight;

/// Lumens per watt that Blender's exporter writes for lights since version 3.4.
const BLENDER_LUMENS_PER_WATT: f32 = 683.0;

/// Returns the units of a light of the file per unit of the renderer: those that the user gives, or those of the
/// program that wrote the file. `name` is that of the light.
pub(super) fn lumens_per_watt(
    light: &Light,
    given: Option<f32>,
    document: &GltfFile,
    name: &str,
    report: &mut Findings,
) -> f32 {
    if let Some(given) = given {
        return given;
    }
    match Generator::read(document) {
        Generator::BlenderWithWatts => match light.type_ {
            Checked::Valid(Type::Directional) => 1.0,
            _ => 4.0 * std::f32::consts::PI,
        },
        Generator::Blender => {
            let what = "lamps count as exported with the Lighting Mode Standard, 683 lumens per watt";
            let remedy = "give --lumens-per-watt 1 if it was Unitless; if it was Raw, 12.57, and 1 for suns";
            report.note(what, remedy, name);
            BLENDER_LUMENS_PER_WATT
        }
        Generator::Other => {
            let what = "a candela of lamps counts as 1 W/sr, and a lux as 1 W/m²";
            report.note(what, "give --lumens-per-watt 683 if surfaces emit watts", name);
            1.0
        }
    }
}

/// Number of halvings of an interval of angles. Single precision has no more.
const HALVINGS: u32 = 24;

/// Returns the angle from which the intensity of a spot has to fall linearly to 0 at `outer`, to send as much light as
/// the spot of the file. `inner` is the angle of the file.
///
/// The extension's intensity is quadratic in the cosine between both angles. Blender's is a smooth step in the cosine
/// over a share of the cone, its blend; the exporter writes 1 minus this share as the ratio of the angles. Quadratic
/// spots of small `inner` send less than a linear one from the axis, 4 % less at an `outer` of 1.5.
fn linear_inner(inner: f32, outer: f32, is_blender: bool) -> f32 {
    let [inner, outer] = [inner, outer].map(f64::from);
    // Light over 2 π times the intensity on the axis.
    let of_file = match is_blender {
        true => (1.0 - outer.cos()) * 0.5 * (1.0 + inner / outer),
        false => 1.0 - inner.cos() + (inner.cos() - outer.cos()) / 3.0,
    };
    let of_linear = |inner: f64| 1.0 - (outer.sin() - inner.sin()) / (outer - inner);
    let [mut low, mut high] = [0.0, outer];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if of_linear(middle) < of_file { low = middle } else { high = middle }
    }
    low as f32
}

/// Returns the light of a node, and its position. Scales do not change it.
pub(super) fn read(
    light: &Light,
    name: &str,
    place: &Place,
    lumens_per_watt: f32,
    document: &GltfFile,
    report: &mut Findings,
) -> Result<(DeltaLight, DVec3), SceneError> {
    let power = Rgb::from(light.color) * (light.intensity / lumens_per_watt);
    let axis = unit(place.axes.transform_vector3(DVec3::NEG_Z));
    let Some(direction) = axis.map(|axis| axis.as_vec3()) else {
        return Err(document.wrong(format!("{name} has no direction")));
    };
    if DMat3::from_mat4(place.to_file).determinant() == 0.0 {
        report.note("a lamp has a scale of 0", "it shines all the same: scales do not change lamps", name);
    }
    if light.range.is_some_and(f32::is_finite) {
        report.note("the range of lights is not supported", "lights reach any distance", name);
    }
    let position = Vec3::ZERO;
    let light = match (&light.type_, &light.spot) {
        (Checked::Valid(Type::Point), _) => DeltaLight::Point { position, intensity: power },
        (Checked::Valid(Type::Directional), _) => DeltaLight::Directional { direction, irradiance: power },
        (Checked::Valid(Type::Spot), Some(spot)) => {
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= std::f32::consts::PI) {
                return Err(document.wrong(format!("{name}: the angles {inner} and {outer} make no cone")));
            }
            let what = "the edges of spot lights are linear in the angle, not smooth in its cosine";
            report.note(what, "they send as much light; penumbras differ slightly", name);
            let is_blender = Generator::read(document).is_blender();
            DeltaLight::Spot {
                position,
                direction,
                intensity: power,
                inner_angle: linear_inner(inner, outer, is_blender),
                outer_angle: outer,
                image: None,
            }
        }
        _ => return Err(document.wrong(format!("{name} has an unknown type"))),
    };
    Ok((light, place.to_file.transform_point3(DVec3::ZERO)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::gauss_legendre;

    #[test]
    fn spots_send_the_light_of_their_file() {
        let integrated = |outer: f64, intensity: &dyn Fn(f64) -> f64| -> f64 {
            let at = |&(x, weight): &(f64, f64)| weight * outer * intensity(outer * x) * (outer * x).sin();
            gauss_legendre(512).iter().map(at).sum()
        };
        for (inner, outer) in [(0.0, 0.9), (0.3, 0.5), (0.2, 1.5), (0.7, 0.7001)] {
            let (blend, end) = (1.0 - inner / outer, f64::cos(outer));
            let blender = |angle: f64| {
                let t = ((angle.cos() - end) / (blend * (1.0 - end))).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            };
            let quadratic =
                |angle: f64| ((angle.cos() - end) / (f64::cos(inner) - end)).clamp(0.0, 1.0).powi(2);
            let of_file: [&dyn Fn(f64) -> f64; 2] = [&quadratic, &blender];
            for (is_blender, of_file) in [false, true].into_iter().zip(of_file) {
                let full = f64::from(linear_inner(inner as f32, outer as f32, is_blender));
                let linear = |angle: f64| ((outer - angle) / (outer - full)).min(1.0);
                let [expected, found] = [integrated(outer, of_file), integrated(outer, &linear)];
                // A linear spot from its axis sends more than a quadratic one.
                let limit = if full > 0.0 { 1e-3 } else { 0.04 };
                assert!(
                    (found / expected - 1.0).abs() < limit,
                    "{inner} {outer} {is_blender}: {found} {expected}"
                );
            }
        }
    }
}
