//! Checks of values that several readers share.

use super::constants;
use super::error::{Location, SceneError};
use base::math::{self, Rgb};
use glam::{DVec3, Vec3};
use scene::DistantDisc;
use std::f64::consts::PI;

/// Returns the direction of a light at unit length.
pub fn unit(direction: DVec3, place: &Location) -> Result<Vec3, SceneError> {
    let none = || place.wrong("the light has no direction", "give one that is not zero");
    Ok(math::unit(direction).ok_or_else(none)?.as_vec3())
}

/// Returns the disc of an even light that shines along `direction` and is `angle` degrees wide.
///
/// `irradiance` is that on a surface facing the light.
pub fn disc(
    direction: Vec3,
    irradiance: Rgb,
    angle: f64,
    place: &Location,
) -> Result<DistantDisc, SceneError> {
    if !(angle > 0.0 && angle < 180.0) {
        return Err(
            place.wrong(format!("the light is {angle} degrees wide"), "give more than 0, less than 180")
        );
    }
    let half_angle = (0.5 * angle).to_radians();
    // Projected solid angle of the disc.
    let projected = PI * half_angle.sin() * half_angle.sin();
    let radiance = irradiance / projected as f32;
    Ok(DistantDisc { direction: -direction, half_angle: half_angle as f32, radiance })
}

/// Returns the half angles of a spot light's cone in radians; `angles` are in degrees, and `names` are their keys.
pub fn cone(names: [&str; 2], angles: [f64; 2], place: &Location) -> Result<[f32; 2], SceneError> {
    let ([inner_name, outer_name], [inner, outer]) = (names, angles);
    if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= 180.0) {
        let what = format!("{inner_name} {inner} and {outer_name} {outer} make no cone");
        return Err(place.wrong(what, format!("keep 0 <= {inner_name} <= {outer_name} <= 180")));
    }
    Ok(angles.map(|angle| angle.to_radians() as f32))
}

/// Returns η and k of a conductor by its name.
pub fn conductor(preset: &str, place: &Location) -> Result<(Rgb, Rgb), SceneError> {
    let unknown = || {
        let remedy = format!("use one of {}", constants::conductor_names());
        place.wrong(format!("unknown conductor \"{preset}\""), remedy)
    };
    constants::conductor(preset).ok_or_else(unknown)
}

/// Rejects keys that are given but mean nothing for an object of `kind`; `known` are its keys.
pub fn keys(kind: &str, known: &[&str], given: &[(&str, bool)], place: &Location) -> Result<(), SceneError> {
    match given.iter().find(|(key, is_given)| *is_given && !known.contains(key)) {
        Some((key, _)) => {
            let what = format!("{key} has no effect on a {kind}");
            Err(place.wrong(what, format!("leave it out; valid keys are {}", known.join(", "))))
        }
        None => Ok(()),
    }
}
