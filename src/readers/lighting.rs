//! Light that the caller adds to a scene: an environment in place of the scene's own, and the default sky of models.
//!
//! Exporters of models mostly leave lights out, and viewers add their own. So a model without a lamp gets a sky.

use crate::colour_profile::srgb_to_linear;
use crate::error::{Location, Log, SceneError};
use crate::plan::{Contents, EnvironmentPlan, MaterialPlan, NamedAppearances};
use crate::sky::SkyPlan;
use base::math::Rgb;
use glam::{DMat4, DVec3};
use scene::Emission;
use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Azimuth and elevation of the default sun, in degrees. The default camera stands at 30 and 20.
const SUN: [f64; 2] = [-40.0, 50.0];

/// Radiance above which emission counts as a lamp. Up to it, viewers show emission as the brightness of a display.
const LAMP: f32 = 1.0;

/// Upward axis of a scene, for what the caller adds to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// The axis y; the front is +z.
    Y,
    /// The axis z; the front is -y.
    Z,
}

impl UpAxis {
    /// Returns the unit vector.
    pub fn vector(self) -> DVec3 {
        match self {
            UpAxis::Y => DVec3::Y,
            UpAxis::Z => DVec3::Z,
        }
    }

    /// Returns the rotation that turns y to the axis, and +z to the front.
    fn turn_from_y(self) -> DMat4 {
        match self {
            UpAxis::Y => DMat4::IDENTITY,
            UpAxis::Z => DMat4::from_rotation_x(FRAC_PI_2),
        }
    }

    /// Returns the unit vector at an azimuth, counted from the front towards the viewer's right, and an elevation, in
    /// degrees.
    pub fn direction(self, [azimuth, elevation]: [f64; 2]) -> DVec3 {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let (rise, level) = elevation.to_radians().sin_cos();
        self.turn_from_y().transform_vector3(DVec3::new(sin * level, rise, cos * level))
    }
}

/// An environment that replaces that of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentChoice {
    /// Latitude-longitude map in a file.
    Map(PathBuf),
    /// Equal radiance from all directions, W/(sr m²).
    Constant(Rgb),
    /// Clear sky with the sun at an azimuth and an elevation in degrees, over level ground. The irradiance of the
    /// ground is π.
    Sky([f64; 2]),
}

impl FromStr for EnvironmentChoice {
    type Err = String;

    /// Parses `sky`, `sky,AZIMUTH,ELEVATION`, a grey, `R,G,B`, `#rrggbb` in sRGB, or the name of a file.
    fn from_str(text: &str) -> Result<EnvironmentChoice, String> {
        let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        let sky = text.strip_prefix("sky");
        if let Some(rest) = sky.filter(|rest| rest.is_empty() || rest.starts_with(',')) {
            let angles: Option<Vec<f64>> =
                rest.split(',').skip(1).map(|part| part.trim().parse().ok()).collect();
            return match angles.as_deref() {
                Some([]) => Ok(EnvironmentChoice::Sky(SUN)),
                Some(&[azimuth, elevation]) if azimuth.is_finite() && (0.0..=90.0).contains(&elevation) => {
                    Ok(EnvironmentChoice::Sky([azimuth, elevation]))
                }
                _ => {
                    Err("expected sky, or sky,AZIMUTH,ELEVATION in degrees with an elevation from 0 to 90"
                        .into())
                }
            };
        }
        let colour = match numbers.as_deref() {
            Some(&[grey]) => Some(Rgb::splat(grey as f32)),
            Some(&[r, g, b]) => Some(DVec3::new(r, g, b).as_vec3()),
            Some(_) => return Err("expected one number, or three like 0.5,0.6,1".into()),
            None => match text.strip_prefix('#') {
                Some(digits) => Some(hexadecimal(digits).ok_or("expected six digits like #8899ff")?),
                None => None,
            },
        };
        match colour {
            Some(colour) if colour.is_finite() && colour.cmpge(Rgb::ZERO).all() => {
                Ok(EnvironmentChoice::Constant(colour))
            }
            Some(_) => Err("expected numbers of 0 or more".into()),
            None if text.is_empty() => Err("expected sky, a colour or a file".into()),
            None => Ok(EnvironmentChoice::Map(text.into())),
        }
    }
}

/// Light that the caller adds to a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lighting {
    /// Environment in place of the scene's own, and of its sun.
    pub environment: Option<EnvironmentChoice>,
    /// Rotation of the environment about the upward axis in degrees, counter-clockwise seen from above.
    pub rotation: f64,
    /// True if a model without a lamp stays dark.
    pub no_default: bool,
    /// True if the camera does not see the environment directly.
    pub hides_background: bool,
}

impl Lighting {
    /// Replaces the environment of a scene at `path`. A model without a lamp gets the default sky, and a note says so.
    pub(crate) fn apply(
        &self,
        contents: &mut Contents,
        up: UpAxis,
        is_model: bool,
        path: &Path,
        log: &mut Log,
    ) -> Result<(), SceneError> {
        let place = Location::file(path);
        let choice = match &self.environment {
            Some(choice) => choice.clone(),
            None if is_model && !self.no_default && !has_lamp(contents) => {
                let fallback = "a sky with its sun lights it; choose other light with --env, or none with \
                                --no-default-light";
                log.note(&place, "the file has no light", fallback);
                EnvironmentChoice::Sky(SUN)
            }
            None if self.rotation != 0.0 => {
                return Err(place.wrong("--env-rotate has no environment to rotate", "add --env"));
            }
            None => return Ok(()),
        };
        contents.discs.clear();
        contents.environment = Some(match choice {
            EnvironmentChoice::Constant(radiance) => EnvironmentPlan::Constant(radiance),
            EnvironmentChoice::Map(path) => {
                let turn = DMat4::from_axis_angle(up.vector(), self.rotation.to_radians());
                EnvironmentPlan::Map { place, path, scale: 1.0, to_world: turn * up.turn_from_y() }
            }
            EnvironmentChoice::Sky([azimuth, elevation]) => {
                let towards_sun = up.direction([azimuth + self.rotation, elevation]);
                let sky = SkyPlan::new(up.vector(), towards_sun).over_ground();
                contents.discs.extend(sky.sun());
                EnvironmentPlan::Sky(sky)
            }
        });
        Ok(())
    }
}

/// Returns true if a scene has a lamp: a light, an environment, or a surface that emits more than [`LAMP`].
fn has_lamp(contents: &Contents) -> bool {
    let is_lamp = |emission: &Option<Emission>| {
        emission.as_ref().is_some_and(|emission| emission.radiance.max_element() > LAMP)
    };
    !contents.lights.is_empty()
        || !contents.discs.is_empty()
        || contents.environment.is_some()
        || contents.meshes.iter().any(|mesh| {
            is_lamp(&mesh.emission)
                || match &mesh.material {
                    MaterialPlan::One(_) => false,
                    MaterialPlan::ByName(NamedAppearances { appearances, .. }, _) => {
                        appearances.values().any(|a| is_lamp(&a.emission))
                    }
                }
        })
}

/// Converts six hexadecimal digits in sRGB to linear colour.
pub(crate) fn hexadecimal(digits: &str) -> Option<Rgb> {
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let code = u32::from_str_radix(digits, 16).ok()?;
    let channel = |shift: u32| srgb_to_linear((code >> shift & 255) as f32 / 255.0);
    Some(Rgb::new(channel(16), channel(8), channel(0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn environments_are_parsed_and_refused() {
        let parse = |text: &str| text.parse::<EnvironmentChoice>();
        assert_eq!(parse("sky"), Ok(EnvironmentChoice::Sky(SUN)));
        assert_eq!(parse("sky,-90, 10"), Ok(EnvironmentChoice::Sky([-90.0, 10.0])));
        assert_eq!(parse("0.5"), Ok(EnvironmentChoice::Constant(Rgb::splat(0.5))));
        assert_eq!(parse("1,2,3"), Ok(EnvironmentChoice::Constant(Rgb::new(1.0, 2.0, 3.0))));
        assert_eq!(parse("#ff0000"), Ok(EnvironmentChoice::Constant(Rgb::X)));
        assert_eq!(parse("skyline.hdr"), Ok(EnvironmentChoice::Map("skyline.hdr".into())));
        for bad in ["", "sky,1", "sky,0,91", "sky,a,b", "-1", "1,2", "1,2,nan", "#12345", "inf"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn azimuths_count_from_the_front_to_the_right() {
        for (up, front, right) in [(UpAxis::Y, DVec3::Z, DVec3::X), (UpAxis::Z, DVec3::NEG_Y, DVec3::X)] {
            let near = |angles, expected: DVec3| assert!((up.direction(angles) - expected).length() < 1e-12);
            near([0.0, 0.0], front);
            near([90.0, 0.0], right);
            near([0.0, 90.0], up.vector());
        }
    }
}
