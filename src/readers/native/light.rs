//! Lights and environment of the native format.

use super::builder::SceneBuilder;
use super::text::{ColourText, EnvironmentText, LightText, NumberArray};
use crate::check;
use crate::error::{Location, SceneError};
use crate::plan::EnvironmentPlan;
use glam::{DMat4, DVec3, Vec3};
use scene::DeltaLight;
use toml::Spanned;

impl SceneBuilder<'_> {
    pub(super) fn light(&mut self, text: &Spanned<LightText>) -> Result<(), SceneError> {
        let place = self.file.place(text.span());
        let text = text.get_ref();
        let missing = |key: &str| {
            place.wrong(format!("the {} light lacks {key}", text.kind), format!("add {key} = ..."))
        };
        let need =
            |value: Option<NumberArray<3>>, key: &str| value.map(DVec3::from).ok_or_else(|| missing(key));
        let colour = |value: &Option<ColourText>, key: &str| {
            value.as_ref().ok_or_else(|| missing(key))?.rgb(&format!("the {key}"), &place)
        };
        check_keys(text, &place)?;
        let light = match text.kind.as_str() {
            "point" => {
                let intensity = colour(&text.intensity, "intensity")?;
                (DeltaLight::Point { position: Vec3::ZERO, intensity }, need(text.position, "position")?)
            }
            "spot" => {
                let position = need(text.position, "position")?;
                let direction = check::unit(need(text.target, "target")? - position, &place)?;
                let intensity = colour(&text.intensity, "intensity")?;
                let outer = text.outer_angle.map_or(20.0, f64::from);
                let inner = text.inner_angle.map_or(0.75 * outer, f64::from);
                let names = ["inner_angle", "outer_angle"];
                let [inner_angle, outer_angle] = check::cone(names, [inner, outer], &place)?;
                let light = DeltaLight::Spot {
                    position: Vec3::ZERO,
                    direction,
                    intensity,
                    inner_angle,
                    outer_angle,
                    image: None,
                };
                (light, position)
            }
            _ => {
                let direction = check::unit(need(text.direction, "direction")?, &place)?;
                let irradiance = colour(&text.irradiance, "irradiance")?;
                if let Some(angle) = text.angle {
                    let disc = check::disc(direction, irradiance, angle.into(), &place)?;
                    self.contents.discs.push(disc);
                    return Ok(());
                }
                (DeltaLight::Directional { direction, irradiance }, DVec3::ZERO)
            }
        };
        self.contents.lights.push(light);
        Ok(())
    }

    pub(super) fn environment(&self, text: &Spanned<EnvironmentText>) -> Result<EnvironmentPlan, SceneError> {
        let place = self.file.place(text.span());
        let text = text.get_ref();
        match (&text.radiance, &text.file) {
            (Some(radiance), None) if text.scale.is_none() && text.rotate_y.is_none() => {
                Ok(EnvironmentPlan::Constant(radiance.rgb("the radiance", &place)?))
            }
            (None, Some(file)) => {
                let to_world = DMat4::from_rotation_y(text.rotate_y.map_or(0.0, f64::from).to_radians());
                let (path, scale) = (self.folder.join(file), text.scale.map_or(1.0, f64::from) as f32);
                Ok(EnvironmentPlan::Map { place, path, scale, to_world })
            }
            _ => {
                let remedy = "give radiance alone, or file with scale and rotate_y";
                Err(place.wrong("the environment has no single source", remedy))
            }
        }
    }
}

/// Rejects keys that mean nothing for the kind of light.
fn check_keys(text: &LightText, place: &Location) -> Result<(), SceneError> {
    let given = [
        ("position", text.position.is_some()),
        ("intensity", text.intensity.is_some()),
        ("target", text.target.is_some()),
        ("inner_angle", text.inner_angle.is_some()),
        ("outer_angle", text.outer_angle.is_some()),
        ("direction", text.direction.is_some()),
        ("irradiance", text.irradiance.is_some()),
        ("angle", text.angle.is_some()),
    ];
    let known: &[&str] = match text.kind.as_str() {
        "point" => &["position", "intensity"],
        "spot" => &["position", "intensity", "target", "inner_angle", "outer_angle"],
        "directional" => &["direction", "irradiance", "angle"],
        other => {
            let what = format!("unknown kind of light \"{other}\"");
            return Err(place.wrong(what, "use point, spot or directional"));
        }
    };
    check::keys(&format!("{} light", text.kind), known, &given, place)
}
