//! Checks of values that both readers share.

use super::constants;
use super::error::{Place, SceneError};
use base::math::{self, Rgb};
use glam::{DVec3, Vec3};
use scene::DistantDisc;
use std::f64::consts::PI;

/// The direction of a light at unit length.
pub fn unit(direction: DVec3, place: &Place) -> Result<Vec3, SceneError> {
    let none = || place.wrong("the light has no direction", "give one that is not zero");
    Ok(math::unit(direction).ok_or_else(none)?.as_vec3())
}

/// The disc of an even light that shines along `direction`, `angle` degrees wide, from its irradiance on a surface that
/// faces it.
pub fn disc(direction: Vec3, irradiance: Rgb, angle: f64, place: &Place) -> Result<DistantDisc, SceneError> {
    if !(angle > 0.0 && angle < 180.0) {
        return Err(
            place.wrong(format!("the light is {angle} degrees wide"), "give more than 0, less than 180")
        );
    }
    let half_angle = (0.5 * angle).to_radians();
    // Its projected solid angle.
    let projected = PI * half_angle.sin() * half_angle.sin();
    let radiance = irradiance / projected as f32;
    Ok(DistantDisc { direction: -direction, half_angle: half_angle as f32, radiance })
}

/// The half angles of a spot light's cone, of these names, from degrees to radians.
pub fn cone(names: [&str; 2], angles: [f64; 2], place: &Place) -> Result<[f32; 2], SceneError> {
    let ([inner_name, outer_name], [inner, outer]) = (names, angles);
    if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= 180.0) {
        let what = format!("{inner_name} {inner} and {outer_name} {outer} make no cone");
        return Err(place.wrong(what, format!("keep 0 <= {inner_name} <= {outer_name} <= 180")));
    }
    Ok(angles.map(|angle| angle.to_radians() as f32))
}

/// η and k of a conductor, by its name.
pub fn conductor(preset: &str, place: &Place) -> Result<(Rgb, Rgb), SceneError> {
    let unknown = || {
        let remedy = format!("use one of {}", constants::conductor_names());
        place.wrong(format!("unknown conductor \"{preset}\""), remedy)
    };
    constants::conductor(preset).ok_or_else(unknown)
}

/// Rejects a key that is given and means nothing for an object of `kind`, for which `known` do.
pub fn keys(kind: &str, known: &[&str], given: &[(&str, bool)], place: &Place) -> Result<(), SceneError> {
    match given.iter().find(|(key, is_given)| *is_given && !known.contains(key)) {
        Some((key, _)) => {
            let what = format!("{key} means nothing for a {kind}");
            Err(place.wrong(what, format!("leave it out; known are {}", known.join(", "))))
        }
        None => Ok(()),
    }
}
