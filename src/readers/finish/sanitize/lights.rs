//! Lights without light are dropped; negative ones, and places beyond f32, are errors.

use super::{IN_REACH, SanitizeReport, is_within_reach, main_file};
use crate::draft::Draft;
use crate::error::SceneError;
use crate::finish::recentre::Coordinates;
use base::math::Rgb;
use scene::{DeltaLight, Environment};

pub(super) fn check_lights(
    draft: &mut Draft,
    coordinates: &Coordinates,
    report: &mut SanitizeReport,
) -> Result<(), SceneError> {
    let place = main_file(&draft.sources);
    let check = |light: Rgb, what: &str| match light.is_finite() && light.min_element() >= 0.0 {
        true => Ok(()),
        false => Err(place.wrong(format!("{what} {light} is negative or no number"), "give 0 or more")),
    };
    for mesh in &mut draft.meshes {
        let Some(emission) = mesh.emission else { continue };
        check(emission.radiance, &format!("mesh \"{}\": the radiance", mesh.name))?;
        let texture = emission.texture.and_then(|id| draft.textures.get(id.0 as usize));
        let dark = texture.is_some_and(|t| t.texels.all(|texel| texel.max_element() <= 0.0));
        if emission.radiance == Rgb::ZERO || dark {
            report.black_lights += 1;
            mesh.emission = None;
        }
    }
    let power = |light: &DeltaLight| match light {
        DeltaLight::Point { intensity, .. } | DeltaLight::Spot { intensity, .. } => *intensity,
        DeltaLight::Directional { irradiance, .. } => *irradiance,
    };
    for (light, position) in &draft.lights {
        check(power(light), "a light's intensity")?;
        if !is_within_reach(*position, coordinates) {
            return Err(place.wrong(format!("a light stands at {position}"), IN_REACH));
        }
        let falls_off = !matches!(light, DeltaLight::Directional { .. });
        if falls_off && !coordinates.local_intensity(power(light)).is_finite() {
            let what = format!("a light's intensity {} is beyond all numbers for its scene", power(light));
            return Err(place.wrong(what, "scale the scene up, or the light down"));
        }
    }
    for disc in &draft.discs {
        check(disc.radiance, "the radiance of a distant disc")?;
    }
    let before = draft.lights.len() + draft.discs.len();
    draft.discs.retain(|disc| disc.radiance != Rgb::ZERO);
    draft.lights.retain(|(light, _)| power(light) != Rgb::ZERO);
    report.black_lights += before - draft.lights.len() - draft.discs.len();
    let dark = match &mut draft.environment {
        Some(Environment::Constant(radiance)) => {
            check(*radiance, "the environment's radiance")?;
            *radiance == Rgb::ZERO
        }
        Some(Environment::Map(map)) => {
            let bad = map.radiance.iter_mut().filter(|r| !r.is_finite() || r.min_element() < 0.0);
            report.bad_texels +=
                bad.map(|r| *r = if r.is_finite() { r.max(Rgb::ZERO) } else { Rgb::ZERO }).count();
            map.radiance.iter().all(|r| *r == Rgb::ZERO)
        }
        None => false,
    };
    if dark {
        report.black_lights += 1;
        draft.environment = None;
    }
    Ok(())
}
