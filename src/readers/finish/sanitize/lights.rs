//! Checks of lights. Black lights are dropped; negative lights and positions beyond f32 are errors.

use super::reach::{IN_REACH, is_within_reach};
use super::report::SanitizeReport;
use super::texels::TexelLimits;
use crate::draft::{Draft, DraftMesh};
use crate::error::{Location, SceneError};
use crate::finish::dark::is_dark_emission;
use crate::local::LocalCoordinates;
use base::math::Rgb;
use glam::DVec3;
use scene::{DeltaLight, Environment, Texture, TextureId};

/// Checks all lights, and drops black ones.
pub(super) fn check_lights(
    draft: &mut Draft,
    coordinates: &LocalCoordinates,
    report: &mut SanitizeReport,
) -> Result<(), SceneError> {
    check_emitters(draft, report)?;
    check_delta_lights(draft, coordinates)?;
    let place = draft.main_file();
    let scene = &mut draft.scene;
    for disc in &scene.discs {
        check_light(disc.radiance, "the radiance of a distant disc", &place)?;
    }
    let before = draft.lights.len() + scene.discs.len();
    scene.discs.retain(|disc| disc.radiance != Rgb::ZERO);
    let textures = &scene.textures;
    let is_dark_image = |id: TextureId| textures.by_id(id).is_some_and(is_dark_texture);
    draft
        .lights
        .retain(|(light, _)| intensity(light) != Rgb::ZERO && !image(light).is_some_and(is_dark_image));
    report.black_lights += before - draft.lights.len() - scene.discs.len();
    if let Some(environment) = &scene.environment
        && is_dark(environment, &place)?
    {
        report.black_lights += 1;
        scene.environment = None;
    }
    Ok(())
}

/// Raises texels of emitters and lights to 0.
pub(super) fn fit_light_texels(
    meshes: &mut [DraftMesh],
    lights: &mut [(DeltaLight, DVec3)],
    texels: &mut TexelLimits,
    place: &Location,
    report: &mut SanitizeReport,
) {
    let of_meshes = meshes.iter_mut().filter_map(|mesh| mesh.emission.as_mut()?.texture.as_mut());
    let of_lights = lights.iter_mut().filter_map(|(light, _)| match light {
        DeltaLight::Spot { image, .. } => image.as_mut().map(|image| &mut image.texture),
        DeltaLight::Projector { projector, .. } => projector.texture.as_mut(),
        DeltaLight::Point { .. } | DeltaLight::Directional { .. } => None,
    });
    of_meshes.chain(of_lights).for_each(|id| texels.limit(id, Rgb::MAX, place, report));
}

/// Rejects light that is negative, infinite or NaN.
fn check_light(light: Rgb, what: &str, place: &Location) -> Result<(), SceneError> {
    match light.is_finite() && light.min_element() >= 0.0 {
        true => Ok(()),
        false => Err(place.wrong(format!("{what} {light} is negative or not a number"), "give 0 or more")),
    }
}

/// Returns the intensity of a light, or the irradiance of a distant one.
fn intensity(light: &DeltaLight) -> Rgb {
    match light {
        DeltaLight::Point { intensity, .. } | DeltaLight::Spot { intensity, .. } => *intensity,
        DeltaLight::Projector { projector, .. } => projector.intensity,
        DeltaLight::Directional { irradiance, .. } => *irradiance,
    }
}

/// Returns the texture of a light.
fn image(light: &DeltaLight) -> Option<TextureId> {
    match light {
        DeltaLight::Spot { image, .. } => image.map(|image| image.texture),
        DeltaLight::Projector { projector, .. } => projector.texture,
        DeltaLight::Point { .. } | DeltaLight::Directional { .. } => None,
    }
}

/// Returns true if no texel emits light.
fn is_dark_texture(texture: &Texture) -> bool {
    texture.texels.all(|texel| texel.max_element() <= 0.0)
}

/// Checks the emission of meshes, and drops black emission and that of surfaces that are not there.
fn check_emitters(draft: &mut Draft, report: &mut SanitizeReport) -> Result<(), SceneError> {
    let place = draft.main_file();
    for mesh in &mut draft.meshes {
        let Some(emission) = mesh.emission else { continue };
        check_light(emission.radiance, &format!("mesh \"{}\": the radiance", mesh.name), &place)?;
        let of_attribute = emission.texture.and_then(|id| draft.scene.textures.attribute(id));
        let name = of_attribute.and_then(|of| draft.attribute_names.get(of.attribute.0 as usize));
        let values = mesh.attributes.iter().find(|attribute| Some(&attribute.name) == name);
        let is_black = values.is_some_and(|found| found.values.all().iter().all(|value| *value == Rgb::ZERO));
        if is_black || is_dark_emission(&emission, mesh.material, &draft.scene) {
            report.black_lights += 1;
            mesh.emission = None;
        }
    }
    Ok(())
}

/// Rejects negative lights, and lights beyond the reach of f32.
fn check_delta_lights(draft: &Draft, coordinates: &LocalCoordinates) -> Result<(), SceneError> {
    let place = draft.main_file();
    for (light, position) in &draft.lights {
        check_light(intensity(light), "a light's intensity", &place)?;
        if !is_within_reach(*position, coordinates) {
            return Err(place.wrong(format!("a light stands at {position}"), IN_REACH));
        }
        let falls_off = !matches!(light, DeltaLight::Directional { .. });
        if falls_off && !coordinates.local_intensity(intensity(light)).is_finite() {
            let what = format!("a light's intensity {} overflows in its scene", intensity(light));
            return Err(place.wrong(what, "scale the scene up, or the light down"));
        }
    }
    Ok(())
}

/// Checks an environment; returns true if it is black.
fn is_dark(environment: &Environment, place: &Location) -> Result<bool, SceneError> {
    match environment {
        Environment::Constant(radiance) => {
            check_light(*radiance, "the environment's radiance", place)?;
            Ok(*radiance == Rgb::ZERO)
        }
        Environment::Map(map) => Ok(map.radiance.iter().all(|r| *r == Rgb::ZERO)),
    }
}
