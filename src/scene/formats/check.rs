//! Checks of values that both readers share.

use super::constants;
use super::error::{Place, SceneError};
use crate::math::Rgb;
use glam::{DVec3, Vec3};

/// The direction of a light at unit length.
pub(crate) fn unit(direction: DVec3, place: &Place) -> Result<Vec3, SceneError> {
    let none = || place.wrong("the light has no direction", "give one that is not zero");
    Ok(direction.try_normalize().ok_or_else(none)?.as_vec3())
}

/// The half angles of a spot light's cone, of these names, from degrees to radians.
pub(crate) fn cone(names: [&str; 2], angles: [f64; 2], place: &Place) -> Result<[f32; 2], SceneError> {
    let ([inner_name, outer_name], [inner, outer]) = (names, angles);
    if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= 180.0) {
        let what = format!("{inner_name} {inner} and {outer_name} {outer} make no cone");
        return Err(place.wrong(what, format!("keep 0 <= {inner_name} <= {outer_name} <= 180")));
    }
    Ok(angles.map(|angle| angle.to_radians() as f32))
}

/// η and k of a conductor, by its name.
pub(crate) fn conductor(preset: &str, place: &Place) -> Result<(Rgb, Rgb), SceneError> {
    let unknown = || {
        let remedy = format!("use one of {}", constants::conductor_names());
        place.wrong(format!("unknown conductor \"{preset}\""), remedy)
    };
    constants::conductor(preset).ok_or_else(unknown)
}

/// Rejects a key that is given and means nothing for an object of `kind`, for which `known` do.
pub(crate) fn keys(
    kind: &str,
    known: &[&str],
    given: &[(&str, bool)],
    place: &Place,
) -> Result<(), SceneError> {
    match given.iter().find(|(key, is_given)| *is_given && !known.contains(key)) {
        Some((key, _)) => {
            let what = format!("{key} means nothing for a {kind}");
            Err(place.wrong(what, format!("leave it out; known are {}", known.join(", "))))
        }
        None => Ok(()),
    }
}
