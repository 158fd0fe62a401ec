//! Punctual lights (`KHR_lights_punctual`).
//!
//! Units: the extension counts in candela (point, spot) and lux (directional), and surface radiance in cd/m². These
//! numbers are read as W/sr, W/m² and W/(sr m²), so proportions hold. Blender's exporter converts the watts of lights,
//! but not of surfaces, by 683 lm/W; its lights are divided by that factor.

use super::document::GltfFile;
use super::report::Findings;
use crate::error::SceneError;
use base::math::{Rgb, unit};
use glam::{DMat4, DVec3, Vec3};
use gltf_json::extensions::scene::khr_lights_punctual::{Light, Type};
use gltf_json::validation::Checked;
use scene::DeltaLight;

/// Lumens per watt that Blender's exporter writes for lights.
const BLENDER_LUMENS_PER_WATT: f32 = 683.0;

/// Returns the units of the file's lights per unit of the renderer.
pub(super) fn lumens_per_watt(document: &GltfFile) -> f32 {
    let generator = document.root.asset.generator.as_deref().unwrap_or_default();
    if generator.contains("Blender") { BLENDER_LUMENS_PER_WATT } else { 1.0 }
}

/// Returns the light of a node, and its world position.
pub(super) fn read(
    light: &Light,
    name: &str,
    to_world: &DMat4,
    lumens_per_watt: f32,
    document: &GltfFile,
    report: &mut Findings,
) -> Result<(DeltaLight, DVec3), SceneError> {
    let power = Rgb::from(light.color) * (light.intensity / lumens_per_watt);
    let axis = unit(to_world.transform_vector3(DVec3::NEG_Z));
    let Some(direction) = axis.map(|axis| axis.as_vec3()) else {
        return Err(document.wrong(format!("{name} has no direction")));
    };
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
            report.note(what, "penumbras differ slightly", name);
            DeltaLight::Spot {
                position,
                direction,
                intensity: power,
                inner_angle: inner,
                outer_angle: outer,
                image: None,
            }
        }
        _ => return Err(document.wrong(format!("{name} has an unknown type"))),
    };
    Ok((light, to_world.transform_point3(DVec3::ZERO)))
}
